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
  scene::PartPlacement placement;  ///< with a name that is unique among the node's parts
  const PartConfig* config = nullptr;
};

/// Returns the parts that move by themselves: wheels, cranks and limbs of a generated vehicle or person in
/// the scenario's traffic, and those that the node lists.
std::vector<PartConfig> parts_of(const Scenario& scenario, const NodeConfig& node);

/// Returns the parts in the model's order. `configs` outlive the result. Throws UserError if the model has
/// no node of a given name (the message lists its nodes), or if a node is named twice. A part may hang on
/// another.
std::vector<FoundPart> find_parts(const NodeConfig& node, const std::vector<PartConfig>& configs,
                                  const scene::Model& model);

}  // namespace greatx::sim
