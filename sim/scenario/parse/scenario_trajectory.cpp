// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses nodes[].trajectory.
#include <algorithm>

#include "sim/scenario/date_time.h"
#include "sim/scenario/parse/scenario_parse.h"
#include "sim/scenario/parse/trajectory_csv.h"
#include "sim/scenario/parse/trajectory_gpx.h"

namespace greatx::sim {
namespace {

/// Parses a list of positions in metres or on the Earth. `expected` says what is missing if it is.
std::vector<std::pair<Field, dvec3>> parse_positions(const FieldMap& map, const EarthPositions& earth,
                                                     const PositionKeys& keys, const std::string& expected,
                                                     size_t least) {
  map.exclude(keys.metres, keys.degrees);
  const auto places = map.find(keys.degrees);
  const Field list =
      places ? *places : map.require(keys.metres, fmt::format("{} (or '{}')", expected, keys.degrees));
  std::vector<std::pair<Field, dvec3>> positions;
  for (const Field& item : list.list("points", least))
    positions.emplace_back(item, places ? place_of(item, earth) : position_of(item));
  return positions;
}

StaticTrajectory parse_static(const Field& field, const EarthPositions& scene_earth) {
  const FieldMap map(field, {"type", "position_m", "position_deg", "heights", "rotation_deg"});
  StaticTrajectory trajectory;
  trajectory.position_m = require_position(map, with_heights_of(map, scene_earth));
  if (const auto f = map.find("rotation_deg")) trajectory.rotation = angles_of(*f);
  return trajectory;
}

std::vector<WayPoint> parse_points(const Field& field, const EarthPositions& earth) {
  std::vector<WayPoint> points;
  for (const Field& item : field.list("way-points", 1)) {
    const FieldMap map(item, {"t_s", "position_m", "position_deg", "rotation_deg"});
    const Field time = map.require("t_s", "a time in seconds");
    WayPoint point;
    point.time_s = time.number(most_time_s);
    if (!points.empty() && !(point.time_s > points.back().time_s))
      time.fail(fmt::format("a time greater than the one before, {}", points.back().time_s));
    point.position_m = require_position(map, earth);
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

/// Returns the instant that is t = 0 in a log whose times are dates.
std::optional<double> parse_start_time(const FieldMap& map) {
  const auto field = map.find("start_time");
  if (!field) return std::nullopt;
  if (!map.has("csv") && !map.has("gpx")) field->fail("a 'csv' or 'gpx' beside it", "none");
  const auto instant = parse_date_time(field->text());
  if (!instant) field->fail("a date and time with its offset such as 2026-06-21T12:00:00+02:00 (RFC 3339)");
  return instant;
}

WayPointTrajectory parse_way_point_trajectory(const Field& field, const EarthPositions& scene_earth) {
  const FieldMap map(field, {"type", "points", "csv", "gpx", "start_time", "heights", "interpolation"});
  const EarthPositions earth = with_heights_of(map, scene_earth);
  WayPointTrajectory trajectory;
  map.exclude("points", "csv");
  map.exclude("points", "gpx");
  map.exclude("csv", "gpx");
  const WayPointLog log{earth, parse_start_time(map)};
  if (const auto f = map.find("csv"))
    trajectory.points = load_way_points(f->file(), log);
  else if (const auto gpx = map.find("gpx"))
    trajectory.points = load_gpx(gpx->file(), log);
  else
    trajectory.points =
        parse_points(map.require("points", "a list of way-points (or 'csv' or 'gpx')"), earth);
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

/// Parses the four control points if they are there.
bool parse_control_points(const FieldMap& map, const EarthPositions& earth, BezierTrajectory& trajectory) {
  const PositionKeys keys{"control_points_m", "control_points_deg"};
  const auto list = map.has(keys.degrees) ? map.find(keys.degrees) : map.find(keys.metres);
  if (!list) return false;
  for (const char* drawn : {"box", "distance", "offset_m", "clearance_m"}) {
    map.exclude(keys.metres, drawn);
    map.exclude(keys.degrees, drawn);
  }
  const auto points = parse_positions(map, earth, keys, "control points", 0);
  if (points.size() != 4) list->fail("a list of 4 control points");
  trajectory.control_points = {points[0].second, points[1].second, points[2].second, points[3].second};
  return true;
}

/// Parses the corners of the box, which are the least and the greatest x, y and z.
void parse_box(const Field& field, const EarthPositions& earth, BezierTrajectory& trajectory) {
  const FieldMap box(field, {"min_m", "max_m", "min_deg", "max_deg"});
  trajectory.min_m = require_position(box, earth, {"min_m", "min_deg"});
  trajectory.max_m = require_position(box, earth, {"max_m", "max_deg"});
  const Field upper = box.has("max_deg") ? *box.find("max_deg") : *box.find("max_m");
  for (int axis = 0; axis < 3; ++axis)
    if (trajectory.max_m[axis] < trajectory.min_m[axis])
      upper.fail("a corner not below min_m", fmt::format("{} < {} on axis {}", trajectory.max_m[axis],
                                                         trajectory.min_m[axis], "xyz"[axis]));
}

BezierTrajectory parse_bezier(const Field& field, size_t node, const EarthPositions& scene_earth,
                              std::vector<NodeReference>& references) {
  const FieldMap map(field, {"type", "box", "distance", "offset_m", "clearance_m", "control_points_m",
                             "control_points_deg", "heights"});
  const EarthPositions earth = with_heights_of(map, scene_earth);
  BezierTrajectory trajectory;
  if (parse_control_points(map, earth, trajectory)) return trajectory;
  parse_box(map.require("box", "a box (or 'control_points_m')"), earth, trajectory);
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

CorridorTrajectory parse_corridor(const Field& field, const EarthPositions& scene_earth) {
  const FieldMap map(field, {"type", "center_line_m", "center_line_deg", "heights", "width_m", "height_m",
                             "legs", "clearance_m"});
  CorridorTrajectory trajectory;
  for (const auto& [item, point] :
       parse_positions(map, with_heights_of(map, scene_earth), {"center_line_m", "center_line_deg"},
                       "a list of points", 2)) {
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

FollowTrajectory parse_follow(const Field& field, size_t node, std::vector<NodeReference>& references) {
  const FieldMap map(field, {"type", "node", "position_m", "rotation_deg"});
  FollowTrajectory trajectory;
  const Field reference = map.require("node", "the name of the node to follow");
  trajectory.node = reference.text();
  references.push_back({node, reference});
  if (const auto f = map.find("position_m")) trajectory.position_m = position_of(*f);
  if (const auto f = map.find("rotation_deg")) trajectory.rotation = angles_of(*f);
  return trajectory;
}

}  // namespace

Trajectory parse_trajectory(const Field& field, size_t node, const EarthPositions& earth,
                            std::vector<NodeReference>& references) {
  switch (kind_of(field, "type", {"static", "waypoints", "bezier", "corridor", "follow"})) {
    case 0:
      return parse_static(field, earth);
    case 1:
      return parse_way_point_trajectory(field, earth);
    case 2:
      return parse_bezier(field, node, earth, references);
    case 4:
      return parse_follow(field, node, references);
    default:
      return parse_corridor(field, earth);
  }
}

}  // namespace greatx::sim
