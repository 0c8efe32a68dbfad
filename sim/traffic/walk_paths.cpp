// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The paths of pedestrians: both sides of walking lines, and paths over crossings between their right sides.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/traffic/streets.h"

namespace greatx::sim {
namespace {

constexpr double ring_step_m = 0.5;
constexpr double bend_m = 0.9;        ///< of a path's turn off a walking line, along both of its legs
constexpr double wait_kerb_m = 0.55;  ///< of the middle of one who waits, from the kerb
constexpr double farthest_kerb_m = 8.0;
constexpr double kerb_ramp_m = 0.2;  ///< half of the length over which a foot goes down a kerb

double cross_of(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

/// A straight line over a crossing.
struct Across {
  dvec2 start{0.0}, forward{1.0, 0.0};
};

/// Returns where a ring meets the line nearest to a point before its start, or nothing.
std::optional<double> meeting(const Curve& ring, const Across& line, double reach_m) {
  std::optional<double> found;
  double nearest = reach_m;
  const auto side = [&](double s) { return cross_of(line.forward, ring.at(s).position - line.start); };
  const int steps = static_cast<int>(std::ceil(ring.length() / 0.5));
  double after = side(0.0);
  for (int i = 0; i < steps; ++i) {
    double low = ring.length() * i / steps, high = ring.length() * (i + 1) / steps;
    const double before = after;
    after = side(high);
    if ((before < 0.0) == (after < 0.0)) continue;
    for (int halving = 0; halving < 45; ++halving) {
      const double middle = 0.5 * (low + high);
      ((side(middle) < 0.0) == (before < 0.0) ? low : high) = middle;
    }
    const double distance = glm::distance(ring.at(low).position, line.start);
    if (distance < nearest) {
      nearest = distance;
      found = low;
    }
  }
  return found;
}

/// Adds a bend from a place with a direction to another one: a Bezier curve of degree five.
void add_bend(std::vector<dvec2>& line, const dvec2& from, const dvec2& from_direction, const dvec2& to,
              const dvec2& to_direction) {
  constexpr double handle = 0.3 * bend_m;
  const dvec2 a = from + handle * from_direction, b = a + handle * from_direction;
  const dvec2 d = to - handle * to_direction, c = d - handle * to_direction;
  constexpr int steps = 10;
  for (int i = 0; i <= steps; ++i) {
    const double u = static_cast<double>(i) / steps, v = 1.0 - u;
    line.push_back(v * v * v * v * v * from + 5.0 * u * v * v * v * v * a + 10.0 * u * u * v * v * v * b +
                   10.0 * u * u * u * v * v * c + 5.0 * u * u * u * u * v * d + u * u * u * u * u * to);
  }
}

double step_up(double x) {  // 0 below -kerb_ramp_m, 1 above it
  const double u = std::clamp(0.5 + 0.5 * x / kerb_ramp_m, 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

}  // namespace

void Streets::make_rings(const scene::StreetNetwork& network) {
  for (const scene::StreetWalk& walk : network.walks) {
    const std::vector<dvec3> middle = rounded_ring(walk.line, ring_step_m);
    const auto side = [&](double left_m, bool back) {
      std::vector<dvec3> points = shifted(middle, left_m, true);
      if (back) std::ranges::reverse(points);
      const dvec2 start = glm::normalize(dvec2(points[1]) - dvec2(points[points.size() - 2]));
      return Curve(points, start, start);
    };
    rings_.push_back({side(-walk_side_m, false), side(walk_side_m, true), {}, {}});
  }
}

void Streets::make_paths(const scene::StreetNetwork& network) {
  for (uint32_t c = 0; c < network.crossings.size(); ++c)
    for (const bool back : {false, true}) make_path(network.crossings[c], c, back);
}

void Streets::make_path(const scene::StreetCrossing& crossing, uint32_t index, bool back) {
  const dvec3 kerb_from = back ? crossing.to : crossing.from, kerb_to = back ? crossing.from : crossing.to;
  const uint32_t from = crossing.walks[back ? 1 : 0], to = crossing.walks[back ? 0 : 1];
  const double width = glm::distance(dvec2(kerb_from), dvec2(kerb_to));
  const dvec2 forward = (dvec2(kerb_to) - dvec2(kerb_from)) / width, right(forward.y, -forward.x);
  const double side = std::min(zebra_side_m, 0.5 * crossing.width_m - 0.4);
  const Across line{dvec2(kerb_from) + side * right, forward};
  const Across end{dvec2(kerb_to) + side * right, forward};
  const Curve &ring = rings_[from].right, &other = rings_[to].right;
  const auto leave = meeting(ring, line, farthest_kerb_m), join = meeting(other, end, farthest_kerb_m);
  const auto wrong = [&](const std::string& found) {
    throw_user_error(
        "{}: crossings[{}]: expected walking lines on both sides, with the carriageway on their "
        "right, within {} m of its kerbs, found {}",
        name_, index, farthest_kerb_m, found);
  };
  if (!leave || !join) wrong(fmt::format("none at '{}'", (!leave) == back ? "to" : "from"));
  const double leave_at = std::fmod(*leave - bend_m + ring.length(), ring.length());
  const double join_at = std::fmod(*join + bend_m, other.length());
  const CurvePlace start = ring.at(leave_at), finish = other.at(join_at);
  if (cross_of(start.tangent, forward) > -0.5 || cross_of(forward, finish.tangent) > -0.5)
    wrong("one with the carriageway on its left");
  std::vector<dvec2> flat;
  const dvec2 first = ring.at(*leave).position + bend_m * forward;
  const dvec2 last = other.at(*join).position - bend_m * forward;
  add_bend(flat, start.position, start.tangent, first, forward);
  const double straight = glm::distance(first, last);
  const int steps = std::max(2, static_cast<int>(straight / 0.2));
  for (int i = 1; i < steps; ++i) flat.push_back(glm::mix(first, last, static_cast<double>(i) / steps));
  add_bend(flat, last, forward, finish.position, finish.tangent);
  std::vector<dvec3> points;
  for (const dvec2& point : flat) {
    const double x = glm::dot(point - line.start, forward);
    // Down the kerb, over the carriageway, up the other kerb.
    const double near = 1.0 - step_up(x), far = step_up(x - width);
    const double road = glm::mix(kerb_from.z, kerb_to.z, std::clamp(x / width, 0.0, 1.0));
    points.emplace_back(point,
                        road + near * (start.height - kerb_from.z) + far * (finish.height - kerb_to.z));
  }
  CrossingPath path{
      Curve(points, start.tangent, finish.tangent), index, from, to, leave_at, join_at, 0, 0, 0};
  // Lengths on the path of places on its straight part.
  const double total = path.curve.length();
  const auto place_of = [&](double x) {
    double low = 0.0, high = total;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (glm::dot(path.curve.at(middle).position - line.start, forward) < x ? low : high) = middle;
    }
    return low;
  };
  path.wait_m = place_of(-wait_kerb_m);
  path.across_m = place_of(width + 0.3);
  path.merge_m = place_of(width + wait_kerb_m);
  const auto number = static_cast<uint32_t>(paths_.size());
  rings_[from].leaving.push_back(number);
  rings_[to].joining.push_back(number);
  paths_.push_back(std::move(path));
}

}  // namespace greatx::sim
