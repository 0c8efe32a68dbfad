// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/trajectory_bounds.h"

#include <algorithm>

#include "sim/scenario/trajectory.h"

namespace greatx::sim {

namespace {

/// Adds a trajectory of way-points. Each segment of a smooth one lies in the convex hull of its four control
/// points.
void add_way(const WayPointTrajectory& way, scene::Bounds& bounds) {
  for (const WayPoint& point : way.points) bounds.add(point.position_m);
  if (!way.smooth || way.points.size() < 2) return;
  const std::vector<dvec3> velocities = way_point_velocities(way.points);
  for (size_t i = 0; i + 1 < way.points.size(); ++i) {
    const double third_s = (way.points[i + 1].time_s - way.points[i].time_s) / 3.0;
    bounds.add(way.points[i].position_m + third_s * velocities[i]);
    bounds.add(way.points[i + 1].position_m - third_s * velocities[i + 1]);
  }
}

/// Returns how long the run continues beyond the end of a curve, as a multiple of the curve's duration.
double overrun(const Scenario& scenario) {
  const double last = static_cast<double>(scenario.ticks - 1);
  const double end = static_cast<double>(scenario.curve_ticks() - 1);
  return end > 0.0 ? std::max(0.0, last / end - 1.0) : 0.0;  // a curve of one tick rests
}

/// Adds the box of the control points, whatever is drawn, and the straight continuation beyond the end, along
/// B'(1) = 3 (P3 - P2).
void add_curve(const BezierTrajectory& curve, double beyond, scene::Bounds& bounds) {
  scene::Bounds box;
  dvec3 last_edge;  // the upper bound of |P3 - P2| along each axis
  if (curve.control_points) {
    for (const dvec3& point : *curve.control_points) box.add(point);
    last_edge = glm::abs((*curve.control_points)[3] - (*curve.control_points)[2]);
  } else {
    for (const double side : {-1.0, 1.0})
      box.add((side < 0 ? curve.min_m : curve.max_m) + side * glm::abs(curve.offset_m));
    last_edge = (curve.max_m - curve.min_m) / 3.0 + glm::abs(curve.offset_m);
  }
  bounds.add(box.min - 3.0 * beyond * last_edge);
  bounds.add(box.max + 3.0 * beyond * last_edge);
}

/// Adds the centre line, widened by half the width and half the height in every direction, since a leg may
/// have any direction. Beyond its end the trajectory continues at its constant speed.
void add_corridor(const CorridorTrajectory& corridor, double beyond, scene::Bounds& bounds) {
  const double across = corridor.width_m + corridor.height_m;
  double longest = corridor.legs * across;  // if every leg crosses the corridor
  for (size_t i = 0; i + 1 < corridor.center_line_m.size(); ++i)
    longest += glm::distance(corridor.center_line_m[i], corridor.center_line_m[i + 1]);
  const dvec3 room(0.5 * across + beyond * longest);
  for (const dvec3& point : corridor.center_line_m) bounds.add(point - room), bounds.add(point + room);
}

}  // namespace

void add_trajectory(const Scenario& scenario, const Trajectory& trajectory, scene::Bounds& bounds) {
  if (const auto* still = std::get_if<StaticTrajectory>(&trajectory)) bounds.add(still->position_m);
  if (const auto* way = std::get_if<WayPointTrajectory>(&trajectory)) add_way(*way, bounds);
  if (const auto* bezier = std::get_if<BezierTrajectory>(&trajectory))
    add_curve(*bezier, overrun(scenario), bounds);
  if (const auto* corridor = std::get_if<CorridorTrajectory>(&trajectory))
    add_corridor(*corridor, overrun(scenario), bounds);
  // Streets lie within the scene's bounds, which every caller adds. While a track is absent, no path meets
  // it.
  if (const auto* track = std::get_if<TrackTrajectory>(&trajectory))
    for (const WayPointTrajectory& stretch : *track->stretches) add_way(stretch, bounds);
  if (const auto* follow = std::get_if<FollowTrajectory>(&trajectory))
    for (const NodeConfig& node : scenario.nodes)
      if (node.name == follow->node) {
        scene::Bounds carrier;
        add_trajectory(scenario, node.trajectory, carrier);
        const dvec3 room(glm::length(follow->position_m));
        constexpr double streets_m = 1e4;  // from the origin; where they lead is not known here
        if (carrier.empty()) carrier.add(dvec3(-streets_m)), carrier.add(dvec3(streets_m));
        bounds.add(carrier.min - room), bounds.add(carrier.max + room);
      }
}

}  // namespace greatx::sim
