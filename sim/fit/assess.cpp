// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/assess.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace greatx::sim {
namespace {

/// Relative size of the ridge that stands for what rounding leaves of an exact dependence.
constexpr double ridge = 1e-10;
/// A slope that is this part of a typical residual per range of its variable is none.
constexpr double no_slope = 1e-9;
constexpr double prior_share = 0.9;

/// Returns the inverse of a symmetric matrix with a ridge of its own scale.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& of) {
  const Eigen::Index n = of.rows();
  Eigen::VectorXd unit(n);
  for (Eigen::Index i = 0; i < n; ++i) unit[i] = of(i, i) > 0.0 ? 1.0 / std::sqrt(of(i, i)) : 1.0;
  Eigen::MatrixXd scaled = unit.asDiagonal() * of * unit.asDiagonal();
  scaled.diagonal().array() += ridge;
  const Eigen::MatrixXd inverted = scaled.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  return unit.asDiagonal() * inverted * unit.asDiagonal();
}

bool is_positive(const Eigen::MatrixXd& of) {
  if (of.rows() == 0) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(of, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] > 0.0;
}

Eigen::MatrixXd part(const Eigen::MatrixXd& of, std::span<const Eigen::Index> kept) {
  const auto n = static_cast<Eigen::Index>(kept.size());
  Eigen::MatrixXd out(n, n);
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b)
      out(a, b) = of(kept[static_cast<size_t>(a)], kept[static_cast<size_t>(b)]);
  return out;
}

/// The matrices M of the covariance (assess()), over all variables.
struct Spread {
  Eigen::MatrixXd of_residuals, of_blocks;
  size_t blocks = 0;
};

Spread spread_of(const FitSums& sums, std::span<const uint32_t> blocks, size_t variables) {
  Spread spread;
  spread.of_residuals = sums.priors;
  const double rows = std::accumulate(sums.rows.begin(), sums.rows.end(), 0.0);
  for (size_t s = 0; s < sums.plain.size(); ++s) {
    const double free = sums.rows[s] * (1.0 - static_cast<double>(variables) / rows);
    if (free > 0.0) spread.of_residuals += sums.squares[s] / free * sums.plain[s];
  }
  std::map<uint32_t, Eigen::VectorXd> of_block;
  for (size_t l = 0; l < blocks.size(); ++l) {
    const auto [at, is_new] = of_block.try_emplace(blocks[l], sums.of_position[l]);
    if (!is_new) at->second += sums.of_position[l];
  }
  spread.blocks = of_block.size();
  const double count = static_cast<double>(spread.blocks);
  spread.of_blocks = sums.priors;
  if (spread.blocks > 1)
    for (const auto& [number, gradient] : of_block)
      spread.of_blocks += count / (count - 1.0) * gradient * gradient.transpose();
  return spread;
}

void find_directions(const Eigen::MatrixXd& plain, std::span<const Eigen::Index> touched, size_t variables,
                     FitAssessment& assessment) {
  if (touched.empty()) return;
  Eigen::MatrixXd scaled = part(plain, touched);
  const Eigen::VectorXd unit = scaled.diagonal().cwiseSqrt().cwiseInverse();
  scaled = unit.asDiagonal() * scaled * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  for (Eigen::Index d = 0; d < scaled.rows(); ++d) {
    FitDirection direction{std::sqrt(std::max(0.0, solver.eigenvalues()[d])),
                           std::vector<double>(variables, 0.0)};
    Eigen::Index largest = 0;
    solver.eigenvectors().col(d).cwiseAbs().maxCoeff(&largest);
    const double sign = solver.eigenvectors()(largest, d) < 0.0 ? -1.0 : 1.0;
    for (size_t a = 0; a < touched.size(); ++a)
      direction.parts[static_cast<size_t>(touched[a])] =
          sign * solver.eigenvectors()(static_cast<Eigen::Index>(a), d);
    assessment.directions.push_back(std::move(direction));
  }
}

void find_correlations(const Eigen::MatrixXd& plain, std::span<const Eigen::Index> touched,
                       FitAssessment& assessment) {
  const Eigen::MatrixXd covariance = inverse(part(plain, touched));
  for (size_t a = 0; a < touched.size(); ++a)
    for (size_t b = 0; b < touched.size(); ++b) {
      const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
      const double value =
          std::clamp(covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j)), -1.0, 1.0);
      assessment.correlation(touched[a], touched[b]) = a == b ? 1.0 : value;
      if (a < b && std::abs(value) > named_correlation)
        assessment.pairs.push_back(
            {static_cast<uint32_t>(touched[a]), static_cast<uint32_t>(touched[b]), value});
    }
  std::ranges::stable_sort(assessment.pairs, [](const FitPair& x, const FitPair& y) {
    return std::abs(x.correlation) > std::abs(y.correlation);
  });
}

