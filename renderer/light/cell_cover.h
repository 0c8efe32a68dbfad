// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the columns of the surroundings that the triangles of the static world cover.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/vec.h"
#include "renderer/light/sky_view.h"
#include "renderer/light/wall_glow.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// A surface whose normal's z is below this is a wall.
inline constexpr double wall_slope = 0.3;

/// Calls visit(cell, height) for the cells whose centres a level triangle covers, and visit(cell, strip) for
/// those along a steep one.
class CellCover {
 public:
  explicit CellCover(const HeightField& field) : field_(field) {}

  template <typename Visit>
  void level(const std::array<dvec3, 3>& p, const Visit& visit) const {
    const dvec2 ab = dvec2(p[1] - p[0]), ac = dvec2(p[2] - p[0]);
    const double area = ab.x * ac.y - ab.y * ac.x;
    if (std::abs(area) < 1e-9) return;
    const dvec2 low = cells_of(glm::min(p[0], glm::min(p[1], p[2]))),
                high = cells_of(glm::max(p[0], glm::max(p[1], p[2])));
    const auto first = [](double x) { return static_cast<int64_t>(std::max(std::ceil(x - 0.5), 0.0)); };
    const auto last = [](double x, uint32_t count) {
      return std::min(static_cast<int64_t>(std::floor(x - 0.5)), int64_t{count} - 1);
    };
    for (int64_t j = first(low.y); j <= last(high.y, field_.height); ++j)
      for (int64_t i = first(low.x); i <= last(high.x, field_.width); ++i) {
        const dvec2 q = field_.corner + field_.cell_m * (dvec2(double(i), double(j)) + 0.5) - dvec2(p[0]);
        const double v = (q.x * ac.y - q.y * ac.x) / area, w = (ab.x * q.y - ab.y * q.x) / area;
        if (v < 0.0 || w < 0.0 || v + w > 1.0) continue;
        const auto height =
            static_cast<float>(p[0].z + v * (p[1].z - p[0].z) + w * (p[2].z - p[0].z) - field_.floor);
        visit(static_cast<size_t>(j * field_.width + i), height);
      }
  }

  template <typename Visit>
  void steep(const std::array<dvec3, 3>& p, const dvec3& normal, const Visit& visit) const {
    const dvec2 along = glm::normalize(dvec2(-normal.y, normal.x));
    std::array<double, 3> s;
    for (int k = 0; k < 3; ++k) s[k] = glm::dot(dvec2(p[k] - p[0]), along);
    const double begin = std::min({s[0], s[1], s[2]}), end = std::max({s[0], s[1], s[2]});
    const int steps = 1 + static_cast<int>((end - begin) / (0.5 * field_.cell_m));
    for (int step = 0; step <= steps; ++step) {
      const double at = begin + (end - begin) * (std::clamp(double(step) / steps, 1e-6, 1.0 - 1e-6));
      SteepStrip strip{1e300, -1e300, {}, {}, (end - begin) / (steps + 1)};
      dvec2 place(0.0);
      for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        const double apart = s[next] - s[k];
        const double share = apart != 0.0 ? (at - s[k]) / apart : -1.0;
        if (share < 0.0 || share > 1.0) continue;
        const dvec3 point = glm::mix(p[k], p[next], share);
        const double height = point.z - field_.floor;
        dvec3 weights(0.0);
        weights[k] = 1.0 - share;
        weights[next] = share;
        if (height < strip.low) strip.low = height, strip.low_weights = weights, place = cells_of(point);
        if (height > strip.high) strip.high = height, strip.high_weights = weights;
      }
      if (strip.low > strip.high) continue;
      if (place.x < 0.0 || place.y < 0.0 || place.x >= field_.width || place.y >= field_.height) continue;
      visit(static_cast<size_t>(place.y) * field_.width + static_cast<size_t>(place.x), strip);
    }
  }

 private:
  dvec2 cells_of(const dvec3& p) const { return (dvec2(p) - field_.corner) / field_.cell_m; }
  const HeightField& field_;
};

/// Calls visit(corners, normal, material, place of the first index) for the static triangles.
template <typename Visit>
void over_static(const scene::Scene& scene, const Visit& visit) {
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    for (uint32_t k = 0; k < primitive.index_count; k += 3) {
      const uint32_t* corner = &scene.indices[primitive.first_index + k];
      const std::array<dvec3, 3> p{dvec3(scene.positions[corner[0]]), dvec3(scene.positions[corner[1]]),
                                   dvec3(scene.positions[corner[2]])};
      const dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
      const double length = glm::length(normal);
      if (length > 1e-9) visit(p, normal / length, primitive.material, primitive.first_index + k);
    }
  }
}

}  // namespace greatx::render
