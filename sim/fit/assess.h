// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Says how well the measurements determine the variables of a finished fit.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/fit/solver.h"

namespace greatx::sim {

/// Why a variable has no deviation of its own, or is to be taken with care.
enum class FitVerdict : uint8_t {
  determined,
  untouched,     ///< no path to the fitted positions meets its materials
  no_effect,     ///< paths meet them, but no measurement changes with it
  at_bound,      ///< the measurements pull it beyond a bound
  undetermined,  ///< its deviation is larger than the range between its bounds
  by_prior       ///< its deviation is nearly that of its prior
};
const char* name_of(FitVerdict verdict);

/// What the fit says of one variable. Deviations and intervals are infinite if nothing determines it.
struct FitEstimate {
  double value = 0.0;
  double deviation = 0.0;        ///< of the coordinate
  double low = 0.0, high = 0.0;  ///< one deviation below and above, as values
  /// The same deviation from residuals alone that are taken as independent, and from whole blocks of the
  /// plan; NaN: there are too few blocks.
  double deviation_of_residuals = 0.0, deviation_of_blocks = 0.0;
  FitVerdict verdict = FitVerdict::determined;
};

/// Two variables that the measurements hardly tell apart.
struct FitPair {
  uint32_t first = 0, second = 0;
  double correlation = 0.0;  ///< of their errors, by the measurements alone
};

/// A combination of variables, in units of the deviations that each would have alone.
struct FitDirection {
  double singular_value = 0.0;  ///< 1: as well determined as a variable alone; 0: not at all
  std::vector<double> parts;    ///< [variables] of unit length
};

struct FitAssessment {
  std::vector<FitEstimate> estimates;    ///< [variables]
  Eigen::MatrixXd correlation;           ///< [variables, variables], measurements alone; 0 if not determined
  std::vector<FitPair> pairs;            ///< |correlation| above 0.95, largest first
  std::vector<FitDirection> directions;  ///< ascending singular values, without untouched variables
  std::vector<double> shares;            ///< [parameters] mean share of a position's power that depends on it
  std::vector<uint32_t> positions;       ///< [parameters] fitted positions with a path that depends on it
};

/// Assesses a fit. `blocks`: for each fitted link, the number of its block of the plan.
///
/// With psi and psi' of the loss, the residuals x in deviations, and J their slopes, the covariance is H^-1 M
/// H^-1 with H = sum psi' J J^T + P, P of the priors (P. J. Huber, Robust Statistics, 1981, 7.6). M is once
/// sum over sets of mean(psi^2) J J^T + P, with n - p in place of n for p variables; and once the sum over
/// blocks of g g^T with g = sum psi J of a block, times blocks/(blocks - 1), + P, which stays right if
/// residuals of one block have a common cause (K.-Y. Liang, S. L. Zeger, Biometrika 73(1), 1986). It needs
/// at least twice as many blocks as free variables, and five. The deviation is the larger of the two.
///
/// Singular values are those of J with columns of unit length.
FitAssessment assess(const FitModel& model, const FitSolver& solver, const FitState& state,
                     std::span<const uint32_t> blocks);

/// Correlations above this are named.
inline constexpr double named_correlation = 0.95;

}  // namespace greatx::sim
