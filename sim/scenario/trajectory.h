// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "core/vec.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Represents a node's way through the world as a function of time. Pose, velocity and acceleration come
/// from the curve's derivatives.
class Course {
 public:
  virtual ~Course() = default;
  virtual Motion at(double time_s) const = 0;
  virtual bool is_static() const { return false; }
};

/// Returns the velocities of a smooth way at its points, m/s; there are at least two points. Each is the
/// derivative of the parabola through a point and its neighbours: Catmull-Rom for uneven times. At an end it
/// is the parabola through the three points there. The velocities are exact for constant acceleration.
std::vector<dvec3> way_point_velocities(const std::vector<WayPoint>& points);

/// Makes the courses of every node of one sequence; the index is the node. Random ones are drawn from (seed,
/// node's name, sequence), so other nodes change nothing. Bezier curves and corridors last from tick 0 to the
/// last tick, T = (curve_ticks - 1) / tick_rate, with u = t / T. Beyond that they go straight on. Way-points
/// have their own times and hold before and after. Throws UserError naming the node if the limits cannot be
/// met (e.g. if no point of the box is within d_min..d_max).
std::vector<std::unique_ptr<Course>> make_node_courses(const Scenario& scenario, uint32_t sequence);

}  // namespace greatx::sim
