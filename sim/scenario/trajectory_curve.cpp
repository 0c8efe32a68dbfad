// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/trajectory_curve.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::sim {
namespace {

/// Describes a direction and its derivative by u, up to a common positive factor.
template <typename Vector>
struct Direction {
  Vector value, derivative;
};

/// A derivative below this part of the segment's size counts as zero.
constexpr double negligible = 1e-9;
/// Below this part the sign of a derivative is only rounding.
constexpr double noise = 1e-13;

/// Returns the direction of B'(u) from the first derivative that does not vanish (hard case 60). Near a zero
/// u0 of B', B'(u0 + e) / |e| = sign(e) B'' + |e| B''' / 2. If B' is above rounding, its sign along B'' gives
/// the side of u0. Otherwise the side is before u0 (e < 0), but after u0 at the start of the curve.
template <typename Vector>
std::optional<Direction<Vector>> direction_of(const Vector& first, const Vector& second, const Vector& third,
                                              double u, double size) {
  if (glm::length(first) > negligible * size) return Direction<Vector>{first, second};
  double side = u > 1e-12 ? -1.0 : 1.0;
  if (glm::length(first) > noise * size && glm::dot(first, second) != 0.0)
    side = glm::dot(first, second) > 0.0 ? 1.0 : -1.0;
  if (glm::length(second) > negligible * size) return Direction<Vector>{side * second, side * 0.5 * third};
  if (glm::length(third) > negligible * size) return Direction<Vector>{third, Vector(0.0)};
  return std::nullopt;
}

double size_of(const CurveSegment& segment) {
  return std::max(
      {glm::length(segment.edges[0]), glm::length(segment.edges[1]), glm::length(segment.edges[2])});
}

/// Returns the rotation vector (axis times angle, at most pi) from `from` to `to`, in the world frame.
dvec3 rotation_between(const dquat& from, const dquat& to) {
  dquat turn = to * glm::conjugate(from);
  if (turn.w < 0.0) turn = -turn;
  const dvec3 axis(turn.x, turn.y, turn.z);
  const double sine = glm::length(axis);
  return sine > 0.0 ? axis * (2.0 * std::atan2(sine, turn.w) / sine) : dvec3(0.0);
}

dquat rotation_by(const dvec3& rotation) {
  const double angle = glm::length(rotation);
  return angle > 0.0 ? glm::angleAxis(angle, rotation / angle) : dquat(1.0, 0.0, 0.0, 0.0);
}

}  // namespace

CurveSegment CurveSegment::bezier(double begin_s, double duration_s, const std::array<dvec3, 4>& points) {
  return {
      begin_s, duration_s, points[0], {points[1] - points[0], points[2] - points[1], points[3] - points[2]}};
}

CurveSegment CurveSegment::line(double begin_s, double duration_s, const dvec3& from, const dvec3& to) {
  const dvec3 third = (to - from) / 3.0;
  return {begin_s, duration_s, from, {third, third, third}};
}

CurveSegment CurveSegment::hermite(double begin_s, double duration_s, const dvec3& from,
                                   const dvec3& from_velocity, const dvec3& to, const dvec3& to_velocity) {
  const dvec3 leaving = from_velocity * (duration_s / 3.0), arriving = to_velocity * (duration_s / 3.0);
  return {begin_s, duration_s, from, {leaving, (to - from) - leaving - arriving, arriving}};
}

dvec3 CurveSegment::position(double u) const {
  const double v = 1.0 - u;
  const dvec3 p1 = edges[0], p2 = p1 + edges[1], p3 = p2 + edges[2];  // from the origin
  return origin + (3.0 * u * v * v * p1 + 3.0 * u * u * v * p2 + u * u * u * p3);
}

dvec3 CurveSegment::first(double u) const {
  const double v = 1.0 - u;
  return 3.0 * (v * v * edges[0] + 2.0 * u * v * edges[1] + u * u * edges[2]);
}

dvec3 CurveSegment::second(double u) const {
  return 6.0 * ((1.0 - u) * (edges[1] - edges[0]) + u * (edges[2] - edges[1]));
}

dvec3 CurveSegment::third() const { return 6.0 * ((edges[2] - edges[1]) - (edges[1] - edges[0])); }

