// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/edge_gaps.h"

#include <algorithm>

namespace greatx::rf {
namespace {

/// Facets that are nearer to parallel with the reflecting one make no corner with it (as in Seams).
constexpr double least_corner_sine = 0.1;
/// At a smaller distance from a facet's plane the point is in the edge.
constexpr double in_edge_m = 1e-7;
/// At a larger distance the visibility test has seen the facet: its tolerance is below this up to 20 km from
/// the local origin.
constexpr double unseen_m = 5e-3;

}  // namespace

EdgeGaps::EdgeGaps(const scene::Scene& scene, const FacetKinds& kinds) {
  std::vector<std::vector<scene::FacetTriangle>> triangles(std::max<size_t>(1, scene.bodies.size()));
  std::vector<std::vector<uint32_t>> facets(triangles.size());
  for (uint32_t index = 0; index < scene.facets.size(); ++index) {
    const scene::Facet& facet = scene.facets[index];
    if (kinds[index] != FacetKind::opaque) continue;
    for (uint32_t t = facet.first_triangle; t < facet.first_triangle + facet.triangle_count; ++t) {
      triangles[facet.body].push_back(scene.facet_triangles[t]);
      facets[facet.body].push_back(index);
    }
  }
  for (size_t body = 0; body < triangles.size(); ++body)
    shells_.push_back({std::move(facets[body]), scene::TriangleTree(triangles[body])});
}

bool EdgeGaps::passes_one(const FacetWorld& world, const GeometricPath& path, uint32_t transmitter_body,
                          uint32_t receiver_body) const {
  const size_t count = path.interactions.size();
  for (size_t i = 0; i < count; ++i) {
    if (path.interactions[i].type != InteractionType::reflection) continue;
    const uint32_t facet = path.interactions[i].element;
    const dvec3& point = path.vertices[i + 1];
    if (blocked(world, facet, point, path.vertices[i], i == 0 ? transmitter_body : 0)) return true;
    if (blocked(world, facet, point, path.vertices[i + 2], i + 1 == count ? receiver_body : 0)) return true;
  }
  return false;
}

bool EdgeGaps::blocked(const FacetWorld& world, uint32_t facet, const dvec3& point, const dvec3& other,
                       uint32_t ignored_body) const {
  const uint32_t body = world.facet(facet).body;
  return blocked_by(0, world, facet, point, other, ignored_body) ||
         (body != 0 && blocked_by(body, world, facet, point, other, ignored_body));
}

bool EdgeGaps::blocked_by(uint32_t body, const FacetWorld& world, uint32_t facet, const dvec3& point,
                          const dvec3& other, uint32_t ignored_body) const {
  const Shell& shell = shells_[body];
  const Pose to_body = body == 0 ? Pose{} : world.motion(body).pose.inverse();
  std::vector<uint32_t> near;
  shell.tree.near_segment(to_body.apply(point), to_body.apply(other), 0.0, near);
  const PosedFacet& mirror = world.facet(facet);
  const dvec3 outwards = mirror.distance(other) < 0.0 ? -mirror.normal : mirror.normal;
  for (const uint32_t triangle : near) {
    const uint32_t index = shell.facets[triangle];
    if (index == facet) continue;
    const PosedFacet& cover = world.facet(index);
    if (ignored_body != 0 && cover.owner == ignored_body) continue;
    const double from = cover.distance(point), to = cover.distance(other);
    if (from * to >= 0.0 || std::abs(from) <= in_edge_m || std::abs(from) > unseen_m) continue;
    if (std::abs(to) <= in_edge_m) continue;  // the leg ends there: a reflection, or an edge of this facet
    if (glm::length(glm::cross(cover.normal, mirror.normal)) < least_corner_sine) continue;
    // A little outwards: a facet that only reaches up to the edge from behind is not in the way.
    const dvec3 at = point + from / (from - to) * (other - point) + 10.0 * in_edge_m * outwards;
    if (world.contains(index, cover.plane_coordinates(at))) return true;
  }
  return false;
}

}  // namespace greatx::rf
