// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "sim/world/world.h"

namespace greatx::sim {

/// Describes a box about an instance of the scene, however its parts are turned. Axes and origin are those of
/// the node that carries it, or of the world.
struct InstanceBox {
  std::optional<uint32_t> node;  ///< none: it never moves
  scene::Bounds box;             ///< metres
};

/// Returns [instances] boxes.
std::vector<InstanceBox> instance_boxes(const World& world);

}  // namespace greatx::sim
