// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the nodes of a model that turn on it.
#pragma once

#include <vector>

#include "scene/build/build.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

struct FoundPart {
  scene::PartPlacement placement;      ///< with a name that is unique among the node's parts
  const PartConfig* config = nullptr;  ///< the configuration in `node`, which outlives this
};

/// Returns the parts in the model's order. Throws UserError if the model has no node of a given name (the
/// message lists its nodes), if a node is named twice, or if one hangs on another.
std::vector<FoundPart> find_parts(const NodeConfig& node, const scene::Model& model);

}  // namespace greatx::sim
