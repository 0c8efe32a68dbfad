// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the description of a run (`run` in dataset.json) says of its scene: names, and outlines of buildings.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/vec.h"
#include "io/dataset/record_source.h"

namespace greatx::io {

/// What the ids in records stand for, as the description of the run says. A run may say nothing.
struct SceneNames {
  struct Instance {
    std::string name, semantic_class;
    std::string node;  ///< that carries it; empty: it never moves
  };
  std::vector<Instance> instances;            ///< by id - 1
  std::vector<std::string> semantic_classes;  ///< by id
  std::vector<std::string> materials;         ///< by id - 1

  /// "12 parked car (vehicle)"; "12" without a name, "nothing" for 0.
  std::string instance(uint32_t id) const;
  /// The same in as few words as possible: the node's name of what a node carries, else the name.
  std::string short_instance(uint32_t id) const;
  bool moves(uint32_t id) const {
    return id > 0 && id <= instances.size() && !instances[id - 1].node.empty();
  }
  std::string semantic_class(uint32_t id) const;
  std::string material(uint32_t id) const;
};

/// A line of the outline of something tall that never moves, in the world, metres.
struct OutlineLine {
  dvec3 from{0.0}, to{0.0};
};
/// Returns the outlines of a run's buildings: where a level cuts their walls (`outline_m` of instances in
/// dataset.json), or the sides of their boxes in a data set that has none. Throws UserError like
/// scene_names().
std::vector<OutlineLine> scene_outlines(const RecordSource& records);

/// Throws UserError if the run's description is not as documented.
SceneNames scene_names(const RecordSource& records);

/// What pictures say of the scene.
struct SceneFacts {
  SceneNames names;
  std::vector<OutlineLine> outlines;
};
SceneFacts scene_facts(const RecordSource& records);

}  // namespace greatx::io
