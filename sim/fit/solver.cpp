// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/random.h"

namespace greatx::sim {
namespace {

constexpr double first_lambda = 1e-2, least_lambda = 1e-12, most_lambda = 1e12;
/// A step is the last one if it moves every variable by less than this part of its own deviation, or promises
/// less than this fall of the cost: variables are then within sqrt(2 * 1e-7) of a deviation of the minimum.
constexpr double small_step = 1e-6, small_fall = 1e-7;
/// The runs of a search only need to tell minima apart.
constexpr double small_fall_of_search = 1e-3;
/// Deviations that change by less than this part are settled.
constexpr double settled = 1e-2;
constexpr uint32_t most_rounds = 12, draws_of_start = 16, stream_of_starts = 0x66697473;
/// At least this many links tell minima apart, and good draws from bad ones.
constexpr size_t links_of_search = 256, links_of_draw = 64;
/// Smallest deviations that are estimated: dB, ns, dB, dB, and relative for complex values.
constexpr double least_sigma = 1e-4, least_relative_sigma = 1e-6;

/// Returns every nth link, at least `least` of them.
std::vector<uint32_t> every_nth(std::span<const uint32_t> links, size_t least) {
  const size_t step = std::max<size_t>(1, links.size() / least);
  std::vector<uint32_t> some;
  for (size_t l = 0; l < links.size(); l += step) some.push_back(links[l]);
  return some;
}

}  // namespace

FitSolver::FitSolver(const FitModel& model, std::vector<uint32_t> links)
    : model_(model), links_(std::move(links)), some_(every_nth(links_, links_of_search)) {
  if (links_.empty())
    throw_user_error("measurements: expected a position that paths reach, found none among those to fit");
}

bool FitSolver::is_free(size_t variable, FitStage stage) const {
  return stage != FitStage::unknowns || !model_.variables()[variable].of_material;
}

/// Begins a run at state.coordinates.
void FitSolver::begin_run(FitState& state, FitStage stage, uint32_t run) const {
  state.stage = stage;
  state.run = run;
  state.round = state.iteration = 0;
  state.lambda = first_lambda;
  const std::vector<FitBlock> blocks = model_.blocks(state.coordinates, links_of(stage), false);
  if (stage != FitStage::search) state.sigmas = estimated_sigmas(blocks);
  state.cost = sums(blocks, links_of(stage), state.coordinates, state.sigmas).cost;
}

FitState FitSolver::begin() const {
  FitState state;
  state.coordinates = model_.start(links_);
  state.converged = true;
  begin_run(state, FitStage::unknowns, 0);
  return state;
}

uint32_t FitSolver::runs_done(const FitState& state) const {
  if (state.done) return runs();
  if (state.stage == FitStage::unknowns) return 0;
  return state.stage == FitStage::search ? 1 + state.run : runs() - 1;
}

/// Returns the best of some draws within the bounds (and three deviations of a prior).
std::vector<double> FitSolver::drawn_start(const FitState& state) const {
  const std::vector<FitVariable>& variables = model_.variables();
  RandomStream random(model_.problem().seed, stream_of_starts, state.run);
  const std::vector<uint32_t> some = every_nth(some_, links_of_draw);
  std::vector<double> best;
  double least = INFINITY;
  for (uint32_t draw = 0; draw < draws_of_start; ++draw) {
    std::vector<double> tried = state.before;
    for (size_t v = 0; v < variables.size(); ++v) {
      if (variables[v].estimated) continue;
      double low = variables[v].coordinate(variables[v].low),
             high = variables[v].coordinate(variables[v].high);
      if (const std::optional<FitPrior>& prior = variables[v].prior) {
        low = std::clamp(prior->mean - 3.0 * prior->sigma, low, high);
        high = std::clamp(prior->mean + 3.0 * prior->sigma, low, high);
      }
      tried[v] = random.uniform(low, high);
    }
    tried = model_.estimated(tried, some);
    const double cost_there = sums(model_.blocks(tried, some, false), some, tried, state.sigmas).cost;
    if (best.empty() || cost_there < least) least = cost_there, best = std::move(tried);
  }
  return best;
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

FitSums FitSolver::sums(std::span<const FitBlock> blocks, std::span<const uint32_t> links,
                        std::span<const double> coordinates, std::span<const double> sigmas) const {
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
    const uint32_t set = model_.links()[links[b]].set;
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

std::span<const uint32_t> FitSolver::links_of(FitStage stage) const {
  return stage == FitStage::search ? some_ : links_;
}

double FitSolver::cost(FitStage stage, std::span<const double> coordinates,
                       std::span<const double> sigmas) const {
  const std::span<const uint32_t> links = links_of(stage);
  return sums(model_.blocks(coordinates, links, false), links, coordinates, sigmas).cost;
}

FitSums FitSolver::sums(const FitState& state) const {
  return sums(model_.blocks(state.coordinates, links_, true), links_, state.coordinates, state.sigmas);
}

/// Gives variables on which nothing depends the values that they had before: a draw may have moved them.
void FitSolver::reset_without_effect(FitState& state) const {
  const FitSums now = sums(state);
  std::vector<double> reset = state.coordinates;
  for (size_t v = 0; v < reset.size(); ++v)
    if (now.weighted(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(v)) == 0.0)
      reset[v] = state.before[v];
  if (reset != state.coordinates && cost(state.stage, reset, state.sigmas) <= state.cost)
    state.coordinates = std::move(reset);
}

/// Ends a run, and begins the next one.
void FitSolver::end_run(FitState& state) const {
  const uint32_t starts = model_.problem().starts;
  if (state.stage == FitStage::everything) {
    reset_without_effect(state);
    state.done = true;
    return;
  }
  if (state.stage == FitStage::unknowns) {
    state.before = state.coordinates;
    return begin_run(state, starts > 1 ? FitStage::search : FitStage::everything, 0);
  }
  if (state.best.empty() || state.cost < state.best_cost)
    state.best_cost = state.cost, state.best = state.coordinates;
  if (state.run + 1 < starts) {
    ++state.run;
    state.coordinates = drawn_start(state);
    return begin_run(state, FitStage::search, state.run);
  }
  state.coordinates = state.best;
  begin_run(state, FitStage::everything, 0);
}

/// Ends a round of iterations: the deviations are estimated afresh, and the run ends once they are settled.
void FitSolver::end_round(FitState& state, std::span<const FitBlock> blocks) const {
  const std::vector<double> sigmas = estimated_sigmas(blocks);
  bool same = true;
  for (size_t s = 0; s < sigmas.size(); ++s)
    same &= std::abs(sigmas[s] - state.sigmas[s]) <= settled * sigmas[s];
  ++state.round;
  if (same || state.round >= most_rounds || state.iteration >= model_.problem().iterations)
    return end_run(state);
  state.sigmas = sigmas;
  state.cost = sums(blocks, links_, state.coordinates, state.sigmas).cost;
  state.lambda = first_lambda;
}

void FitSolver::step(FitState& state) const {
  if (state.done) return;
  const std::vector<FitVariable>& variables = model_.variables();
  const std::span<const uint32_t> links = links_of(state.stage);
  const bool of_materials = state.stage != FitStage::unknowns;
  const std::vector<FitBlock> blocks = model_.blocks(state.coordinates, links, true, of_materials);
  const FitSums now = sums(blocks, links, state.coordinates, state.sigmas);
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
    for (Eigen::Index b = 0; b < count; ++b)
      scaled(a, b) = now.weighted(free[a], free[b]) * unit[a] * unit[b];
  const double last_fall = state.stage == FitStage::search ? small_fall_of_search : small_fall;
  bool moved = false, last = count == 0;
  for (; count > 0 && state.lambda <= most_lambda; state.lambda *= 10.0) {
    Eigen::MatrixXd damped = scaled;
    damped.diagonal() *= 1.0 + state.lambda;
    const Eigen::VectorXd step = damped.ldlt().solve(-gradient);
    const double promised = -gradient.dot(step) - 0.5 * step.dot(scaled * step);
    std::vector<double> tried = state.coordinates;
    double length = 0.0;
    for (Eigen::Index a = 0; a < count; ++a) {
      const auto v = static_cast<size_t>(free[a]);
      tried[v] = std::clamp(tried[v] + step[a] * unit[a], low[v], high[v]);
      length = std::max(length, std::abs(tried[v] - state.coordinates[v]) / unit[a]);
    }
    last = length <= small_step || promised <= last_fall;
    const double cost_there = cost(state.stage, tried, state.sigmas);
    if (!(cost_there < state.cost)) {
      if (last) break;
      continue;
    }
    state.coordinates = std::move(tried);
    state.cost = cost_there;
    state.lambda = std::max(least_lambda, 0.1 * state.lambda);
    moved = true;
    break;
  }
  last |= !moved;
  const bool out_of_iterations = state.iteration >= model_.problem().iterations;
  if (!last && !out_of_iterations) return;
  if (!last && state.stage != FitStage::search) state.converged = false;
  if (state.stage == FitStage::search) return end_run(state);
  end_round(state, moved ? model_.blocks(state.coordinates, links, false) : blocks);
}

}  // namespace greatx::sim
