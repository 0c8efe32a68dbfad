// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "sim/scenario/clock.h"
#include "sim/scenario/trajectory.h"
#include "sim/world/part_turns.h"
#include "sim/world/tick_context.h"
#include "sim/world/world.h"

namespace greatx::sim {

/// Describes the motion of everything in one sequence.
struct Courses {
  std::vector<std::unique_ptr<Course>> nodes;
  std::vector<uint32_t> draws;  ///< [nodes] as in NodeCourses
  std::vector<PartTurn> turns;  ///< [World::parts]
};

/// Makes the courses. Starts of parts that the scenario does not give are drawn from (seed, the part's name,
/// sequence), and those of limbs from (seed, the node's name, sequence). Throws like make_node_courses.
Courses make_courses(const Scenario& scenario, const World& world, uint32_t sequence);

/// Returns the motion of `body`: its pose is in local coordinates, and body 0 stands still. For a part it
/// follows from its carrier's motion and its turn: the angular velocity is W + R a w, and the velocity of its
/// origin is V + W x (R p). The acceleration leaves out that of the carrier's turning.
Motion body_motion(const World& world, const Courses& courses, uint32_t body, double time_s);

/// Returns the poses of all bodies: local coordinates, index = body, [0] the identity.
std::vector<Pose> body_poses(const World& world, const Courses& courses, double time_s);

/// Holds the places of everything at a tick. It owns the data to which the context points, also after it is
/// moved.
struct Moment {
  Moment() = default;
  Moment(Moment&&) = default;
  Moment& operator=(Moment&&) = default;

  std::vector<Motion> motions;  ///< [nodes]
  std::vector<Pose> bodies;     ///< [bodies] local coordinates
  TickContext context;
};

/// Returns the moment of `tick` on these courses; world and courses outlive it. `previous` is the previous
/// tick at which something was due; -1: none.
Moment moment_at(const World& world, const Courses& courses, const Clock& clock, int64_t tick,
                 int64_t previous = -1);

}  // namespace greatx::sim
