// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/trajectory_makers.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "sim/scenario/trajectory_curve.h"

namespace greatx::sim {
std::vector<dvec3> way_point_velocities(const std::vector<WayPoint>& points) {
  const size_t last = points.size() - 1;
  std::vector<dvec3> slopes(last), velocities(points.size());
  std::vector<double> steps(last);
  for (size_t i = 0; i < last; ++i) {
    steps[i] = points[i + 1].time_s - points[i].time_s;
    slopes[i] = (points[i + 1].position_m - points[i].position_m) / steps[i];
  }
  velocities.front() = slopes.front();
  velocities.back() = slopes.back();
  if (last == 1) return velocities;
  for (size_t i = 1; i < last; ++i)
    velocities[i] = (slopes[i - 1] * steps[i] + slopes[i] * steps[i - 1]) / (steps[i - 1] + steps[i]);
  velocities.front() += (slopes[0] - slopes[1]) * (steps[0] / (steps[0] + steps[1]));
  velocities.back() +=
      (slopes[last - 1] - slopes[last - 2]) * (steps[last - 1] / (steps[last - 2] + steps[last - 1]));
  return velocities;
}

namespace {

constexpr int most_tries = 100'000;

class StaticCourse : public Course {
 public:
  explicit StaticCourse(const Pose& pose) { motion_.pose = pose; }
  Motion at(double) const override { return motion_; }
  bool is_static() const override { return true; }
  double most_speed() const override { return 0.0; }
  Travel travel(double) const override { return {}; }

 private:
  Motion motion_;
};

}  // namespace

std::unique_ptr<Course> make_course(const StaticTrajectory& trajectory) {
  const dvec3& turn = trajectory.rotation;
  return std::make_unique<StaticCourse>(
      Pose{trajectory.position_m, orientation_from_yaw_pitch_roll(turn.x, turn.y, turn.z)});
}

std::unique_ptr<Course> make_course(const WayPointTrajectory& trajectory) {
  const std::vector<WayPoint>& points = trajectory.points;
  GREATX_CHECK(!points.empty(), "a trajectory of no way-points");
  if (points.size() == 1)
    return std::make_unique<StaticCourse>(
        Pose{points[0].position_m, points[0].orientation.value_or(dquat(1.0, 0.0, 0.0, 0.0))});
  const std::vector<dvec3> velocities = way_point_velocities(points);
  std::vector<CurveSegment> segments;
  std::vector<dquat> attitudes;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const double begin_s = points[i].time_s, duration_s = points[i + 1].time_s - begin_s;
    const dvec3 &from = points[i].position_m, &to = points[i + 1].position_m;
    segments.push_back(trajectory.smooth ? CurveSegment::hermite(begin_s, duration_s, from, velocities[i], to,
                                                                 velocities[i + 1])
                                         : CurveSegment::line(begin_s, duration_s, from, to));
  }
  for (const WayPoint& point : points)
    if (point.orientation) attitudes.push_back(*point.orientation);
  return std::make_unique<CurveCourse>(std::move(segments), std::move(attitudes), Beyond::hold);
}

namespace {

[[noreturn]] void no_end(const EndLimits& limits, const dvec3& center, const std::string& found) {
  const BezierTrajectory& t = limits.trajectory;
  throw_user_error_at(
      limits.node.where,
      "node '{}': expected a point of the box [{}, {}, {}] .. [{}, {}, {}] m at {} .. {} m from '{}' "
      "at [{}, {}, {}] m, found {}",
      limits.node.name, t.min_m.x, t.min_m.y, t.min_m.z, t.max_m.x, t.max_m.y, t.max_m.z, t.min_distance_m,
      t.max_distance_m, t.reference_node, center.x, center.y, center.z, found);
}

dvec3 draw_end(const EndLimits& limits, double time_s, RandomStream& random) {
  const BezierTrajectory& t = limits.trajectory;
  const auto draw = [&] {
    const double x = random.uniform(t.min_m.x, t.max_m.x);
    const double y = random.uniform(t.min_m.y, t.max_m.y);
    return dvec3(x, y, random.uniform(t.min_m.z, t.max_m.z));
  };
  if (!limits.reference) return draw();
  const dvec3 center = limits.reference->at(time_s).pose.position;
  const double nearest = glm::distance(center, glm::clamp(center, t.min_m, t.max_m));
  const double farthest = glm::length(glm::max(glm::abs(center - t.min_m), glm::abs(center - t.max_m)));
  if (nearest > t.max_distance_m || farthest < t.min_distance_m)
    no_end(limits, center, fmt::format("distances of {:.6g} .. {:.6g} m only", nearest, farthest));
  for (int i = 0; i < most_tries; ++i) {
    const dvec3 point = draw();
    const double distance = glm::distance(point, center);
    if (distance >= t.min_distance_m && distance <= t.max_distance_m) return point;
  }
  no_end(limits, center, fmt::format("none in {} draws", most_tries));
}

}  // namespace

