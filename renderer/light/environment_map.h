// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The sky as a picture: octahedral, square, z up (Z. Cigolle et al., "A Survey of Efficient Representations for
// Independent Unit Vectors", JCGT 3(2), 2014).
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "renderer/light/sky.h"

namespace greatx::render {

/// u, v in [0, 1] and unit directions, as light.glsl's octahedral_uv.
dvec3 octahedral_direction(double u, double v);
dvec2 octahedral_uv(const dvec3& direction);

/// Octahedral environment map, RGBA half floats, one vector a mip level. Texels hold radiance / scale.
struct EnvironmentMap {
  double scale = 1.0;
  std::vector<std::vector<uint16_t>> levels;
};
EnvironmentMap bake_environment(const Sky& sky, uint32_t size, uint32_t levels);

}  // namespace greatx::render
