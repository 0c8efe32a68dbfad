// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/navigation/positioning.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace greatx::navigation {

namespace {

constexpr int most_iterations = 20;
constexpr double last_step_m = 1e-5;
/// The determinant of the mean of w h h^T, with weights of mean 1, below which the geometry counts as
/// degenerate. That of a usable sky is about 1e-3.
constexpr double least_determinant = 1e-14;

/// Returns the inverse of sum w h h^T; nothing if it is singular. `scale` is the sum of the weights.
std::optional<dmat4> inverse_normal(const dmat4& normal, double scale) {
  const dmat4 unit = normal / scale;
  if (!(glm::determinant(unit) > least_determinant)) return std::nullopt;
  return glm::inverse(unit) / scale;
}

/// A row of the geometry matrix: the derivative of a range by position and clock.
dvec4 row_of(const dvec3& direction) { return {-direction, 1.0}; }

dmat3 upper_left(const dmat4& m) { return dmat3(m); }

/// The least share of a measurement's variance that its residual must keep, so that others check it.
constexpr double least_checked = 1e-9;

/// The residuals of a fit over their standard deviations, and the sum of the squares of those over the
/// measurements' deviations. `covariance` is that of the unknowns.
class Residuals {
 public:
  explicit Residuals(const dmat4& covariance) : covariance_(covariance) {}
  void add(double residual, double deviation, const dvec4& row) {
    const double scaled = residual / deviation;
    statistic += scaled * scaled;
    const double kept = 1.0 - glm::dot(row, covariance_ * row) / (deviation * deviation);
    normalized.push_back(kept > least_checked ? scaled / std::sqrt(kept) : 0.0);
  }
  double statistic = 0.0;
  std::vector<double> normalized;

 private:
  dmat4 covariance_;
};

}  // namespace

std::optional<Dilutions> dilutions_of(std::span<const dvec3> directions) {
  if (directions.size() < 4) return std::nullopt;
  dmat4 normal(0.0);
  for (const dvec3& direction : directions) normal += glm::outerProduct(row_of(direction), row_of(direction));
  const std::optional<dmat4> q = inverse_normal(normal, static_cast<double>(directions.size()));
  if (!q) return std::nullopt;
  const auto root = [](double variance) { return std::sqrt(variance); };
  const dmat4& m = *q;
  return Dilutions{.gdop = root(m[0][0] + m[1][1] + m[2][2] + m[3][3]),
                   .pdop = root(m[0][0] + m[1][1] + m[2][2]),
                   .hdop = root(m[0][0] + m[1][1]),
                   .vdop = root(m[2][2]),
                   .tdop = root(m[3][3])};
}

std::optional<PositionFix> solve_position(std::span<const RangeMeasurement> measurements,
                                          const dvec3& start_m) {
  if (measurements.size() < 4) return std::nullopt;
  PositionFix fix;
  fix.position_m = start_m;
  std::vector<dvec3> directions(measurements.size());
  std::optional<dmat4> covariance;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    dmat4 normal(0.0);
    dvec4 right(0.0);
    double weights = 0.0;
    for (size_t i = 0; i < measurements.size(); ++i) {
      const RangeMeasurement& m = measurements[i];
      const dvec3 to = m.satellite_m - fix.position_m;
      const double distance = glm::length(to), weight = 1.0 / (m.range_std_m * m.range_std_m);
      directions[i] = to / distance;
      const dvec4 row = row_of(directions[i]);
      normal += weight * glm::outerProduct(row, row);
      right += weight * (m.range_m - distance - fix.clock_m) * row;
      weights += weight;
    }
    covariance = inverse_normal(normal, weights);
    if (!covariance) return std::nullopt;
    const dvec4 step = *covariance * right;
    fix.position_m += dvec3(step);
    fix.clock_m += step.w;
    if (glm::length(step) < last_step_m) break;
    if (iteration + 1 == most_iterations) return std::nullopt;
  }
  fix.position_covariance = upper_left(*covariance);
  Residuals ranges(*covariance);
  for (size_t i = 0; i < measurements.size(); ++i) {
    const RangeMeasurement& m = measurements[i];
    const double distance = glm::length(m.satellite_m - fix.position_m);
    ranges.add(m.range_m - distance - fix.clock_m, m.range_std_m, row_of(directions[i]));
  }

  dmat4 normal(0.0);
  dvec4 right(0.0);
  double weights = 0.0;
  for (size_t i = 0; i < measurements.size(); ++i) {
    const RangeMeasurement& m = measurements[i];
    const double weight = 1.0 / (m.rate_std * m.rate_std);
    const dvec4 row = row_of(directions[i]);
    normal += weight * glm::outerProduct(row, row);
    right += weight * (m.rate - glm::dot(directions[i], m.satellite_velocity)) * row;
    weights += weight;
  }
  const std::optional<dmat4> rate_covariance = inverse_normal(normal, weights);
  const std::optional<Dilutions> dilutions = dilutions_of(directions);
  if (!rate_covariance || !dilutions) return std::nullopt;
  const dvec4 rates = *rate_covariance * right;
  fix.velocity = dvec3(rates);
  fix.clock_rate = rates.w;
  fix.velocity_covariance = upper_left(*rate_covariance);
  Residuals slopes(*rate_covariance);
  for (size_t i = 0; i < measurements.size(); ++i) {
    const RangeMeasurement& m = measurements[i];
    const dvec4 row = row_of(directions[i]);
    slopes.add(m.rate - glm::dot(directions[i], m.satellite_velocity) - glm::dot(row, rates), m.rate_std,
               row);
  }
  fix.dilutions = *dilutions;
  fix.redundancy = static_cast<uint32_t>(measurements.size()) - 4;
  fix.range_statistic = ranges.statistic, fix.rate_statistic = slopes.statistic;
  fix.range_residuals = std::move(ranges.normalized), fix.rate_residuals = std::move(slopes.normalized);
  return fix;
}

