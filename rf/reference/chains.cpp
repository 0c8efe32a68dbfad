// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/reference/chains.h"

#include <algorithm>
#include <cmath>

namespace greatx::rf::reference {

Chains::Chains(const scene::Scene& scene, const FacetWorld& world, std::span<const Pose> body_poses,
               const FacetKinds& kinds)
    : world_(world), occluders_(scene, world, body_poses, kinds) {
  hulls_.resize(scene.facets.size());
  std::vector<scene::Bounds> boxes;
  for (uint32_t f = 0; f < scene.facets.size(); ++f) {
    const scene::Facet& facet = scene.facets[f];
    if (kinds[f] != FacetKind::opaque && kinds[f] != FacetKind::wall) continue;
    std::vector<dvec3> corners;
    for (uint32_t t = 0; t < facet.triangle_count; ++t)
      for (const dvec3& corner : scene.facet_triangles[facet.first_triangle + t].corners)
        corners.push_back(facet.body == 0 ? corner : body_poses[facet.body].apply(corner));
    hulls_[f] = convex_hull(world_.facet(f), corners);
    facets_.push_back(f);
    boxes.push_back(hulls_[f].box);
  }
  tree_ = BoxTree(boxes);
}

bool Chains::push(Chain& chain, uint32_t index) const {
  const PosedFacet& facet = world_.facet(index);
  const double distance = facet.distance(chain.images.back());
  if (std::abs(distance) <= facet.tolerance_m) return false;
  const double side = distance > 0.0 ? 1.0 : -1.0;
  if (!chain.facets.empty()) {
    if (chain.facets.back() == index) return false;
    const auto has_corner = [&](uint32_t of, const PosedFacet& plane, double on, double beyond) {
      return std::any_of(hulls_[of].corners.begin(), hulls_[of].corners.end(),
                         [&](const dvec3& corner) { return on * plane.distance(corner) > beyond; });
    };
    const PosedFacet& last = world_.facet(chain.facets.back());
    if (!has_corner(chain.facets.back(), facet, side, -facet.tolerance_m)) return false;
    if (!has_corner(index, last, chain.sides.back(), last.tolerance_m)) return false;
  }
  chain.facets.push_back(index);
  chain.sides.push_back(side);
  chain.images.push_back(chain.images.back() - 2.0 * distance * facet.normal);
  return true;
}

void Chains::pop(Chain& chain) {
  chain.facets.pop_back();
  chain.sides.pop_back();
  chain.images.pop_back();
}

void Chains::view(const Chain& chain, const std::vector<HalfSpace>& before,
                  std::vector<HalfSpace>& half_spaces) const {
  const uint32_t last = chain.facets.back();
  pyramid(chain.images.back(), world_.facet(last), hulls_[last], chain.sides.back(), half_spaces);
  for (size_t i = 1; i < before.size(); ++i)  // before[0] is the plane of the mirror before
    half_spaces.push_back(mirrored(before[i], world_.facet(last)));
}

bool Chains::reflect(const Chain& chain, const dvec3& end, std::vector<dvec3>& points) const {
  const size_t count = chain.facets.size();
  std::vector<dvec3> targets(count + 1, end);
  for (size_t i = count; i-- > 0;) {
    const PosedFacet& facet = world_.facet(chain.facets[i]);
    targets[i] = targets[i + 1] - 2.0 * facet.distance(targets[i + 1]) * facet.normal;
  }
  points.assign(1, chain.images.front());
  for (size_t i = 0; i < count; ++i) {
    const PosedFacet& facet = world_.facet(chain.facets[i]);
    const double tolerance = facet.tolerance_m, side = chain.sides[i];
    const double before = side * facet.distance(points.back());
    const double behind = -side * facet.distance(targets[i]);
    if (before < (i == 0 ? tolerance : -tolerance) || behind <= tolerance) return false;
    if (i + 1 == count && side * facet.distance(end) < tolerance) return false;
    const double t = std::max(before, 0.0) / (std::max(before, 0.0) + behind);
    const dvec3 hit = points.back() + t * (targets[i] - points.back());
    if (!world_.contains(chain.facets[i], facet.plane_coordinates(hit))) return false;
    if (i > 0) {
      const PosedFacet& previous = world_.facet(chain.facets[i - 1]);
      // The hit must be on the reflecting side of the facet before.
      if (chain.sides[i - 1] * previous.distance(hit) < -previous.tolerance_m) return false;
      const bool one_point = glm::distance(hit, points.back()) <= 4.0 * (tolerance + previous.tolerance_m);
      const bool inner_corner = side * facet.distance(previous.centroid) > tolerance &&
                                chain.sides[i - 1] * previous.distance(facet.centroid) > previous.tolerance_m;
      if (one_point && !inner_corner) return false;
    }
    points.push_back(hit);
  }
  points.push_back(end);
  return true;
}

bool Chains::pass_walls(GeometricPath& path, const Limits& limits,
                        std::span<const scene::Wedge> wedges) const {
  const auto body = [](uint32_t index) { return index == 0 ? Stretch::none : index; };
  const auto touch = [&](const Interaction& at, uint32_t& facet, uint32_t& other) {
    const bool edge = at.type == InteractionType::diffraction;
    facet = edge ? wedges[at.element].facet_0 : at.element;
    other = edge ? wedges[at.element].facet_n : Stretch::none;
  };
  const size_t bends = path.interactions.size();
  uint32_t budget = std::min(limits.max_transmissions, limits.max_depth - static_cast<uint32_t>(bends));
  GeometricPath whole;
  whole.length_m = path.length_m;
  std::vector<WallPassed> walls;
  for (size_t i = 0; i <= bends; ++i) {
    Stretch stretch{path.vertices[i], path.vertices[i + 1]};
    if (i > 0) touch(path.interactions[i - 1], stretch.facet_a, stretch.other_a);
    if (i < bends) touch(path.interactions[i], stretch.facet_b, stretch.other_b);
    if (i == 0) stretch.body_a = body(limits.transmitter_body);
    if (i == bends) stretch.body_b = body(limits.receiver_body);
    walls.clear();
    if (!occluders_.free_but_for(stretch, budget, walls)) return false;
    budget -= static_cast<uint32_t>(walls.size());
    whole.vertices.push_back(stretch.a);
    for (const WallPassed& wall : walls) {
      whole.vertices.push_back(stretch.a + wall.t * (stretch.b - stretch.a));
      whole.interactions.push_back({InteractionType::transmission, wall.facet, 0});
    }
    if (i < bends) whole.interactions.push_back(path.interactions[i]);
  }
  whole.vertices.push_back(path.vertices.back());
  path = std::move(whole);
  return true;
}

}  // namespace greatx::rf::reference
