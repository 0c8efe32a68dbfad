// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/trajectory_bounds.h"

#include "sim/scenario/trajectory.h"

namespace greatx::sim {

namespace {

/// Smooth ways bulge: each of their segments lies in the hull of its four control points.
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

}  // namespace

void add_trajectory(const Trajectory& trajectory, scene::Bounds& bounds) {
  if (const auto* still = std::get_if<StaticTrajectory>(&trajectory)) bounds.add(still->position_m);
  if (const auto* way = std::get_if<WayPointTrajectory>(&trajectory)) add_way(*way, bounds);
  if (const auto* bezier = std::get_if<BezierTrajectory>(&trajectory)) {
    if (bezier->control_points)
      for (const dvec3& point : *bezier->control_points) bounds.add(point);
    else
      for (const double side : {-1.0, 1.0})
        bounds.add((side < 0 ? bezier->min_m : bezier->max_m) + side * glm::abs(bezier->offset_m));
  }
  if (const auto* corridor = std::get_if<CorridorTrajectory>(&trajectory)) {
    // Half the width and half the height to either side, whichever way the line goes.
    const dvec3 room(0.5 * (corridor->width_m + corridor->height_m));
    for (const dvec3& point : corridor->center_line_m) bounds.add(point - room), bounds.add(point + room);
  }
}

}  // namespace greatx::sim
