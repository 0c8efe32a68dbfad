// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From the cube to spectra and maps. Both transforms divide by the sum of their window: the power of a tone
// at a bin's centre is its power at the receiver's port.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/config/radar_config.h"
#include "rf/radar/signal/fft.h"
#include "rf/radar/signal/window.h"

namespace greatx::rf {

/// Bin k of `bins` along the Doppler axis stands for k - floor(bins/2) turns over the chirps; positive:
/// receding.
inline int32_t doppler_turns(uint32_t bin, uint32_t bins) {
  return static_cast<int32_t>(bin) - static_cast<int32_t>(bins / 2);
}

/// What a radar's axes read. Ranges are of targets at rest: a velocity v shifts a tone by f_c v/S metres
/// (docs/radar.md).
struct RadarAxes {
  std::vector<double> range_m;       ///< [ranges]: k c/2B
  std::vector<double> velocity_m_s;  ///< [velocities]: rate of range, positive receding, from -v_max up
  std::vector<double> azimuth;       ///< [azimuths]: rad from the array's x towards its y
};
RadarAxes radar_axes(const RadarSignalConfig& config);

/// Range and Doppler transforms of every virtual antenna, their power, and the directions of arrival.
class RadarMaps {
 public:
  explicit RadarMaps(const RadarSignalConfig& config);

  const Window& range_window() const { return range_window_; }
  const Window& doppler_window() const { return doppler_window_; }
  const RadarAxes& axes() const { return axes_; }

  /// cube [rx, tx, chirp, sample] -> sqrt(W) [rx, tx, range, velocity].
  std::vector<std::complex<float>> spectrum(std::span<const std::complex<float>> cube,
                                            uint32_t threads) const;
  /// Mean over the virtual antennas of |spectrum|^2: W [range, velocity].
  std::vector<float> range_doppler(std::span<const std::complex<float>> spectrum, uint32_t threads) const;
  /// W [range, azimuth], at elevation 0: power of the beam (mean of the virtual antennas, each turned by what
  /// its direction and, with TDM, its slot's time at the bin's velocity add), summed over all velocities and
  /// divided by the Doppler window's noise bandwidth, so that a target in the beam counts with its received
  /// power whatever its velocity. Bistatic: beams of each transmitter's receivers, their mean power.
  std::vector<float> range_azimuth(std::span<const std::complex<float>> spectrum, uint32_t threads) const;

 private:
  struct Pair {
    uint32_t a, b;
  };
  RadarSignalConfig config_;
  Window range_window_, doppler_window_;
  Fft range_transform_, doppler_transform_;
  RadarAxes axes_;
  std::vector<Pair> pairs_;      ///< of virtual antennas a < b that are summed coherently
  std::vector<float> steering_;  ///< [pairs, re | im, azimuths]
  uint32_t beams_ = 1;           ///< groups of antennas: 1, or the transmitters
};

/// Turns by which TDM delays transmitter `transmitter` at `doppler` turns over the chirps.
inline double tdm_turns(const RadarWaveform& waveform, uint32_t transmitter, double doppler) {
  return doppler * transmitter / (double(waveform.chirps()) * waveform.transmitters);
}

/// Turns of virtual antenna (receiver, transmitter) for a unit direction in the array's frame, -u . d/lambda,
/// d the sum of both elements' positions (of the receiver's alone if bistatic).
double steering_turns(const RadarSignalConfig& config, uint32_t receiver, uint32_t transmitter,
                      const dvec3& direction);

}  // namespace greatx::rf
