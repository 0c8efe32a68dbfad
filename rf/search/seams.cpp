// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/seams.h"

#include <algorithm>

namespace greatx::rf {
namespace {

constexpr double least_seam_sine = 0.1;
/// At a smaller distance the facet is met at the point itself.
constexpr double touching_m = 1e-7;
constexpr uint32_t dark = 1u << 16;

}  // namespace

void Seams::drop_behind(std::vector<GeometricPath>& paths, Source source, uint32_t source_body) const {
  const auto reflects = [](const Interaction& i) { return i.type == InteractionType::reflection; };
  std::erase_if(paths, [&](const GeometricPath& path) {
    return std::ranges::all_of(path.interactions, reflects) && is_behind(path, source, source_body);
  });
}

bool Seams::is_behind(const GeometricPath& path, Source source, uint32_t source_body) const {
  const size_t count = path.interactions.size();
  uint32_t walls = 0;
  // Vertices are counted from the source outwards: 0 to count + 1.
  const auto vertex = [&](size_t i) -> const dvec3& {
    return path.vertices[source == Source::transmitter ? i : count + 1 - i];
  };
  const auto facet = [&](size_t i) {  // facet at vertex i
    return path.interactions[source == Source::transmitter ? i - 1 : count - i].element;
  };
  for (size_t leg = 0; leg < count; ++leg) {  // from vertex `leg` to the next vertex
    const uint32_t ignored = leg == 0 ? source_body : 0;
    for (const BeamScene* scene : {fixed_.get(), &moving_})
      walls += passed(*scene, vertex(leg + 1), vertex(leg), facet(leg + 1), ignored);
  }
  return walls > max_transmissions_ || walls + count > max_depth_;
}

uint32_t Seams::passed(const BeamScene& scene, const dvec3& point, const dvec3& other, uint32_t facet,
                       uint32_t ignored_body) const {
  const FacetWorld& world = scene.world();
  const double length = glm::length(other - point);
  if (length <= touching_m) return 0;
  HalfSpace around[6];
  for (int i = 0; i < 6; ++i) {
    dvec3 normal(0.0);
    normal[i / 2] = i % 2 == 0 ? 1.0 : -1.0;
    around[i] = {normal, glm::dot(normal, point) - reach_m};
  }
  std::vector<uint32_t> near;
  scene.gather(around, near);
  uint32_t walls = 0;
  for (const uint32_t index : near) {
    const BeamFacet& cover = scene.facet(index);
    if (cover.index == facet || (ignored_body != 0 && cover.owner == ignored_body)) continue;
    if (glm::length(glm::cross(cover.normal, world.facet(facet).normal)) < least_seam_sine) continue;
    const double a = glm::dot(cover.normal, point) - cover.offset;
    const double b = glm::dot(cover.normal, other) - cover.offset;
    if (a * b >= 0.0) continue;
    const double share = a / (a - b);
    if (share * length <= touching_m || share * length > reach_m) continue;
    const dvec3 at = point + share * (other - point);
    if (!world.contains(cover.index, world.facet(cover.index).plane_coordinates(at))) continue;
    if (cover.kind == FacetKind::opaque || max_transmissions_ == 0) return dark;
    ++walls;
  }
  return walls;
}

}  // namespace greatx::rf