void find_shares(const FitModel& model, const FitState& state, std::span<const uint32_t> links,
                 FitAssessment& assessment) {
  const size_t parameters = model.problem().parameters.size();
  assessment.shares.assign(parameters, 0.0);
  assessment.positions.assign(parameters, 0);
  for (const uint32_t link : links) {
    const std::vector<double> of = model.shares(state.coordinates, link);
    for (size_t p = 0; p < parameters; ++p) assessment.shares[p] += of[p] / static_cast<double>(links.size());
    std::vector<bool> touched(parameters);
    for (const FitLink::Touched& path : model.links()[link].touched)
      for (const uint32_t p : path.parameters) touched[p] = true;
    for (size_t p = 0; p < parameters; ++p) assessment.positions[p] += touched[p];
  }
}

}  // namespace

const char* name_of(FitVerdict verdict) {
  constexpr const char* names[] = {"determined", "untouched",      "no effect",
                                   "at a bound", "not determined", "by its prior"};
  return names[static_cast<size_t>(verdict)];
}

FitAssessment assess(const FitModel& model, const FitSolver& solver, const FitState& state,
                     std::span<const uint32_t> blocks) {
  const std::vector<FitVariable>& variables = model.variables();
  const auto count = static_cast<Eigen::Index>(variables.size());
  FitAssessment assessment;
  assessment.correlation = Eigen::MatrixXd::Zero(count, count);
  assessment.estimates.resize(variables.size());
  find_shares(model, state, solver.links(), assessment);
  const FitSums sums = solver.sums(state);
  Eigen::MatrixXd plain = Eigen::MatrixXd::Zero(count, count);
  for (const Eigen::MatrixXd& of_set : sums.plain) plain += of_set;
  const double rows = std::accumulate(sums.rows.begin(), sums.rows.end(), 0.0);

  std::vector<Eigen::Index> touched, inner;  // with an effect; of these, not at a bound
  for (Eigen::Index v = 0; v < count; ++v) {
    const auto index = static_cast<size_t>(v);
    const FitVariable& variable = variables[index];
    FitEstimate& estimate = assessment.estimates[index];
    const double at = state.coordinates[index], low = variable.coordinate(variable.low),
                 high = variable.coordinate(variable.high);
    estimate.value = variable.value(at);
    estimate.deviation = estimate.deviation_of_residuals = INFINITY;
    estimate.deviation_of_blocks = NAN;
    estimate.low = -INFINITY, estimate.high = INFINITY;
    const bool effect = plain(v, v) * (high - low) * (high - low) > no_slope * no_slope * rows;
    if (!effect) {
      const bool met = !variable.of_material || assessment.positions[index] > 0;
      estimate.verdict = met ? FitVerdict::no_effect : FitVerdict::untouched;
      continue;
    }
    touched.push_back(v);
    if ((at <= low && sums.gradient[v] > 0.0) || (at >= high && sums.gradient[v] < 0.0))
      estimate.verdict = FitVerdict::at_bound;
    else
      inner.push_back(v);
  }
  find_directions(plain, touched, variables.size(), assessment);
  find_correlations(plain, touched, assessment);

  const Spread spread = spread_of(sums, blocks, inner.size());
  Eigen::MatrixXd h = part(sums.curved, inner);
  if (!is_positive(h)) h = part(sums.weighted, inner);
  const Eigen::MatrixXd h_inverse = inverse(h);
  const Eigen::MatrixXd of_residuals = h_inverse * part(spread.of_residuals, inner) * h_inverse,
                        of_blocks = h_inverse * part(spread.of_blocks, inner) * h_inverse;
  const bool enough_blocks = spread.blocks >= std::max<size_t>(5, 2 * inner.size());
  for (size_t a = 0; a < inner.size(); ++a) {
    const auto v = static_cast<size_t>(inner[a]);
    const auto i = static_cast<Eigen::Index>(a);
    const FitVariable& variable = variables[v];
    FitEstimate& estimate = assessment.estimates[v];
    estimate.deviation_of_residuals = std::sqrt(std::max(0.0, of_residuals(i, i)));
    if (enough_blocks) estimate.deviation_of_blocks = std::sqrt(std::max(0.0, of_blocks(i, i)));
    estimate.deviation = std::fmax(estimate.deviation_of_residuals, estimate.deviation_of_blocks);
    estimate.low = variable.value(state.coordinates[v] - estimate.deviation);
    estimate.high = variable.value(state.coordinates[v] + estimate.deviation);
    if (variable.prior && estimate.deviation > prior_share * variable.prior->sigma)
      estimate.verdict = FitVerdict::by_prior;
    else if (estimate.deviation > variable.coordinate(variable.high) - variable.coordinate(variable.low))
      estimate.verdict = FitVerdict::undetermined;
  }
  return assessment;
}

}  // namespace greatx::sim