CurveCourse::CurveCourse(std::vector<CurveSegment> segments, std::vector<dquat> attitudes, Beyond beyond)
    : segments_(std::move(segments)), attitudes_(std::move(attitudes)), beyond_(beyond) {
  GREATX_CHECK(!segments_.empty() && (attitudes_.empty() || attitudes_.size() == segments_.size() + 1),
               "{} segments, {} attitudes", segments_.size(), attitudes_.size());
  static_ =
      std::all_of(segments_.begin(), segments_.end(),
                  [](const CurveSegment& s) { return size_of(s) == 0.0; }) &&
      std::all_of(attitudes_.begin(), attitudes_.end(), [&](const dquat& q) { return q == attitudes_[0]; });
  find_held_headings();
}

double CurveCourse::most_speed() const {
  double most = 0.0;
  // dB/du is a convex combination of three times the edges.
  for (const CurveSegment& segment : segments_)
    if (segment.duration_s > 0.0) most = std::max(most, 3.0 * size_of(segment) / segment.duration_s);
  return most;
}

double CurveCourse::length(size_t segment, double u) const {
  // Abramowitz and Stegun, table 25.4, n = 8.
  constexpr std::array abscissas{0.183434642495650, 0.525532409916329, 0.796666477413627, 0.960289856497536};
  constexpr std::array weights{0.362683783378362, 0.313706645877887, 0.222381034453374, 0.101228536290376};
  constexpr int parts = 4;
  const double half = 0.5 * u / parts;
  double sum = 0.0;
  for (int part = 0; part < parts; ++part)
    for (size_t i = 0; i < abscissas.size(); ++i)
      for (const double side : {-1.0, 1.0})
        sum += weights[i] *
               glm::length(segments_[segment].first(half * (2.0 * part + 1.0 + side * abscissas[i])));
  return half * sum;
}

double CurveCourse::length_before(double time_s) const {
  std::call_once(measured_, [&] {
    double sum = 0.0;
    for (size_t i = 0; i < segments_.size(); ++i) {
      begins_m_.push_back(sum);
      sum += length(i, 1.0);
    }
  });
  const auto after = std::upper_bound(segments_.begin() + 1, segments_.end(), time_s,
                                      [](double t, const CurveSegment& s) { return t < s.begin_s; });
  const size_t segment = static_cast<size_t>(after - segments_.begin()) - 1;
  const CurveSegment& curve = segments_[segment];
  const double h = curve.duration_s;
  return begins_m_[segment] + (h > 0.0 ? length(segment, (time_s - curve.begin_s) / h) : 0.0);
}

Travel CurveCourse::travel(double time_s) const {
  const Motion motion = at(time_s);
  Travel travel;
  travel.speed_mps = glm::length(motion.velocity);
  if (travel.speed_mps > 0.0)
    travel.acceleration_mps2 = glm::dot(motion.acceleration, motion.velocity) / travel.speed_mps;
  const double begin_s = segments_.front().begin_s,
               end_s = segments_.back().begin_s + segments_.back().duration_s;
  const auto way = [&](double t) {
    const double inside_s = std::clamp(t, begin_s, end_s);
    const double beyond_s = beyond_ == Beyond::straight ? t - inside_s : 0.0;
    return length_before(inside_s) + (beyond_s != 0.0 ? beyond_s * glm::length(at(inside_s).velocity) : 0.0);
  };
  travel.distance_m = way(time_s) - way(0.0);
  return travel;
}

CurveCourse::Heading CurveCourse::heading(size_t segment, double u) const {
  const CurveSegment& curve = segments_[segment];
  const double size = size_of(curve);
  const dvec3 first = curve.first(u), second = curve.second(u), third = curve.third();
  Heading result;
  const auto direction = direction_of(first, second, third, u, size);
  if (!direction) return result;
  const dvec3 v = direction->value, a = direction->derivative;
  const double horizontal = std::hypot(v.x, v.y);
  if (horizontal > negligible * glm::length(v)) {
    const double horizontal_rate = (v.x * a.x + v.y * a.y) / horizontal;
    result.yaw = std::atan2(v.y, v.x);
    result.pitch = -std::atan2(v.z, horizontal);
    result.yaw_rate = (v.x * a.y - v.y * a.x) / (horizontal * horizontal);
    result.pitch_rate = -(a.z * horizontal - v.z * horizontal_rate) / glm::dot(v, v);
    return result;
  }
  result.pitch = v.z > 0.0 ? -0.5 * pi : 0.5 * pi;
  // If the motion is vertical at an instant, the horizontal motion just before or after gives the yaw.
  if (const auto level = direction_of(dvec2(first), dvec2(second), dvec2(third), u, size))
    result.yaw = std::atan2(level->value.y, level->value.x);
  return result;
}

