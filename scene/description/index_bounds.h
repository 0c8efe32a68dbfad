// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scene/description/scene.h"

namespace greatx::scene {

/// Returns the bounds of the vertices of a range of Scene::indices, in the frame of their body.
inline Bounds bounds_of_indices(const Scene& scene, uint32_t first, uint32_t count) {
  Bounds bounds;
  for (uint32_t i = first; i < first + count; ++i) bounds.add(dvec3(scene.positions[scene.indices[i]]));
  return bounds;
}

}  // namespace greatx::scene
