// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/facets/foliage_volumes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/error.h"

namespace greatx::rf {

namespace {

constexpr double room_m = 0.1;  ///< a point this far outside a box still counts as inside
constexpr double max_cells = 1u << 20;

scene::Bounds grown(const scene::Bounds& bounds, double by) {
  return {bounds.min - dvec3(by), bounds.max + dvec3(by)};
}

bool overlap(const scene::Bounds& a, const scene::Bounds& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

/// Returns the boxes of the static facets of foliage.
std::vector<scene::Bounds> facet_boxes(const scene::Scene& scene, const FacetKinds& kinds) {
  std::vector<scene::Bounds> boxes;
  for (size_t i = 0; i < scene.facets.size(); ++i) {
    const scene::Facet& facet = scene.facets[i];
    if (facet.body != 0 || kinds[i] != FacetKind::foliage) continue;
    scene::Bounds box;
    for (uint32_t t = 0; t < facet.triangle_count; ++t)
      for (const dvec3& corner : scene.facet_triangles[facet.first_triangle + t].corners) box.add(corner);
    boxes.push_back(grown(box, 0.5 * FoliageVolumes::touch_m));
  }
  return boxes;
}

uint32_t root_of(std::vector<uint32_t>& parents, uint32_t i) {
  while (parents[i] != i) i = parents[i] = parents[parents[i]];
  return i;
}

/// Returns boxes around connected groups of boxes. A closed surface is connected, so that one box holds all
/// of its inside.
std::vector<scene::Bounds> joined(std::vector<scene::Bounds> boxes) {
  std::sort(boxes.begin(), boxes.end(), [](const scene::Bounds& a, const scene::Bounds& b) {
    return std::tie(a.min.x, a.min.y, a.min.z) < std::tie(b.min.x, b.min.y, b.min.z);
  });
  std::vector<uint32_t> parents(boxes.size());
  std::iota(parents.begin(), parents.end(), 0u);
  std::vector<uint32_t> active;  // boxes that the sweep along x has entered and not yet left
  for (uint32_t i = 0; i < boxes.size(); ++i) {
    std::erase_if(active, [&](uint32_t other) { return boxes[other].max.x < boxes[i].min.x; });
    for (const uint32_t other : active)
      if (overlap(boxes[i], boxes[other])) parents[root_of(parents, i)] = root_of(parents, other);
    active.push_back(i);
  }
  std::vector<scene::Bounds> whole(boxes.size());
  for (uint32_t i = 0; i < boxes.size(); ++i) whole[root_of(parents, i)].add(boxes[i]);
  std::erase_if(whole, [](const scene::Bounds& box) { return box.empty(); });
  return whole;
}

}  // namespace

FoliageVolumes::FoliageVolumes(const scene::Scene& scene, const FacetKinds& kinds) {
  GREATX_CHECK(kinds.size() == scene.facets.size(), "kinds of {} facets, the scene has {}", kinds.size(),
               scene.facets.size());
  boxes_ = joined(facet_boxes(scene, kinds));
  if (!boxes_.empty()) make_grid();
}

/// Marks the touched cells: adds +1 or -1 at the eight corners of each box, and then forms running sums along
/// each axis. One box around the whole city costs as little as a small one.
void FoliageVolumes::make_grid() {
  scene::Bounds all;
  for (const scene::Bounds& box : boxes_) all.add(grown(box, room_m));
  corner_ = all.min;
  const dvec3 size = all.size();
  cell_m_ = std::max(
      {0.25, std::cbrt(size.x * size.y * size.z / max_cells), std::max({size.x, size.y, size.z}) / 4096.0});
  for (int axis = 0; axis < 3; ++axis) cells_[axis] = static_cast<size_t>(size[axis] / cell_m_) + 2;
  const auto index = [&](size_t x, size_t y, size_t z) { return (x * cells_[1] + y) * cells_[2] + z; };
  std::vector<int32_t> counts(cells_[0] * cells_[1] * cells_[2], 0);
  for (const scene::Bounds& box : boxes_) {
    size_t first[3], beyond[3];
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = static_cast<size_t>((box.min[axis] - room_m - corner_[axis]) / cell_m_);
      beyond[axis] = static_cast<size_t>((box.max[axis] + room_m - corner_[axis]) / cell_m_) + 1;
    }
    for (int corner = 0; corner < 8; ++corner)
      counts[index(corner & 1 ? beyond[0] : first[0], corner & 2 ? beyond[1] : first[1],
                   corner & 4 ? beyond[2] : first[2])] +=
          std::popcount(static_cast<unsigned>(corner)) % 2 ? -1 : 1;
  }
  touched_.assign(counts.size(), 0);
  for (size_t x = 0; x < cells_[0]; ++x)
    for (size_t y = 0; y < cells_[1]; ++y)
      for (size_t z = 0; z < cells_[2]; ++z) {
        int32_t sum = counts[index(x, y, z)];
        for (int corner = 1; corner < 8; ++corner) {
          const bool dx = corner & 1, dy = corner & 2, dz = corner & 4;
          if ((dx && x == 0) || (dy && y == 0) || (dz && z == 0)) continue;
          sum += (std::popcount(static_cast<unsigned>(corner)) % 2 ? 1 : -1) *
                 counts[index(x - dx, y - dy, z - dz)];
        }
        counts[index(x, y, z)] = sum;
        touched_[index(x, y, z)] = sum > 0;
      }
}

bool FoliageVolumes::may_contain(const dvec3& point) const {
  size_t cell[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double at = (point[axis] - corner_[axis]) / cell_m_;
    if (touched_.empty() || !(at >= 0.0) || at >= static_cast<double>(cells_[axis])) return false;
    cell[axis] = static_cast<size_t>(at);
  }
  return touched_[(cell[0] * cells_[1] + cell[1]) * cells_[2] + cell[2]] != 0;
}

}  // namespace greatx::rf
