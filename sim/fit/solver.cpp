// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/solver.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/error.h"

namespace greatx::sim {
namespace {

constexpr double first_lambda = 1e-2, least_lambda = 1e-12, most_lambda = 1e12;
/// A step is small if it moves every variable by less than this part of its deviation, roughly.
constexpr double small_step = 1e-6;
/// Deviations that change by less than this part are settled.
constexpr double settled = 1e-3;
constexpr uint32_t most_rounds = 12;
/// Smallest deviations that are estimated: dB, ns, dB, dB, and relative for complex values.
constexpr double least_sigma = 1e-4, least_relative_sigma = 1e-6;

}  // namespace

FitSolver::FitSolver(const FitModel& model, std::vector<uint32_t> links)
    : model_(model), links_(std::move(links)) {
  if (links_.empty())
    throw_user_error("measurements: expected a position that paths reach, found none among those to fit");
}

bool FitSolver::is_free(size_t variable, uint32_t stage) const {
  return stage == 1 || !model_.variables()[variable].of_material;
}

void FitSolver::begin_stage(FitState& state, uint32_t stage) const {
  state.stage = stage;
  state.round = state.iteration = 0;
  state.lambda = first_lambda;
  const std::vector<FitBlock> blocks = model_.blocks(state.coordinates, links_, false);
  state.sigmas = estimated_sigmas(blocks);
  state.cost = sums(blocks, state.coordinates, state.sigmas).cost;
}

FitState FitSolver::begin() const {
  FitState state;
  state.coordinates = model_.start(links_);
  state.converged = true;
  const bool unknowns = std::ranges::any_of(model_.variables(), [](const FitVariable& v) { return !v.of_material; });
  if (!unknowns) state.before = state.coordinates;
  begin_stage(state, unknowns ? 0 : 1);
  return state;
}

std::vector<double> FitSolver::estimated_sigmas(std::span<const FitBlock> blocks) const {
  const std::vector<FitSet>& sets = model_.problem().sets;
  std::vector<std::vector<double>> magnitudes(sets.size());
  for (size_t b = 0; b < blocks.size(); ++b)
    for (const double residual : blocks[b].residuals)
      magnitudes[model_.links()[links_[b]].set].push_back(std::abs(residual));
  std::vector<double> sigmas;
  for (size_t s = 0; s < sets.size(); ++s) {
    const double least = sets[s].complex_values ? least_relative_sigma : least_sigma;
    std::vector<double>& of = magnitudes[s];
    double sigma = sets[s].sigma.value_or(least);
    if (!sets[s].sigma && !of.empty()) {
      const auto middle = of.begin() + static_cast<ptrdiff_t>(of.size() / 2);
      std::nth_element(of.begin(), middle, of.end());
      sigma = std::max(least, 1.4826 * *middle);
    }
    sigmas.push_back(sigma);
  }
  return sigmas;
}

FitSums FitSolver::sums(std::span<const FitBlock> blocks, std::span<const double> coordinates,
                        std::span<const double> sigmas) const {
  const auto variables = static_cast<Eigen::Index>(model_.variables().size());
  const FitLoss& loss = model_.problem().loss;
  const bool slopes = !blocks.empty() && blocks[0].slopes.size() > 0;
  FitSums sums;
  const size_t sets = sigmas.size();
  sums.gradient = Eigen::VectorXd::Zero(variables);
  sums.weighted = sums.curved = sums.priors = Eigen::MatrixXd::Zero(variables, variables);
  sums.plain.assign(sets, Eigen::MatrixXd::Zero(variables, variables));
  sums.squares.assign(sets, 0.0);
  sums.rows.assign(sets, 0.0);
  for (size_t b = 0; b < blocks.size(); ++b) {
    const FitBlock& block = blocks[b];
    const uint32_t set = model_.links()[links_[b]].set;
    const Eigen::VectorXd x = block.residuals / sigmas[set];
    for (const double one : x) {
      sums.cost += loss.cost(one);
      sums.squares[set] += loss.slope(one) * loss.slope(one);
    }
    sums.rows[set] += static_cast<double>(x.size()) - block.own_unknowns;
    Eigen::VectorXd& own = sums.of_position.emplace_back(Eigen::VectorXd::Zero(variables));
    if (!slopes || block.columns.empty()) continue;
    const Eigen::MatrixXd j = block.slopes / sigmas[set];
    const Eigen::VectorXd weight = x.unaryExpr([&](double one) { return loss.weight(one); }),
                          curvature = x.unaryExpr([&](double one) { return loss.curvature(one); });
    const Eigen::VectorXd gradient = j.transpose() * weight.cwiseProduct(x);
    const Eigen::MatrixXd weighted = j.transpose() * weight.asDiagonal() * j,
                          curved = j.transpose() * curvature.asDiagonal() * j, plain = j.transpose() * j;
    for (size_t a = 0; a < block.columns.size(); ++a) {
      const auto row = static_cast<Eigen::Index>(a);
      const auto to = static_cast<Eigen::Index>(block.columns[a]);
      own[to] = gradient[row];
      for (size_t c = 0; c < block.columns.size(); ++c) {
        const auto column = static_cast<Eigen::Index>(c);
        const auto over = static_cast<Eigen::Index>(block.columns[c]);
        sums.weighted(to, over) += weighted(row, column);
        sums.curved(to, over) += curved(row, column);
        sums.plain[set](to, over) += plain(row, column);
      }
    }
    sums.gradient += own;
  }
  for (Eigen::Index v = 0; v < variables; ++v) {
    const std::optional<FitPrior>& prior = model_.variables()[static_cast<size_t>(v)].prior;
    if (!prior) continue;
    const double x = (coordinates[static_cast<size_t>(v)] - prior->mean) / prior->sigma;
    sums.cost += 0.5 * x * x;
    sums.gradient[v] += x / prior->sigma;
    sums.priors(v, v) = 1.0 / (prior->sigma * prior->sigma);
  }
  sums.weighted += sums.priors;
  sums.curved += sums.priors;
  return sums;
}

double FitSolver::cost(std::span<const double> coordinates, std::span<const double> sigmas) const {
  return sums(model_.blocks(coordinates, links_, false), coordinates, sigmas).cost;
}

FitSums FitSolver::sums(const FitState& state) const {
  return sums(model_.blocks(state.coordinates, links_, true), state.coordinates, state.sigmas);
}

/// Ends a round of iterations: the deviations are estimated afresh, and the stage ends once they are settled.
void FitSolver::end_round(FitState& state, std::span<const FitBlock> blocks) const {
  const std::vector<double> sigmas = estimated_sigmas(blocks);
  bool same = true;
  for (size_t s = 0; s < sigmas.size(); ++s) same &= std::abs(sigmas[s] - state.sigmas[s]) <= settled * sigmas[s];
  ++state.round;
  const bool out_of_iterations = state.iteration >= model_.problem().iterations;
  if (!same && state.round < most_rounds && !out_of_iterations) {
    state.sigmas = sigmas;
    state.cost = sums(blocks, state.coordinates, state.sigmas).cost;
    state.lambda = first_lambda;
    return;
  }
  if (state.stage == 1) {
    state.done = true;
    return;
  }
  state.before = state.coordinates;
  begin_stage(state, 1);
}

void FitSolver::step(FitState& state) const {
  if (state.done) return;
  const std::vector<FitVariable>& variables = model_.variables();
  const std::vector<FitBlock> blocks = model_.blocks(state.coordinates, links_, true);
  const FitSums now = sums(blocks, state.coordinates, state.sigmas);
  std::vector<Eigen::Index> free;
  std::vector<double> low, high;
  for (size_t v = 0; v < variables.size(); ++v) {
    low.push_back(variables[v].coordinate(variables[v].low));
    high.push_back(variables[v].coordinate(variables[v].high));
    const double at = state.coordinates[v], slope = now.gradient[static_cast<Eigen::Index>(v)];
    const bool held = (at <= low[v] && slope >= 0.0) || (at >= high[v] && slope <= 0.0);
    const auto index = static_cast<Eigen::Index>(v);
    if (is_free(v, state.stage) && !held && now.weighted(index, index) > 0.0) free.push_back(index);
  }
  ++state.iteration;
  const auto count = static_cast<Eigen::Index>(free.size());
  // In units of the variables' own deviations, so that one lambda suits all.
  Eigen::VectorXd unit(count), gradient(count);
  Eigen::MatrixXd scaled(count, count);
  for (Eigen::Index a = 0; a < count; ++a) {
    unit[a] = 1.0 / std::sqrt(now.weighted(free[a], free[a]));
    gradient[a] = now.gradient[free[a]] * unit[a];
  }
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index b = 0; b < count; ++b) scaled(a, b) = now.weighted(free[a], free[b]) * unit[a] * unit[b];
  bool moved = false;
  double length = 0.0;
  for (; count > 0 && state.lambda <= most_lambda; state.lambda *= 10.0) {
    Eigen::MatrixXd damped = scaled;
    damped.diagonal() *= 1.0 + state.lambda;
    const Eigen::VectorXd step = damped.ldlt().solve(-gradient);
    std::vector<double> tried = state.coordinates;
    length = 0.0;
    for (Eigen::Index a = 0; a < count; ++a) {
      const auto v = static_cast<size_t>(free[a]);
      tried[v] = std::clamp(tried[v] + step[a] * unit[a], low[v], high[v]);
      length = std::max(length, std::abs(tried[v] - state.coordinates[v]) / unit[a]);
    }
    if (length <= small_step) break;
    const double cost_there = cost(tried, state.sigmas);
    if (!(cost_there < state.cost)) continue;
    state.coordinates = std::move(tried);
    state.cost = cost_there;
    state.lambda = std::max(least_lambda, 0.1 * state.lambda);
    moved = true;
    break;
  }
  const bool at_the_end = !moved || length <= small_step;
  const bool out_of_iterations = state.iteration >= model_.problem().iterations;
  if (!at_the_end && !out_of_iterations) return;
  if (!at_the_end) state.converged = false;
  end_round(state, moved ? model_.blocks(state.coordinates, links_, false) : blocks);
}

}  // namespace greatx::sim
