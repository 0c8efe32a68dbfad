// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The scenario's models, loaded and put together: the scene that every sequence shares.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

struct World {
  scene::Scene scene;
  /// The body that follows each node; 0: the node has no mesh of its own, or never moves (then its mesh is part of the
  /// static world).
  std::vector<uint32_t> body_of_node;
  /// The node that carries each body; [0] means nothing, since body 0 stands still.
  std::vector<uint32_t> node_of_body;
};

/// Loads and generates every model of the scenario. Throws UserError naming file, mesh or material; radio materials
/// that are unknown at a channel's carrier are found here, not at the first tick.
World load_world(const Scenario& scenario);

/// How a body (not 0) moves when its node moves like `node` (world frame): pose in local coordinates.
Motion body_motion(const World& world, uint32_t body, const Motion& node);

/// The poses of all bodies when the nodes move like this: local coordinates, index = body, [0] the identity.
std::vector<Pose> body_poses(const World& world, const std::vector<Motion>& node_motions);

}  // namespace greatx::sim
