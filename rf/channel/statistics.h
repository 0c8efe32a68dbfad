// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Summarises a link's paths: gain, delay, angles, Doppler shift and the share of the line of sight. The
// channel sensor, radio maps, `greatx paths` and Python all take these figures from here, so that they agree
// to the bit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Returns the power gain of each path, [paths], in the order of `paths`: the mean of |a|^2 over all pairs of
/// ports, with a as in ImpulseResponse, in fp64. Thread-safe.
std::vector<double> path_powers(std::span<const Path> paths, const ArrayPose& transmitter,
                                const ArrayPose& receiver, double carrier_hz);

/// Returns an estimate of the standard deviation of the sum of `powers`, [paths], by the draws of scatterings
/// (rf/paths/scatter_draw.h). A stratum of which nothing is among the paths was hidden. Neighbouring strata
/// are compared (collapsed strata: W. G. Cochran, Sampling Techniques, 3rd ed., 1977, 5A.12), so that the
/// estimate also holds their true difference and is on average too large. Paths with two bends add the
/// variance of the draw before that of the strata (GeometricPath::draw_variance). 0: nothing was drawn.
/// Thread-safe.
double drawn_deviation(std::span<const Path> paths, std::span<const double> powers);

/// Holds the statistics of a link. Means and spreads are weighted by power. If no path has power, path_gain
/// and its deviation are 0, and all members after them are NaN.
struct LinkStatistics {
  uint32_t paths = 0;
  bool line_of_sight = false;  ///< whether a path without interactions exists, whatever its power
  double path_gain = 0.0;      ///< sum of the paths' powers; fields of different paths are not added
  /// Estimate of the standard deviation of path_gain by the draws of scatterings (drawn_deviation()).
  double path_gain_deviation = 0.0;
  double mean_delay_s = 0.0;    ///< absolute
  double delay_spread_s = 0.0;  ///< rms
  /// Rician K: power of the line of sight over the power of all other paths. 0 without a line of sight, +inf
  /// without other paths.
  double k_factor = 0.0;
  /// Circular angle spreads sqrt(-2 ln |sum p e^{j phi} / sum p|), rad, of world directions: 3GPP TR 38.901,
  /// Annex A.1, eq. A-1. The spread is 0 for one direction. It has no upper bound and is +inf if the
  /// directions cancel.
  double departure_azimuth_spread = 0.0, departure_zenith_spread = 0.0;
  double arrival_azimuth_spread = 0.0, arrival_zenith_spread = 0.0;
  double mean_doppler_hz = 0.0, doppler_spread_hz = 0.0;  ///< the spread is rms
};

/// Computes the statistics. `powers` is [paths], finite and not negative. Sums are ordered by the summed
/// values and not by `paths`: any permutation gives the same bits. Spreads are formed from differences about
/// the mean. Therefore the spread of one path (or of several paths with the same delay, angle or shift) is
/// exactly 0. Thread-safe.
LinkStatistics link_statistics(std::span<const Path> paths, std::span<const double> powers);

}  // namespace greatx::rf
