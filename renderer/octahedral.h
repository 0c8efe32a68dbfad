// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Directions in one word (Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT
// 3(2), 2014): 5e-5 rad. shaders/camera/octahedral.glsl reads them.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/vec.h"

namespace greatx::render {

/// Two signed 16-bit fractions of a direction of any length; zero stands for +z.
inline uint32_t octahedral_word(const vec3& direction) {
  const float norm = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
  vec2 p(0.0f);
  if (norm > 0.0f) {
    p = vec2(direction.x, direction.y) / norm;
    if (direction.z < 0.0f)
      p = (1.0f - glm::abs(vec2(p.y, p.x))) * vec2(p.x >= 0.0f ? 1.0f : -1.0f, p.y >= 0.0f ? 1.0f : -1.0f);
  }
  const auto fraction = [](float x) {
    return static_cast<uint32_t>(static_cast<uint16_t>(static_cast<int16_t>(std::lround(x * 32767.0f))));
  };
  return fraction(p.x) | fraction(p.y) << 16;
}

}  // namespace greatx::render
