// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

#include "core/budget.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// Collects the models' materials and textures into a scene, equal ones once: several placements of a model
/// share them, and so do several models that use the same picture.
class MaterialMerger {
 public:
  explicit MaterialMerger(Scene& scene) : scene_(scene) {}

  /// For each of the model's materials, its index in the scene. The reference holds until the next call.
  /// Throws UserError if the scene's textures come to more than budget::scene_textures.
  const std::vector<uint32_t>& indices_of(const Model& model);

 private:
  Scene& scene_;
  std::map<const Model*, std::vector<uint32_t>> done_;
  std::unordered_multimap<size_t, uint32_t> textures_, materials_;  ///< those of the scene
  Spending memory_{budget::scene_textures};
};

}  // namespace greatx::scene