std::unique_ptr<Course> make_course(const EndLimits& limits, double duration_s, RandomStream& random) {
  const BezierTrajectory& t = limits.trajectory;
  std::array<dvec3, 4> points{};
  if (t.control_points) {
    points = *t.control_points;
  } else {
    points[0] = draw_end(limits, 0.0, random);
    points[3] = draw_end(limits, duration_s, random);
    for (const int middle : {1, 2}) {
      dvec3 offset{0.0};
      for (int axis = 0; axis < 3; ++axis) offset[axis] = random.uniform(-t.offset_m[axis], t.offset_m[axis]);
      points[middle] = points[0] + (points[3] - points[0]) * (middle / 3.0) + offset;
    }
  }
  return std::make_unique<CurveCourse>(std::vector{CurveSegment::bezier(0.0, duration_s, points)},
                                       std::vector<dquat>{}, Beyond::straight);
}

namespace {

/// Returns the number of legs of each section of the centre line. Each section has at least one leg. The
/// other legs go one by one to the section whose legs are longest.
std::vector<int> share_legs(const CorridorTrajectory& corridor) {
  const std::vector<dvec3>& line = corridor.center_line_m;
  std::vector<int> legs(line.size() - 1, 1);
  for (int rest = corridor.legs - static_cast<int>(legs.size()); rest > 0; --rest) {
    size_t longest = 0;
    const auto leg_length = [&](size_t i) { return glm::distance(line[i], line[i + 1]) / legs[i]; };
    for (size_t i = 1; i < legs.size(); ++i)
      if (leg_length(i) > leg_length(longest)) longest = i;
    ++legs[longest];
  }
  return legs;
}

/// Holds the axes of the cross-section perpendicular to `along`: across is horizontal (y for a vertical
/// line), and up is perpendicular to both.
struct CrossSection {
  dvec3 across, up;
  explicit CrossSection(const dvec3& along) {
    const bool vertical = std::hypot(along.x, along.y) < 1e-9;
    across = vertical ? dvec3(0, 1, 0) : glm::normalize(dvec3(-along.y, along.x, 0.0));
    up = glm::cross(along, across);
  }
};

/// Returns an offset from the centre line, uniform in the cross-section.
dvec3 draw_offset(const CrossSection& section, const CorridorTrajectory& corridor, RandomStream& random) {
  const double a = random.uniform(-0.5 * corridor.width_m, 0.5 * corridor.width_m);
  const double b = random.uniform(-0.5 * corridor.height_m, 0.5 * corridor.height_m);
  return a * section.across + b * section.up;
}

/// Returns the part of `offset` that stays inside the corridor along `section` (a bend in both planes leans
/// its cross-section).
double inside_part(const dvec3& offset, const CrossSection& section, const CorridorTrajectory& corridor) {
  const auto part = [](double value, double limit) {
    return std::abs(value) > limit ? limit / std::abs(value) : 1.0;
  };
  constexpr double rounding = 1e-12;
  return std::min(part(glm::dot(offset, section.across), 0.5 * corridor.width_m + rounding),
                  part(glm::dot(offset, section.up), 0.5 * corridor.height_m + rounding));
}

/// Draws the end points of the legs. At a bend the cross-section halves the angle, and the offset fits both
/// sections, so that no leg leaves the corridor.
std::vector<dvec3> draw_corridor(const CorridorTrajectory& corridor, RandomStream& random) {
  const std::vector<dvec3>& line = corridor.center_line_m;
  const std::vector<int> legs = share_legs(corridor);
  std::vector<dvec3> points;
  dvec3 before{0.0};
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    const dvec3 along = glm::normalize(line[i + 1] - line[i]);
    const CrossSection section(along);
    const dvec3 half = before + along;
    const bool turns_back = glm::length(half) < 1e-9;
    dvec3 offset = draw_offset(turns_back ? section : CrossSection(glm::normalize(half)), corridor, random);
    if (i > 0)
      offset *= std::min(inside_part(offset, section, corridor),
                         inside_part(offset, CrossSection(before), corridor));
    points.push_back(line[i] + offset);
    for (int k = 1; k < legs[i]; ++k)
      points.push_back(glm::mix(line[i], line[i + 1], double(k) / legs[i]) +
                       draw_offset(section, corridor, random));
    before = along;
  }
  points.push_back(line.back() + draw_offset(CrossSection(before), corridor, random));
  return points;
}

}  // namespace

std::unique_ptr<Course> make_course(const CorridorTrajectory& corridor, double duration_s,
                                    RandomStream& random) {
  const std::vector<dvec3> points = draw_corridor(corridor, random);
  double total = 0.0;
  for (size_t i = 0; i + 1 < points.size(); ++i) total += glm::distance(points[i], points[i + 1]);
  std::vector<CurveSegment> segments;
  double travelled = 0.0, begin_s = 0.0;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    travelled += glm::distance(points[i], points[i + 1]);
    const double end_s = i + 2 == points.size() ? duration_s : duration_s * (travelled / total);
    if (duration_s > 0.0 && !(end_s > begin_s)) continue;  // a leg of no length takes no time
    segments.push_back(CurveSegment::line(begin_s, end_s - begin_s, points[i], points[i + 1]));
    begin_s = end_s;
    if (duration_s == 0.0) break;  // one tick: at rest at the start
  }
  return std::make_unique<CurveCourse>(std::move(segments), std::vector<dquat>{}, Beyond::straight);
}

}  // namespace greatx::sim
