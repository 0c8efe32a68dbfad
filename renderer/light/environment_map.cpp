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

/// The half vectors of GGX around a pole, which are the same for all texels of a level.
std::vector<dvec3> half_vectors(double roughness, uint32_t samples) {
  const double alpha = roughness * roughness;
  std::vector<dvec3> halves;
  for (uint32_t i = 0; i < samples; ++i) {
    const double u = (i + 0.5) / samples, phi = 2.0 * pi * radical_inverse(i);
    const double cos_half = std::sqrt((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u));
    const double sin_half = std::sqrt(std::max(0.0, 1.0 - cos_half * cos_half));
    halves.emplace_back(sin_half * std::cos(phi), sin_half * std::sin(phi), cos_half);
  }
  return halves;
}

/// Returns the radiance around `direction`, weighted as GGX reflects it when looked at head-on (Karis, "Real
/// Shading in Unreal Engine 4", 2013: n = v = r).
dvec3 blurred(const std::vector<dvec3>& base, uint32_t size, const dvec3& direction,
              const std::vector<dvec3>& halves) {
  const dvec3 up = std::abs(direction.z) < 0.99 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  const dvec3 x = glm::normalize(glm::cross(up, direction)), y = glm::cross(direction, x);
  dvec3 sum(0.0);
  double weights = 0.0;
  for (const dvec3& around_pole : halves) {
    const dvec3 half = x * around_pole.x + y * around_pole.y + direction * around_pole.z;
    const dvec3 light = 2.0 * around_pole.z * half - direction;
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
    const std::vector<dvec3> halves =
        level == 0 ? std::vector<dvec3>() : half_vectors(double(level) / (levels - 1), level == 1 ? 24 : 64);
    parallel_for(edge, 0, [&](size_t row) {
      for (uint32_t column = 0; column < edge; ++column) {
        const dvec3 direction = octahedral_direction((column + 0.5) / edge, (double(row) + 0.5) / edge);
        const size_t i = row * edge + column;
        const dvec3 value = level == 0 ? base[i] : blurred(base, size, direction, halves);
        for (int c = 0; c < 3; ++c)
          texels[4 * i + size_t(c)] = glm::packHalf1x16(float(std::min(value[c], 65504.0)));
        texels[4 * i + 3] = glm::packHalf1x16(1.0f);
      }
    });
    map.levels.push_back(std::move(texels));
  }
  return map;
}

}  // namespace greatx::render
