// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/traffic/curve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"

namespace greatx::sim {
namespace {

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Returns the derivatives at the points of a spline with given derivatives at both ends (Thomas' algorithm).
std::vector<dvec3> spline_slopes(const std::vector<dvec3>& points, const std::vector<double>& chords,
                                 const dvec3& first, const dvec3& last) {
  const size_t n = points.size();
  std::vector<dvec3> slopes(n), right(n);
  std::vector<double> above(n, 0.0);
  slopes.front() = first;
  slopes.back() = last;
  right[0] = first;
  for (size_t i = 1; i + 1 < n; ++i) {
    const double before = 1.0 / chords[i - 1], after = 1.0 / chords[i];
    const dvec3 b =
        3.0 * ((points[i] - points[i - 1]) * before * before + (points[i + 1] - points[i]) * after * after);
    const double pivot = 2.0 * (before + after) - before * above[i - 1];
    above[i] = after / pivot;
    right[i] = (b - before * right[i - 1]) / pivot;
  }
  for (size_t i = n - 1; i-- > 1;) slopes[i] = right[i] - above[i] * slopes[i + 1];
  return slopes;
}

/// Gauss-Legendre, n = 5 (Abramowitz and Stegun, table 25.4), on [0, 1].
constexpr std::array gauss_places{0.0469100770306680, 0.2307653449471585, 0.5, 0.7692346550528415,
                                  0.9530899229693320};
constexpr std::array gauss_weights{0.1184634425280945, 0.2393143352496832, 0.2844444444444444,
                                   0.2393143352496832, 0.1184634425280945};

}  // namespace

Curve::Curve(const std::vector<dvec3>& points, std::optional<dvec2> start, std::optional<dvec2> end) {
  GREATX_CHECK(points.size() >= 2, "a curve through {} points", points.size());
  std::vector<double> chords;
  for (size_t i = 0; i + 1 < points.size(); ++i)
    chords.push_back(std::max(glm::distance(dvec2(points[i]), dvec2(points[i + 1])), 1e-9));
  const size_t last = points.size() - 1;
  dvec3 first_slope = (points[1] - points[0]) / chords[0];
  dvec3 last_slope = (points[last] - points[last - 1]) / chords[last - 1];
  if (points.size() > 2 && start) first_slope = dvec3(glm::normalize(*start), first_slope.z);
  if (points.size() > 2 && end) last_slope = dvec3(glm::normalize(*end), last_slope.z);
  const std::vector<dvec3> slopes = spline_slopes(points, chords, first_slope, last_slope);
  lengths_.push_back(0.0);
  for (size_t i = 0; i < last; ++i) {
    const double h = chords[i];
    const dvec3 step = (points[i + 1] - points[i]) / h;
    Segment segment{{points[i], slopes[i], (3.0 * step - 2.0 * slopes[i] - slopes[i + 1]) / h,
                     (slopes[i] + slopes[i + 1] - 2.0 * step) / (h * h)},
                    h};
    if (points.size() == 2) segment.c[2] = segment.c[3] = dvec3(0.0);
    segments_.push_back(segment);
    lengths_.push_back(lengths_.back() + length(i, h));
    level_ = level_ && points[i].z == points[i + 1].z && slopes[i].z == 0.0;
  }
  for (size_t i = 0; i < segments_.size() && !straight(); ++i)
    for (int k = 0; k <= 4; ++k)
      most_curvature_ =
          std::max(most_curvature_, std::abs(inside(i, 0.25 * k * segments_[i].chord).curvature));
}

double Curve::length(size_t index, double u) const {
  const Segment& segment = segments_[index];
  double sum = 0.0;
  for (size_t k = 0; k < gauss_places.size(); ++k) {
    const double w = u * gauss_places[k];
    sum += gauss_weights[k] *
           glm::length(dvec2(segment.c[1]) + w * (2.0 * dvec2(segment.c[2]) + 3.0 * w * dvec2(segment.c[3])));
  }
  return u * sum;
}

CurvePlace Curve::inside(size_t index, double u) const {
  const Segment& segment = segments_[index];
  const dvec3 p = segment.c[0] + u * (segment.c[1] + u * (segment.c[2] + u * segment.c[3]));
  const dvec3 d1 = segment.c[1] + u * (2.0 * segment.c[2] + 3.0 * u * segment.c[3]);
  const dvec3 d2 = 2.0 * segment.c[2] + 6.0 * u * segment.c[3], d3 = 6.0 * segment.c[3];
  const dvec2 a(d1), b(d2), c(d3);
  const double speed = glm::length(a), turn = cross(a, b), along = glm::dot(a, b);
  CurvePlace place;
  place.position = dvec2(p);
  place.tangent = a / speed;
  const double cubed = speed * speed * speed;
  place.curvature = turn / cubed;
  place.curvature_rate = (cross(a, c) * speed * speed - 3.0 * turn * along) / (cubed * cubed);
  place.height = p.z;
  place.slope = d1.z / speed;
  place.slope_rate = (d2.z - d1.z * along / (speed * speed)) / (speed * speed);
  return place;
}

CurvePlace Curve::at(double s) const {
  const double inside_s = std::clamp(s, 0.0, length());
  const auto after = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, inside_s);
  const size_t index = static_cast<size_t>(after - lengths_.begin()) - 1;
  const double asked = inside_s - lengths_[index];
  const Segment& segment = segments_[index];
  double u = asked * segment.chord / std::max(lengths_[index + 1] - lengths_[index], 1e-12);
  for (int i = 0; i < 8 && !straight(); ++i) {
    const double speed =
        glm::length(dvec2(segment.c[1]) + u * (2.0 * dvec2(segment.c[2]) + 3.0 * u * dvec2(segment.c[3])));
    const double step = (length(index, u) - asked) / speed;
    u -= step;
    if (std::abs(step) < 1e-13) break;
  }
  CurvePlace place = inside(index, u);
  if (const double beyond = s - inside_s; beyond != 0.0) {
    place.position += beyond * place.tangent;
    place.height += beyond * place.slope;
    place.curvature = place.curvature_rate = place.slope_rate = 0.0;
  }
  return place;
}

std::vector<dvec3> rounded_ring(const std::vector<dvec3>& corners, double step_m) {
  std::vector<dvec3> ring = corners;
  for (int round = 0; round < 3; ++round) {
    std::vector<dvec3> cut;
    for (size_t i = 0; i < ring.size(); ++i) {
      const dvec3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      // A long edge loses no more than two metres at each end.
      const double share = std::min(0.25, 2.0 / glm::distance(a, b));
      cut.push_back(glm::mix(a, b, share));
      cut.push_back(glm::mix(a, b, 1.0 - share));
    }
    ring = std::move(cut);
  }
  size_t longest = 0;
  const auto edge = [&](size_t i) { return glm::distance(ring[i], ring[(i + 1) % ring.size()]); };
  for (size_t i = 1; i < ring.size(); ++i)
    if (edge(i) > edge(longest)) longest = i;
  const dvec3 start = 0.5 * (ring[longest] + ring[(longest + 1) % ring.size()]);
  std::vector<dvec3> corners_from_start{start};
  for (size_t i = 1; i <= ring.size(); ++i) corners_from_start.push_back(ring[(longest + i) % ring.size()]);
  corners_from_start.push_back(start);
  double total = 0.0;
  for (size_t i = 0; i + 1 < corners_from_start.size(); ++i)
    total += glm::distance(corners_from_start[i], corners_from_start[i + 1]);
  // Points at equal distances along the ring.
  const auto count = static_cast<size_t>(std::ceil(total / step_m));
  std::vector<dvec3> points{start};
  double passed = 0.0;
  size_t at = 0;
  for (size_t k = 1; k < count; ++k) {
    const double asked = total * static_cast<double>(k) / static_cast<double>(count);
    for (;;) {
      const double length = glm::distance(corners_from_start[at], corners_from_start[at + 1]);
      if (passed + length >= asked || at + 2 == corners_from_start.size()) {
        points.push_back(
            glm::mix(corners_from_start[at], corners_from_start[at + 1], (asked - passed) / length));
        break;
      }
      passed += length;
      ++at;
    }
  }
  points.push_back(start);
  return points;
}

std::vector<dvec3> shifted(const std::vector<dvec3>& points, double left_m, bool closed) {
  const size_t n = points.size();
  std::vector<dvec3> moved;
  for (size_t i = 0; i < n; ++i) {
    const dvec3& before = i > 0 ? points[i - 1] : closed ? points[n - 2] : points[0];
    const dvec3& after = i + 1 < n ? points[i + 1] : closed ? points[1] : points[n - 1];
    const dvec2 direction = glm::normalize(dvec2(after) - dvec2(before));
    moved.push_back(points[i] + left_m * dvec3(-direction.y, direction.x, 0.0));
  }
  return moved;
}

}  // namespace greatx::sim
