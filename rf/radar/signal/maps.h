// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes spectra and maps from the cube. Both transforms divide by the sum of their window, so that the
// power of a tone at the centre of a bin is its power at the port of the receiver.
#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rf/config/radar_config.h"
#include "rf/radar/signal/azimuth_beams.h"
#include "rf/radar/signal/fft.h"
#include "rf/radar/signal/window.h"

namespace greatx::rf {

/// Returns the Doppler of bin `bin` of `bins`, in turns over the chirps: bin - floor(bins/2). Positive values
/// are receding.
inline int32_t doppler_turns(uint32_t bin, uint32_t bins) {
  return static_cast<int32_t>(bin) - static_cast<int32_t>(bins / 2);
}

/// Holds the values of a radar's axes. The ranges are those of targets at rest: a velocity v shifts a tone by
/// f_c v/S metres (docs/radar.md).
struct RadarAxes {
  std::vector<double> range_m;       ///< [ranges]: k c/2B
  std::vector<double> velocity_m_s;  ///< [velocities]: range rate, positive receding, ascending from -v_max
  std::vector<double> azimuth;       ///< [azimuths]: rad from the array's x towards its y
};
RadarAxes radar_axes(const RadarSignalConfig& config);

/// Computes the range and Doppler transforms of every virtual antenna, their power, and the directions of
/// arrival.
class RadarMaps {
 public:
  explicit RadarMaps(const RadarSignalConfig& config);

  const Window& range_window() const { return range_window_; }
  const Window& doppler_window() const { return doppler_window_; }
  const RadarAxes& axes() const { return axes_; }

  /// Returns the spectrum sqrt(W) [rx, tx, range, velocity] of cube [rx, tx, chirp, sample]. With Doppler
  /// multiplexing the cube is [rx, 1, chirp, sample], and the spectrum is demultiplexed().
  std::vector<std::complex<float>> spectrum(std::span<const std::complex<float>> cube,
                                            uint32_t threads) const;
  /// Returns the mean of |spectrum|^2 over the virtual antennas: W [range, velocity].
  std::vector<float> range_doppler(std::span<const std::complex<float>> spectrum, uint32_t threads) const;
  /// Returns the power of the beam at elevation 0: W [range, azimuth]. The beam is the mean of the virtual
  /// antennas. Each antenna is first turned back by the phase of its direction and, with TDM, by that of the
  /// time of its slot at the velocity of the bin. The power is summed over all velocities and divided by the
  /// noise bandwidth of the Doppler window, so that a target in the beam counts with its received power
  /// whatever its velocity is. For a bistatic radar the receivers of each transmitter form a beam, and the
  /// map is the mean power of these beams.
  std::vector<float> range_azimuth(std::span<const std::complex<float>> spectrum, uint32_t threads) const;

 private:
  RadarSignalConfig config_;
  Window range_window_, doppler_window_;
  Fft range_transform_, doppler_transform_;
  RadarAxes axes_;
  std::optional<AzimuthBeams> beams_;  ///< of the virtual antennas; none without a range-azimuth map
};

/// Returns the turns by which TDM delays transmitter `transmitter` at `doppler` turns over the chirps.
inline double tdm_turns(const RadarWaveform& waveform, uint32_t transmitter, double doppler) {
  if (waveform.multiplexing == RadarMultiplexing::doppler) return 0.0;
  return doppler * transmitter / (double(waveform.chirps()) * waveform.transmitters);
}

/// Returns the phase, in turns, of virtual antenna (receiver, transmitter) for a unit direction u in the
/// frame of the array: -u . d/lambda. d is the sum of the positions of both elements, or, if bistatic, the
/// position of the receiver alone.
double steering_turns(const RadarSignalConfig& config, uint32_t receiver, uint32_t transmitter,
                      const dvec3& direction);

}  // namespace greatx::rf
