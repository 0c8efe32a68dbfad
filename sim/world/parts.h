// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of a model's nodes turn on it.
#pragma once

#include <vector>

#include "scene/build/build.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

struct FoundPart {
  scene::PartPlacement placement;      ///< with a name of its own among the node's parts
  const PartConfig* config = nullptr;  ///< of `node`, which outlives it
};

/// In the model's order. Throws UserError if a name is no node's of the model (it lists what there
/// is), a node is named twice, or one hangs on another.
std::vector<FoundPart> find_parts(const NodeConfig& node, const scene::Model& model);

}  // namespace greatx::sim
