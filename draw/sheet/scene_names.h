// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/dataset/record_source.h"

namespace greatx::io {

/// What the ids in records stand for, as the description of the run says. A run may say nothing.
struct SceneNames {
  struct Instance {
    std::string name, semantic_class;
  };
  std::vector<Instance> instances;            ///< by id - 1
  std::vector<std::string> semantic_classes;  ///< by id
  std::vector<std::string> materials;         ///< by id - 1

  /// "12 parked car (vehicle)"; "12" without a name, "nothing" for 0.
  std::string instance(uint32_t id) const;
  std::string semantic_class(uint32_t id) const;
  std::string material(uint32_t id) const;
};

/// Throws UserError if the run's description is not as documented.
SceneNames scene_names(const RecordSource& records);

}  // namespace greatx::io
