// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses nodes[].trajectory.
#include <algorithm>

#include "sim/scenario/parse/scenario_parse.h"
#include "sim/scenario/parse/trajectory_csv.h"

namespace greatx::sim {
namespace {

StaticTrajectory parse_static(const Field& field) {
  const FieldMap map(field, {"type", "position_m", "rotation_deg"});
  StaticTrajectory trajectory;
  trajectory.position_m = position_of(map.require("position_m", "a list of 3 numbers"));
  if (const auto f = map.find("rotation_deg")) trajectory.rotation = angles_of(*f);
  return trajectory;
}

std::vector<WayPoint> parse_points(const Field& field) {
  std::vector<WayPoint> points;
  for (const Field& item : field.list("way-points", 1)) {
    const FieldMap map(item, {"t_s", "position_m", "rotation_deg"});
    const Field time = map.require("t_s", "a time in seconds");
    WayPoint point;
    point.time_s = time.number(most_time_s);
    if (!points.empty() && !(point.time_s > points.back().time_s))
      time.fail(fmt::format("a time greater than the one before, {}", points.back().time_s));
    point.position_m = position_of(map.require("position_m", "a list of 3 numbers"));
    if (const auto f = map.find("rotation_deg")) {
      const dvec3 angles = angles_of(*f);
      point.orientation = orientation_from_yaw_pitch_roll(angles.x, angles.y, angles.z);
    }
    if (!points.empty() && point.orientation.has_value() != points.front().orientation.has_value())
      item.fail("rotation_deg on every way-point or on none",
                point.orientation ? "the first one with it" : "one without it");
    points.push_back(point);
  }
  return points;
}

WayPointTrajectory parse_way_point_trajectory(const Field& field) {
  const FieldMap map(field, {"type", "points", "csv", "interpolation"});
  WayPointTrajectory trajectory;
  map.exclude("points", "csv");
  if (const auto f = map.find("csv"))
    trajectory.points = load_way_points(f->file());
  else
    trajectory.points = parse_points(map.require("points", "a list of way-points (or 'csv')"));
  if (const auto f = map.find("interpolation")) trajectory.smooth = f->choice({"smooth", "linear"}) == 0;
  return trajectory;
}

void parse_distance(const Field& field, size_t node, BezierTrajectory& trajectory,
                    std::vector<NodeReference>& references) {
  const FieldMap map(field, {"node", "min_m", "max_m"});
  const Field reference = map.require("node", "a node's name");
  trajectory.reference_node = reference.text();
  references.push_back({node, reference});
  if (const auto f = map.find("min_m")) trajectory.min_distance_m = f->non_negative(1e9);
  if (const auto f = map.find("max_m")) {
    trajectory.max_distance_m = f->non_negative(1e9);
    if (trajectory.max_distance_m < trajectory.min_distance_m)
      f->fail(fmt::format("a number of at least min_m, {}", trajectory.min_distance_m));
  }
}

BezierTrajectory parse_bezier(const Field& field, size_t node, std::vector<NodeReference>& references) {
  const FieldMap map(field, {"type", "box", "distance", "offset_m", "clearance_m", "control_points_m"});
  BezierTrajectory trajectory;
  if (const auto control = map.find("control_points_m")) {
    for (const char* drawn : {"box", "distance", "offset_m", "clearance_m"})
      map.exclude("control_points_m", drawn);
    const std::vector<Field> points = control->list("control points");
    if (points.size() != 4) control->fail("a list of 4 control points");
    trajectory.control_points = {position_of(points[0]), position_of(points[1]), position_of(points[2]),
                                 position_of(points[3])};
    return trajectory;
  }
  const FieldMap box(map.require("box", "a box (or 'control_points_m')"), {"min_m", "max_m"});
  trajectory.min_m = position_of(box.require("min_m", "a list of 3 numbers"));
  const Field upper = box.require("max_m", "a list of 3 numbers");
  trajectory.max_m = position_of(upper);
  for (int axis = 0; axis < 3; ++axis)
    if (trajectory.max_m[axis] < trajectory.min_m[axis])
      upper.fail("a corner not below min_m", fmt::format("{} < {} on axis {}", trajectory.max_m[axis],
                                                         trajectory.min_m[axis], "xyz"[axis]));
  if (const auto f = map.find("distance")) parse_distance(*f, node, trajectory, references);
  if (const auto f = map.find("offset_m")) {
    trajectory.offset_m = position_of(*f);
    if (glm::any(glm::lessThan(trajectory.offset_m, dvec3(0.0))))
      f->fail("3 numbers of at least 0", fmt::format("[{}, {}, {}]", trajectory.offset_m.x,
                                                     trajectory.offset_m.y, trajectory.offset_m.z));
  }
  if (const auto f = map.find("clearance_m")) trajectory.clearance_m = f->non_negative(most_position_m);
  return trajectory;
}

CorridorTrajectory parse_corridor(const Field& field) {
  const FieldMap map(field, {"type", "center_line_m", "width_m", "height_m", "legs", "clearance_m"});
  CorridorTrajectory trajectory;
  for (const Field& item : map.require("center_line_m", "a list of points").list("points", 2)) {
    const dvec3 point = position_of(item);
    if (!trajectory.center_line_m.empty() && point == trajectory.center_line_m.back())
      item.fail("a point other than the one before", "the same one");
    trajectory.center_line_m.push_back(point);
  }
  if (const auto f = map.find("width_m")) trajectory.width_m = f->non_negative(most_position_m);
  if (const auto f = map.find("height_m")) trajectory.height_m = f->non_negative(most_position_m);
  // A leg that spanned a bend of the centre line would leave the corridor, so each section has at least one
  // leg.
  const auto sections = static_cast<uint32_t>(trajectory.center_line_m.size() - 1);
  trajectory.legs = static_cast<int>(std::max(4u, sections));
  if (const auto f = map.find("legs")) trajectory.legs = static_cast<int>(f->integer32(sections, 1'000'000));
  if (const auto f = map.find("clearance_m")) trajectory.clearance_m = f->non_negative(most_position_m);
  return trajectory;
}

}  // namespace

Trajectory parse_trajectory(const Field& field, size_t node, std::vector<NodeReference>& references) {
  switch (kind_of(field, "type", {"static", "waypoints", "bezier", "corridor"})) {
    case 0:
      return parse_static(field);
    case 1:
      return parse_way_point_trajectory(field);
    case 2:
      return parse_bezier(field, node, references);
    default:
      return parse_corridor(field);
  }
}

}  // namespace greatx::sim