void CurveCourse::find_held_headings() {
  held_.resize(segments_.size());
  Heading before;
  for (size_t i = 0; i < segments_.size(); ++i) {
    held_[i] = before;
    const Heading end = heading(i, 1.0);
    if (end.yaw) before.yaw = end.yaw;
    if (end.pitch) before.pitch = end.pitch;
  }
  Heading after;
  for (size_t i = segments_.size(); i-- > 0;) {
    if (!held_[i].yaw) held_[i].yaw = after.yaw;
    if (!held_[i].pitch) held_[i].pitch = after.pitch;
    const Heading start = heading(i, 0.0);
    if (start.yaw) after.yaw = start.yaw;
    if (start.pitch) after.pitch = start.pitch;
  }
}

void CurveCourse::orient(size_t segment, double u, Motion& motion) const {
  const double duration_s = segments_[segment].duration_s;
  if (!attitudes_.empty()) {
    const dvec3 turn = rotation_between(attitudes_[segment], attitudes_[segment + 1]);
    motion.pose.orientation = glm::normalize(rotation_by(turn * u) * attitudes_[segment]);
    if (duration_s > 0.0) motion.angular_velocity = turn / duration_s;
    return;
  }
  Heading now = heading(segment, u);
  const bool starts_at_rest =
      u == 0.0 && glm::length(segments_[segment].first(0.0)) <= negligible * size_of(segments_[segment]);
  if (segment > 0 && starts_at_rest) now = Heading{};  // a rest at a knot keeps the direction of arrival
  const double yaw = now.yaw ? *now.yaw : held_[segment].yaw.value_or(0.0);
  const double pitch = now.pitch ? *now.pitch : held_[segment].pitch.value_or(0.0);
  motion.pose.orientation = orientation_from_yaw_pitch_roll(yaw, pitch, 0.0);
  if (duration_s > 0.0 && now.yaw) {
    const dvec3 left(-std::sin(yaw), std::cos(yaw), 0.0);
    motion.angular_velocity = (dvec3(0.0, 0.0, now.yaw_rate) + now.pitch_rate * left) / duration_s;
  }
}

Motion CurveCourse::inside(size_t segment, double time_s) const {
  const CurveSegment& curve = segments_[segment];
  const double h = curve.duration_s;
  const double u = h > 0.0 ? std::clamp((time_s - curve.begin_s) / h, 0.0, 1.0) : 0.0;
  Motion motion;
  motion.pose.position = curve.position(u);
  if (h > 0.0) {
    motion.velocity = curve.first(u) / h;
    motion.acceleration = curve.second(u) / (h * h);
  }
  orient(segment, u, motion);
  return motion;
}

Motion CurveCourse::at(double time_s) const {
  GREATX_CHECK(std::isfinite(time_s), "time {} s", time_s);
  const CurveSegment& last = segments_.back();
  const double begin_s = segments_.front().begin_s, end_s = last.begin_s + last.duration_s;
  if (time_s >= begin_s && time_s <= end_s) {
    const auto after = std::upper_bound(segments_.begin(), segments_.end(), time_s,
                                        [](double t, const CurveSegment& s) { return t < s.begin_s; });
    return inside(static_cast<size_t>(after - segments_.begin()) - 1, time_s);
  }
  const double end = time_s < begin_s ? begin_s : end_s;
  Motion motion = inside(time_s < begin_s ? 0 : segments_.size() - 1, end);
  motion.acceleration = motion.angular_velocity = dvec3(0.0);
  if (beyond_ == Beyond::hold) motion.velocity = dvec3(0.0);
  motion.pose.position += motion.velocity * (time_s - end);
  return motion;
}

}  // namespace greatx::sim
