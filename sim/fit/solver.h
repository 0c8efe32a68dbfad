// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Fits the variables of a model by Levenberg's and Marquardt's method, within bounds, with priors and a
// robust loss.
//
// The cost is sum over rows of loss(residual/sigma) + sum over priors of ((u - mean)/sigma)^2/2. An iteration
// solves (H + lambda diag H) step = -g, with H = J^T W J and the weights W of the loss (iterative
// reweighting: P. W. Holland, R. E. Welsch, Commun. Stat. 6(9), 1977), for the variables that are not held at
// a bound by their gradient, clamps the result to the bounds, and takes it if the cost falls (J. J. More,
// "The Levenberg-Marquardt algorithm", LNM 630, 1978). A deviation that is not given is estimated, between
// rounds of iterations, as 1.4826 times the median of the magnitudes of the residuals of the set.
//
// A fit has three stages.
// - unknowns: only those of the measurement, with the materials of the scene. Its end is what "before" means.
// - search: some runs over everything, with the deviations of the stage before, so that their costs compare,
//   and on every nth position, so that 256 to 512 remain. Walls of finite thickness give the cost many
//   minima. The first run begins at the end of the stage before, each other one at the best of some random
//   draws within the bounds.
// - everything: from the best run on.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/fit/model.h"

namespace greatx::sim {

enum class FitStage : uint8_t { unknowns, search, everything };

/// Where a fit stands. A fit goes on from it with the same bits as if it had never been stopped.
struct FitState {
  FitStage stage = FitStage::unknowns;
  uint32_t run = 0, round = 0, iteration = 0;  ///< iteration: of this run
  double lambda = 0.0;
  double cost = 0.0;
  bool converged = false;  ///< of the stages so far
  bool done = false;
  std::vector<double> coordinates;  ///< [variables]
  std::vector<double> sigmas;       ///< [sets]
  std::vector<double> before;       ///< coordinates at the end of the first stage; empty until then
  double best_cost = 0.0;           ///< of the runs of the search so far
  std::vector<double> best;         ///< its coordinates; empty: no run has ended
};

/// The sums that an iteration, and the uncertainties after the last one, are made of. All are in units of the
/// deviations.
struct FitSums {
  double cost = 0.0;
  Eigen::VectorXd gradient;                  ///< of the cost
  Eigen::MatrixXd weighted;                  ///< sum of w J J^T + priors
  Eigen::MatrixXd curved;                    ///< sum of psi' J J^T + priors
  Eigen::MatrixXd priors;                    ///< their part: a diagonal
  std::vector<Eigen::MatrixXd> plain;        ///< [sets] sum of J J^T
  std::vector<double> squares;               ///< [sets] sum of psi^2
  std::vector<double> rows;                  ///< [sets] rows less the unknowns of positions
  std::vector<Eigen::VectorXd> of_position;  ///< [links] gradient of each position
};

class FitSolver {
 public:
  /// `model` outlives this. `links`: indices of usable links. Throws UserError if there is none.
  FitSolver(const FitModel& model, std::vector<uint32_t> links);
  const std::vector<uint32_t>& links() const { return links_; }

  FitState begin() const;
  /// Makes one iteration. Does nothing to a state that is done.
  void step(FitState& state) const;
  /// Returns the number of runs, and of those that are done.
  uint32_t runs() const { return 2 + (model_.problem().starts > 1 ? model_.problem().starts : 0); }
  uint32_t runs_done(const FitState& state) const;
  FitSums sums(const FitState& state) const;

 private:
  /// Returns the links that a stage uses.
  std::span<const uint32_t> links_of(FitStage stage) const;
  double cost(FitStage stage, std::span<const double> coordinates, std::span<const double> sigmas) const;
  FitSums sums(std::span<const FitBlock> blocks, std::span<const uint32_t> links,
               std::span<const double> coordinates, std::span<const double> sigmas) const;
  std::vector<double> estimated_sigmas(std::span<const FitBlock> blocks) const;
  bool is_free(size_t variable, FitStage stage) const;
  std::vector<double> drawn_start(const FitState& state) const;
  void begin_run(FitState& state, FitStage stage, uint32_t run) const;
  void reset_without_effect(FitState& state) const;
  void end_run(FitState& state) const;
  void end_round(FitState& state, std::span<const FitBlock> blocks) const;

  const FitModel& model_;
  std::vector<uint32_t> links_, some_;  ///< to fit; every nth of them, for the search
};

}  // namespace greatx::sim
