// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the range-azimuth map of what a channel senses (docs/sensing.md).
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/config/radar_config.h"
#include "rf/radar/signal/azimuth_beams.h"
#include "rf/radar/signal/window.h"

namespace greatx::rf {

/// Pairs of elements whose places add up to the same one at elevation 0 (the rows of a panel, and most pairs
/// of an array that hears itself) are summed before the beams, which then cost little.
class AzimuthMap {
 public:
  /// `signal`: the radar whose virtual antennas are the pairs of elements, as for DirectionFinder. Port p of
  /// an end is element p / polarizations. `doppler`: the window over the symbols.
  AzimuthMap(const RadarSignalConfig& signal, uint32_t transmit_polarizations, uint32_t receive_polarizations,
             const Window& doppler);

  size_t table_bytes() const { return beams_.table_bytes(); }
  /// Returns W [range, azimuth] of the spectrum [rx, tx, range, velocity] of ports. The power of a beam is
  /// |mean of its pairs of elements|^2, summed over velocities and divided by the noise bandwidth of the
  /// window over them. The map is the mean over pairs of polarizations and, if the ends are two arrays, over
  /// the transmitting elements.
  std::vector<float> of(std::span<const std::complex<float>> spectrum, uint32_t ranges,
                        uint32_t threads) const;

 private:
  struct Layout {
    std::vector<BeamPlace> places;
    std::vector<uint32_t> place_of_pair;  ///< [rx element, tx element]
  };
  static Layout layout_of(const RadarSignalConfig& signal);
  AzimuthMap(const RadarSignalConfig& signal, Layout layout, uint32_t transmit_polarizations,
             uint32_t receive_polarizations, const Window& doppler);

  uint32_t transmitters_, transmit_polarizations_, receive_polarizations_, velocities_;
  std::vector<uint32_t> place_of_pair_;
  AzimuthBeams beams_;
  double scale_;  ///< of the sum of all powers
};

}  // namespace greatx::rf
