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

/// Collects the materials and textures of models into a scene, equal ones once. Several placements of a model
/// share them, and so do several models that use the same picture.
class MaterialMerger {
 public:
  explicit MaterialMerger(Scene& scene) : scene_(scene) {}

  /// Returns, for each of the model's materials, its index in the scene. The reference is valid until the
  /// next call. Throws UserError if the scene's textures exceed budget::scene_textures.
  const std::vector<uint32_t>& indices_of(const Model& model);

 private:
  Scene& scene_;
  std::map<const Model*, std::vector<uint32_t>> done_;
  /// Indices of the scene's textures and materials by a hash of their content.
  std::unordered_multimap<size_t, uint32_t> textures_, materials_;
  Spending memory_{budget::scene_textures};
};

}  // namespace greatx::scene