double chi_squared_tail(double value, uint32_t degrees) {
  if (degrees == 0 || value <= 0.0) return 1.0;
  const double half = 0.5 * value;
  const bool odd = degrees % 2 == 1;
  double tail = odd ? std::erfc(std::sqrt(half)) : std::exp(-half);
  // Terms half^(k/2) e^-half / Gamma(k/2 + 1), k = degrees - 2, degrees - 4, ...
  double term = odd ? std::sqrt(half / pi) * 2.0 * std::exp(-half) : half * std::exp(-half);
  for (uint32_t k = odd ? 1 : 2; k + 2 <= degrees; k += 2) {
    tail += term;
    term *= half / (0.5 * k + 1.0);
  }
  return tail;
}

std::optional<CheckedFix> solve_checked(std::span<const RangeMeasurement> measurements, const dvec3& start_m,
                                        double false_alarm) {
  constexpr size_t least_left = 5;
  std::vector<RangeMeasurement> kept(measurements.begin(), measurements.end());
  std::vector<size_t> numbers(measurements.size());
  for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
  std::optional<PositionFix> fix = solve_position(kept, start_m);
  if (!fix) return std::nullopt;
  const auto disagree = [&](double statistic) {
    return chi_squared_tail(statistic, fix->redundancy) < false_alarm;
  };
  const auto magnitude = [](double a, double b) { return std::abs(a) < std::abs(b); };
  while (kept.size() > least_left && (disagree(fix->range_statistic) || disagree(fix->rate_statistic))) {
    const std::vector<double>& residuals =
        disagree(fix->range_statistic) ? fix->range_residuals : fix->rate_residuals;
    const auto worst = std::ranges::max_element(residuals, magnitude) - residuals.begin();
    std::vector<RangeMeasurement> fewer = kept;
    fewer.erase(fewer.begin() + worst);
    std::optional<PositionFix> next = solve_position(fewer, fix->position_m);
    if (!next) break;  // the rest does not determine a position
    kept = std::move(fewer), fix = std::move(next);
    numbers.erase(numbers.begin() + worst);
  }
  CheckedFix out{.used = std::vector<bool>(measurements.size(), false),
                 .ranges_disagree = disagree(fix->range_statistic),
                 .rates_disagree = disagree(fix->rate_statistic)};
  if (out.ranges_disagree) fix->position_covariance *= fix->range_statistic / fix->redundancy;
  if (out.rates_disagree) fix->velocity_covariance *= fix->rate_statistic / fix->redundancy;
  for (const size_t i : numbers) out.used[i] = true;
  out.fix = std::move(*fix);
  return out;
}

}  // namespace greatx::navigation
