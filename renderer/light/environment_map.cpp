// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/environment_map.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "core/parallel.h"
#include "core/units.h"
#include "renderer/surface/octahedral.h"

namespace greatx::render {

namespace {

double radical_inverse(uint32_t bits) {
  double value = 0.0, digit = 0.5;
  for (; bits != 0; bits >>= 1, digit *= 0.5)
    if (bits & 1u) value += digit;
  return value;
}

/// Returns the radiance around `direction`, weighted as GGX reflects it when looked at head-on (Karis, "Real
/// Shading in Unreal Engine 4", 2013: n = v = r).
dvec3 blurred(const std::vector<dvec3>& base, uint32_t size, const dvec3& direction, double roughness,
              uint32_t samples) {
  const double alpha = roughness * roughness;
  const dvec3 up = std::abs(direction.z) < 0.99 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  const dvec3 x = glm::normalize(glm::cross(up, direction)), y = glm::cross(direction, x);
  dvec3 sum(0.0);
  double weights = 0.0;
  for (uint32_t i = 0; i < samples; ++i) {
    const double u = (i + 0.5) / samples, phi = 2.0 * pi * radical_inverse(i);
    const double cos_half = std::sqrt((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u));
    const double sin_half = std::sqrt(std::max(0.0, 1.0 - cos_half * cos_half));
    const dvec3 half = x * (sin_half * std::cos(phi)) + y * (sin_half * std::sin(phi)) + direction * cos_half;
    const dvec3 light = 2.0 * cos_half * half - direction;
    const double weight = glm::dot(light, direction);
    if (weight <= 0.0) continue;
    const dvec2 uv = octahedral_uv(glm::normalize(light)) * double(size);
    const auto column = std::min(static_cast<uint32_t>(uv.x), size - 1);
    const auto row = std::min(static_cast<uint32_t>(uv.y), size - 1);
    sum += weight * base[row * size + column];
    weights += weight;
  }
  return sum / weights;
}

}  // namespace

EnvironmentMap bake_environment(const Sky& sky, uint32_t size, uint32_t levels) {
  EnvironmentMap map;
  map.scale = sky.illuminance() > 0.0 ? sky.illuminance() : 1.0;
  std::vector<dvec3> base(size_t(size) * size);
  parallel_for(size, 0, [&](size_t row) {
    for (uint32_t column = 0; column < size; ++column)
      base[row * size + column] =
          sky.radiance(octahedral_direction((column + 0.5) / size, (double(row) + 0.5) / size)) / map.scale;
  });
  for (uint32_t level = 0; level < levels; ++level) {
    const uint32_t edge = std::max(size >> level, 1u);
    std::vector<uint16_t> texels(size_t(edge) * edge * 4);
    parallel_for(size_t(edge) * edge, 0, [&](size_t i) {
      const dvec3 direction =
          octahedral_direction((double(i % edge) + 0.5) / edge, (double(i / edge) + 0.5) / edge);
      const dvec3 value =
          level == 0 ? base[i]
                     : blurred(base, size, direction, double(level) / (levels - 1), level == 1 ? 24 : 64);
      for (int c = 0; c < 3; ++c)
        texels[4 * i + size_t(c)] = glm::packHalf1x16(float(std::min(value[c], 65504.0)));
      texels[4 * i + 3] = glm::packHalf1x16(1.0f);
    });
    map.levels.push_back(std::move(texels));
  }
  return map;
}

}  // namespace greatx::render
