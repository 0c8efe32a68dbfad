// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the course of one node from its trajectory, and draws what is random in it. make_node_courses()
// (trajectory.h) calls these in the order in which nodes depend on each other.
#pragma once

#include <memory>

#include "core/random.h"
#include "sim/scenario/trajectory.h"

namespace greatx::sim {

/// Holds the conditions on an end of a Bezier trajectory.
struct EndLimits {
  const NodeConfig& node;
  const BezierTrajectory& trajectory;
  const Course* reference;  ///< nullptr: only the box
};

std::unique_ptr<Course> make_course(const StaticTrajectory& trajectory);
std::unique_ptr<Course> make_course(const WayPointTrajectory& trajectory);
std::unique_ptr<Course> make_course(const TrackTrajectory& track);
/// `carrier` outlives the course.
std::unique_ptr<Course> make_course(const FollowTrajectory& follow, const Course& carrier);
/// Draws a Bezier curve of `duration_s`, unless its control points are given. Throws UserError if no end
/// within the limits is found.
std::unique_ptr<Course> make_course(const EndLimits& limits, double duration_s, RandomStream& random);
std::unique_ptr<Course> make_course(const CorridorTrajectory& corridor, double duration_s,
                                    RandomStream& random);

}  // namespace greatx::sim
