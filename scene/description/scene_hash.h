// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scene/description/scene.h"

namespace greatx::scene {

/// SHA-256 over origin, geometry, instances, bodies, facets, materials, textures and lights: everything that reaches a
/// sensor. Names of materials and textures, notes and the scene's own name do not count.
std::string hash_of(const Scene& scene);

}  // namespace greatx::scene
