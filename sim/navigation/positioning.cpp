// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/navigation/positioning.h"

#include <cmath>
#include <vector>

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
  fix.dilutions = *dilutions;
  return fix;
}

}  // namespace greatx::navigation
