// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "scene/model.h"

namespace greatx::scene {

/// Collects the models' materials and textures into a scene, equal ones once: several placements of a model share
/// them, and so do several models that use the same picture.
class MaterialMerger {
 public:
  explicit MaterialMerger(Scene& scene) : scene_(scene) {}

  /// For each of the model's materials, its index in the scene. The reference holds until the next call.
  const std::vector<uint32_t>& indices_of(const Model& model);

 private:
  Scene& scene_;
  std::map<const Model*, std::vector<uint32_t>> done_;
};

}  // namespace greatx::scene
