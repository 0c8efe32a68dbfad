// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Maps directions to places on a square (Z. Cigolle et al., "A Survey of Efficient Representations for
// Independent Unit Vectors", JCGT 3(2), 2014), z up. shaders/camera/octahedral.glsl does the same for
// shaders.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/vec.h"

namespace greatx::render {

/// Turns the corners of the square [-1, 1]^2, which hold the lower half, inside out.
template <typename T>
glm::vec<2, T> octahedral_fold(const glm::vec<2, T>& p) {
  return {(T(1) - std::abs(p.y)) * (p.x >= T(0) ? T(1) : T(-1)),
          (T(1) - std::abs(p.x)) * (p.y >= T(0) ? T(1) : T(-1))};
}

/// Returns the place in [-1, 1]^2 of a direction of any length but 0.
template <typename T>
glm::vec<2, T> octahedral_place(const glm::vec<3, T>& d) {
  const glm::vec<2, T> p = glm::vec<2, T>(d) / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  return d.z < T(0) ? octahedral_fold(p) : p;
}

/// These functions map u, v in [0, 1] and unit directions, as in the environment map and the map of stars.
inline dvec2 octahedral_uv(const dvec3& direction) { return octahedral_place(direction) * 0.5 + 0.5; }
inline dvec3 octahedral_direction(double u, double v) {
  const dvec2 p = 2.0 * dvec2(u, v) - 1.0;
  const double z = 1.0 - std::abs(p.x) - std::abs(p.y);
  return glm::normalize(dvec3(z < 0.0 ? octahedral_fold(p) : p, z));
}

/// Returns two signed 16-bit fractions of a direction of any length, right to 5e-5 rad. Zero stands for +z.
inline uint32_t octahedral_word(const vec3& direction) {
  const vec2 p = direction == vec3(0.0f) ? vec2(0.0f) : octahedral_place(direction);
  const auto fraction = [](float x) {
    return static_cast<uint32_t>(static_cast<uint16_t>(static_cast<int16_t>(std::lround(x * 32767.0f))));
  };
  return fraction(p.x) | fraction(p.y) << 16;
}

}  // namespace greatx::render
