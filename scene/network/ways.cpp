// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/network/ways.h"

#include <algorithm>
#include <cmath>

namespace greatx::scene {
namespace {

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Returns 25 points of the Bezier curve whose control points lie `handle` apart on the lines at both ends.
std::vector<dvec2> bezier(const dvec2& from, const dvec2& from_direction, const dvec2& to,
                          const dvec2& to_direction, double handle) {
  const dvec2 a = from + handle * from_direction, b = a + handle * from_direction;
  const dvec2 d = to - handle * to_direction, c = d - handle * to_direction;
  std::vector<dvec2> points;
  constexpr int steps = 24;
  for (int i = 0; i <= steps; ++i) {
    const double u = static_cast<double>(i) / steps, v = 1.0 - u;
    points.push_back(v * v * v * v * v * from + 5.0 * u * v * v * v * v * a + 10.0 * u * u * v * v * v * b +
                     10.0 * u * u * u * v * v * c + 5.0 * u * u * u * u * v * d + u * u * u * u * u * to);
  }
  return points;
}

}  // namespace

std::vector<dvec2> turn_line(const dvec2& from, const dvec2& from_direction, const dvec2& to,
                             const dvec2& to_direction) {
  const double sine = cross(from_direction, to_direction);
  if (std::abs(sine) <= 0.5)
    return bezier(from, from_direction, to, to_direction, 0.2 * glm::distance(from, to));
  const double before = cross(to - from, to_direction) / sine;   // from the start to the corner
  const double after = cross(from_direction, to - from) / sine;  // from the corner to the end
  const double reach = std::min(before, after);
  if (reach <= 0.0)  // the corner lies behind one of them
    return bezier(from, from_direction, to, to_direction, 0.25 * glm::distance(from, to));
  std::vector<dvec2> line{from};
  const double handle = 0.3 * reach;  // gives the widest bend: 0.85 of the reach
  for (const dvec2& point : bezier(from + (before - reach) * from_direction, from_direction,
                                   to - (after - reach) * to_direction, to_direction, handle))
    if (glm::distance(point, line.back()) > 0.05) line.push_back(point);
  if (glm::distance(to, line.back()) < 0.05) line.pop_back();
  line.push_back(to);
  return line;
}

std::vector<dvec2> loop_line(const dvec2& from, const dvec2& to, const dvec2& out, double reach_m) {
  constexpr double swerve_m = 18.0, straight_m = 2.0;
  const dvec2 left(-out.y, out.x), begin = from + straight_m * out;
  const double ahead_m = glm::dot(from - to, out) + straight_m + swerve_m;
  const dvec2 back = to + ahead_m * out, top = back + reach_m * (out - left);
  const dvec2 side = top - reach_m * (out + left);
  std::vector<dvec2> line{from, from + 0.5 * straight_m * out};
  const auto add = [&](const std::vector<dvec2>& points) {
    line.insert(line.end(), points.begin(), points.end() - 1);
  };
  add(bezier(begin, out, side, out, 0.2 * glm::distance(begin, side)));
  add(bezier(side, out, top, left, 0.3 * reach_m));
  add(bezier(top, left, back, -out, 0.3 * reach_m));
  for (const double share : {0.0, 0.3, 0.6, 0.9}) line.push_back(glm::mix(back, to, share));
  line.push_back(to);
  return line;
}

}  // namespace greatx::scene
