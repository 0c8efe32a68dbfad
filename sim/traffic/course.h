// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The course of a member of the traffic, from the states of its simulation.
#pragma once

#include <memory>

#include "sim/scenario/trajectory.h"
#include "sim/traffic/simulation.h"

namespace greatx::sim {

/// Makes the course of a member: its point on the way, the middle of a rear axle, moves along the way without
/// side slip, and the node's origin is ahead of it. Place and heading come from the way's curve, and speed
/// and acceleration along it from the states: constant acceleration within a step. All derivatives are
/// exact. A person stays upright; a vehicle has the slope of its way.
std::unique_ptr<Course> make_traffic_course(std::shared_ptr<Simulation> simulation, uint32_t member);

}  // namespace greatx::sim
