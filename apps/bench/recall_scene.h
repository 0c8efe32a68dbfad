// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Prepares the measurement of the recall: a scenario frozen at tick 0 and a list of receivers in it.
#pragma once

#include <vector>

#include "core/vec.h"
#include "sim/scenario/scenario.h"
#include "sim/world/moment.h"
#include "sim/world/world.h"

namespace greatx::apps {

/// Describes the paths of a measurement.
struct RecallPaths {
  uint32_t max_depth = 3;          ///< largest number of interactions of a path
  uint32_t max_transmissions = 0;  ///< largest number of transmissions of a path
  uint32_t edges = 0;              ///< largest number of diffractions of a path, at most 2
  /// Largest number of bends of scattered paths, at most 2; 0: nothing scatters. Those with one bend are held
  /// against those of all patches, and those with two against the mean of many draws.
  uint32_t scattering = 0;
};

/// Returns the scenario with every node at rest at its pose of tick 0, so that the whole world is static. It
/// keeps the first channel only. Reflection is on, transmission is on if walls may be passed, diffraction is
/// on if edges are asked for, scattering is on if it is asked for, and moving reflectors are off. If the node
/// of the channel's first transmitter moved, the node loses its mesh. Throws UserError if there is no
/// channel.
sim::Scenario frozen_for_recall(sim::Scenario scenario, const RecallPaths& paths);

/// Returns the position of the first transmitter of the first channel, local coordinates.
dvec3 transmitter_position(const sim::Scenario& scenario, const sim::World& world, const sim::Moment& moment);

/// Returns `count` positions in world coordinates, which depend only on the scene and the seed. Half of them
/// are 1.5 m above the lowest ground below them, and half are between that height and the top of the scene.
/// None is inside a closed solid. Throws UserError if no place is found.
std::vector<dvec3> draw_receivers(const scene::Scene& scene, uint64_t seed, uint32_t count);

}  // namespace greatx::apps
