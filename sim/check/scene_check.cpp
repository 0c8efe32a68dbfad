// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/check/scene_check.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace greatx::sim {
namespace {

constexpr std::array names{"+x", "-x", "+y", "-y", "up", "down"};
constexpr size_t up = 4;

/// Returns the area of the static surfaces that face each direction of `names`, m^2.
std::array<double, 6> facing_areas(const scene::Scene& scene) {
  constexpr double cos_25_degrees = 0.9063;
  std::array<double, 6> areas{};
  for (const scene::Facet& facet : scene.facets) {
    if (facet.body != 0) continue;
    for (uint32_t t = 0; t < facet.triangle_count; ++t) {
      const dvec3* c = scene.facet_triangles[facet.first_triangle + t].corners;
      const dvec3 cross = glm::cross(c[1] - c[0], c[2] - c[0]);
      const double twice = glm::length(cross);
      for (int axis = 0; axis < 3 && twice > 0.0; ++axis)
        if (std::abs(cross[axis]) > cos_25_degrees * twice)
          areas[static_cast<size_t>(2 * axis + (cross[axis] < 0.0 ? 1 : 0))] += 0.5 * twice;
    }
  }
  return areas;
}

}  // namespace

std::vector<Finding> check_scene(const scene::Scene& scene) {
  const std::array<double, 6> areas = facing_areas(scene);
  const size_t most = static_cast<size_t>(std::ranges::max_element(areas) - areas.begin());
  const dvec3 size = scene.bounds.size();
  const bool higher = most / 2 == 2 || size.z > size[static_cast<int>(most / 2)];
  if (most == up || areas[most] <= 2.0 * areas[up] || !higher) return {};
  return {{Severity::fault, "on_its_side", "scene",
           fmt::format("seems to lie on its side: {:.4g} m2 of its surfaces face {} and {:.4g} m2 face up; "
                       "`rotation_deg` of the scene's object turns it",
                       areas[most], names[most], areas[up])}};
}

}  // namespace greatx::sim
