// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/night_sky.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/gtc/packing.hpp>

#include "core/random.h"
#include "core/units.h"
#include "renderer/daylight/almanac.h"
#include "renderer/light/sky.h"
#include "renderer/surface/octahedral.h"

namespace greatx::render {

namespace {

constexpr double faintest = 6.0;
constexpr double log_counts[] = {0.301, 0.602, 1.176, 1.681, 2.233, 2.710, 3.205, 3.681};  // at -1, 0, ... 6
constexpr uint32_t star_stream = 0x57a125;

/// Returns the magnitude than which `count` stars are brighter.
double magnitude_of(double count) {
  const double log_count = std::log10(count);
  size_t i = 0;
  while (i + 2 < std::size(log_counts) && log_counts[i + 1] < log_count) ++i;
  return -1.0 + double(i) + (log_count - log_counts[i]) / (log_counts[i + 1] - log_counts[i]);
}

}  // namespace

double stars_brighter_than(double magnitude) {
  const double x = std::clamp(magnitude + 1.0, 0.0, faintest + 1.0);
  const size_t i = std::min(static_cast<size_t>(x), std::size(log_counts) - 2);
  return std::pow(10.0, std::lerp(log_counts[i], log_counts[i + 1], x - double(i)));
}

std::vector<Star> draw_stars(uint64_t seed) {
  constexpr uint32_t edge = shared::star_cells;
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<Star> cells(size_t(edge) * edge, {dvec3(0.0, 0.0, 1.0), none, 0.0});
  RandomStream random(seed, star_stream);
  const auto count = static_cast<uint32_t>(stars_brighter_than(faintest));
  for (uint32_t i = 0; i < count; ++i) {
    // The i-th brightest star has the magnitude than which i + 1/2 stars are brighter. Its place is uniform
    // on the sphere. Bright stars take their cells first. A faint one that falls on a taken cell is drawn
    // anew, which moves a fifth of them.
    for (bool placed = false; !placed;) {
      const double z = random.uniform(-1.0, 1.0), phi = random.uniform(-pi, pi),
                   level = std::sqrt(1.0 - z * z);
      const dvec3 direction(level * std::cos(phi), level * std::sin(phi), z);
      const dvec2 at = octahedral_uv(direction) * double(edge);
      Star& cell = cells[std::min(uint32_t(at.y), edge - 1) * edge + std::min(uint32_t(at.x), edge - 1)];
      if (cell.magnitude != none) continue;
      cell = {direction, magnitude_of(i + 0.5), random.uniform()};
      placed = true;
    }
  }
  return cells;
}

std::vector<shared::GpuStar> gpu_stars(const std::vector<Star>& stars, double haze_depth) {
  std::vector<shared::GpuStar> cells(stars.size(), shared::GpuStar{0, 0});
  for (size_t i = 0; i < stars.size(); ++i) {
    const double z = stars[i].direction.z;
    if (!std::isfinite(stars[i].magnitude) || z <= 0.0) continue;
    // The air mass is that of F. Kasten and A. Young, Applied Optics 28 (1989), eq. 3.
    const double h = degrees(std::asin(z)), mass = 1.0 / (z + 0.50572 * std::pow(h + 6.07995, -1.6364));
    const double lux = magnitude_0_lux * std::pow(10.0, -0.4 * (stars[i].magnitude + 0.19 * mass)) *
                       std::exp(-haze_depth * mass);
    const dvec2 at = glm::fract(octahedral_uv(stars[i].direction) * double(shared::star_cells));
    cells[i] = {glm::packUnorm2x16(vec2(at)),
                glm::packHalf2x16(vec2(float(lux * 1e6), float(stars[i].warmth)))};
  }
  return cells;
}

void describe_moon(shared::GpuLighting& block, const Lighting& lighting, const dvec3& lux_on_facing) {
  const dvec3& moon = lighting.moon_direction;
  block.moon_direction = vec3(moon);
  block.moon_radius = float(moon_radius);
  block.moon_cos_phase = float(std::cos(lighting.moon_phase_angle));
  // The bright limb looks towards the sun.
  const dvec3 across = lighting.sun_direction - moon * glm::dot(lighting.sun_direction, moon);
  const dvec3 other = std::abs(moon.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  block.moon_bright =
      vec3(glm::length(across) > 1e-6 ? glm::normalize(across) : glm::normalize(glm::cross(moon, other)));
  const double share = illuminated_share(lighting.moon_phase_angle);
  const bool seen = moon.z > -moon_radius && share > 1e-4;
  block.moon_disc = seen ? vec3(lux_on_facing / (pi * moon_radius * moon_radius * share)) : vec3(0.0f);
}

}  // namespace greatx::render
