// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scene/description/scene.h"

namespace greatx::scene {

/// Returns the SHA-256 over everything that reaches a sensor: origin, geometry, instances, bodies, facets,
/// materials, textures and lights, and the georeference if there is one. Names of materials and textures,
/// notes and the scene's own name do not count.
std::string hash_of(const Scene& scene);

}  // namespace greatx::scene
