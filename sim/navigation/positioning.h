// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Solves position, velocity and clock from ranges to satellites and their rates, and checks by the residuals
// whether the ranges agree with each other.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

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
  /// Sums of squares of residuals over their standard deviations. If all errors are normal and as stated,
  /// they are chi-squared of `redundancy` degrees of freedom, the number of satellites beyond 4.
  double range_statistic = 0.0, rate_statistic = 0.0;
  uint32_t redundancy = 0;
  /// [measurement] residuals over their own standard deviations, those of measurements less what the fit
  /// takes up; 0 where nothing else checks a measurement.
  std::vector<double> range_residuals, rate_residuals;
};

/// Returns the dilutions for directions to satellites (unit vectors); nothing if they do not determine
/// position and time: fewer than 4, or all on a cone.
std::optional<Dilutions> dilutions_of(std::span<const dvec3> directions);

/// Solves by weighted least squares, iterated from `start_m` until a step is below 10 um (Kaplan and Hegarty,
/// section 2.4). Nothing, if the satellites do not determine the solution. Without errors the solution is the
/// truth to some 10 nm, the last bits of ranges of 2e7 m.
std::optional<PositionFix> solve_position(std::span<const RangeMeasurement> measurements,
                                          const dvec3& start_m);

/// Returns the probability that a chi-squared variable of `degrees` of freedom exceeds `value` (the upper
/// tail of Abramowitz and Stegun, eqs. 26.4.4 and 26.4.5); 1 for no degrees.
double chi_squared_tail(double value, uint32_t degrees);

/// A fix whose ranges were checked, and what the check has found.
struct CheckedFix {
  PositionFix fix;
  std::vector<bool> used;  ///< [measurement] false: excluded from position and velocity
  /// The ranges, or the rates, that were kept do not agree, and too few are left to say which is wrong. The
  /// covariance then is that of the stated errors times the statistic over its mean (the a posteriori
  /// variance of unit weight).
  bool ranges_disagree = false, rates_disagree = false;
};

/// Solves the position and monitors its integrity: if the statistic of the ranges or of the rates exceeds the
/// threshold that errors as stated exceed with the probability `false_alarm`, the measurement with the
/// largest residual over its standard deviation is left out and the rest is solved again, while 5 remain (B.
/// W. Parkinson and P. Axelrad, Autonomous GPS integrity monitoring using the pseudorange residual,
/// Navigation 35 (1988), and R. G. Brown, Navigation 39 (1992), for the statistic and its threshold; W.
/// Baarda, A testing procedure for use in geodetic networks (1968), for the residual that names the worst). 5
/// satellites show that something is wrong but not which; 4 show nothing.
std::optional<CheckedFix> solve_checked(std::span<const RangeMeasurement> measurements, const dvec3& start_m,
                                        double false_alarm);

}  // namespace greatx::navigation
