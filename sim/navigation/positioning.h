// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Solves position, velocity and clock from ranges to satellites and their rates.
#pragma once

#include <optional>
#include <span>

#include "core/vec.h"

namespace greatx::navigation {

/// One satellite that the receiver tracks. All places are in one Cartesian frame.
struct RangeMeasurement {
  dvec3 satellite_m{0.0}, satellite_velocity{0.0};
  double range_m = 0.0;      ///< pseudorange: distance plus the receiver's clock error times c, plus errors
  double rate = 0.0;         ///< its derivative, m/s
  double range_std_m = 1.0;  ///< that the receiver takes for granted: weights and covariance follow
  double rate_std = 1.0;
};

/// Dilutions of precision, for equal errors of all satellites (Kaplan and Hegarty, Understanding GPS, 2nd
/// ed., section 7.3): geometry, position, horizontal, vertical, time. Horizontal is the plane of x and y.
struct Dilutions {
  double gdop = 0.0, pdop = 0.0, hdop = 0.0, vdop = 0.0, tdop = 0.0;
};

struct PositionFix {
  dvec3 position_m{0.0}, velocity{0.0};
  double clock_m = 0.0, clock_rate = 0.0;
  dmat3 position_covariance{0.0}, velocity_covariance{0.0};
  Dilutions dilutions;
};

/// Returns the dilutions for directions to satellites (unit vectors); nothing if they do not determine
/// position and time: fewer than 4, or all on a cone.
std::optional<Dilutions> dilutions_of(std::span<const dvec3> directions);

/// Solves by weighted least squares, iterated from `start_m` until a step is below 10 um (Kaplan and Hegarty,
/// section 2.4). Nothing, if the satellites do not determine the solution. Without errors the solution is the
/// truth to some 10 nm, the last bits of ranges of 2e7 m.
std::optional<PositionFix> solve_position(std::span<const RangeMeasurement> measurements,
                                          const dvec3& start_m);

}  // namespace greatx::navigation
