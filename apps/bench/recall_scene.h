// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the recall is measured on: a scenario at tick 0 and a list of receivers in it.
#pragma once

#include <vector>

#include "core/vec.h"
#include "sim/scenario/scenario.h"
#include "sim/world/moment.h"
#include "sim/world/world.h"

namespace greatx::apps {

/// The scenario with every node at rest where it is at tick 0, so that its whole world is static; reflections
/// and walls alone are on. The first channel's transmitter loses its own mesh if it moved. Throws UserError
/// if there is no channel.
sim::Scenario frozen_for_recall(sim::Scenario scenario, uint32_t max_depth, uint32_t max_transmissions);

/// Of the first channel's transmitter, local coordinates.
dvec3 transmitter_position(const sim::Scenario& scenario, const sim::World& world, const sim::Moment& moment);

/// `count` positions in the world, a function of the scene and the seed: half of them 1.5 m above the lowest
/// ground below them, half between there and the top of the scene; none inside a closed solid. Throws
/// UserError if there is no room.
std::vector<dvec3> draw_receivers(const scene::Scene& scene, uint64_t seed, uint32_t count);

}  // namespace greatx::apps
