// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a link's paths amount to: gain, delay, angles, Doppler, how much of it is the line of sight.
// Everything that reports such figures (channel sensor, radio maps, `greatx paths`, Python) takes them from
// here, so that they agree to the bit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Power gain of each path, [paths]: the mean over all pairs of ports of |a|^2, a as in ImpulseResponse, in
/// fp64. In the order of `paths`. Thread-safe.
std::vector<double> path_powers(std::span<const Path> paths, const ArrayPose& transmitter,
                                const ArrayPose& receiver, double carrier_hz);

/// Means and spreads are weighted by power. If no path has power, path_gain is 0 and all that follows it is
/// NaN.
struct LinkStatistics {
  uint32_t paths = 0;
  bool line_of_sight = false;   ///< a path without interactions is there, whatever its power
  double path_gain = 0.0;       ///< sum of the paths' powers: fields of different paths are not added
  double mean_delay_s = 0.0;    ///< absolute
  double delay_spread_s = 0.0;  ///< rms
  /// Rician: power of the line of sight over that of all others; 0: no line of sight, +inf: nothing else.
  double k_factor = 0.0;
  /// Circular angle spreads sqrt(-2 ln |sum p e^{j phi} / sum p|), rad: 3GPP TR 38.901, Annex A.1, eq. A-1.
  /// World directions; 0 for one direction, without an upper bound: +inf where the directions cancel out.
  double departure_azimuth_spread = 0.0, departure_zenith_spread = 0.0;
  double arrival_azimuth_spread = 0.0, arrival_zenith_spread = 0.0;
  double mean_doppler_hz = 0.0, doppler_spread_hz = 0.0;  ///< rms
};

/// `powers` [paths], finite and not negative. Sums are in the order of what is summed, not of `paths`: any
/// permutation gives the same bits. Spreads are formed from differences about the mean, so that those of one
/// path (or of several with one delay, angle, shift) are exactly 0. Thread-safe.
LinkStatistics link_statistics(std::span<const Path> paths, std::span<const double> powers);

}  // namespace greatx::rf
