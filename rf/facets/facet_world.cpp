// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/facets/facet_world.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace greatx::rf {
namespace {

/// Returns a unit vector perpendicular to `normal`, computed without cancellation (Duff et al., "Building an
/// orthonormal basis, revisited", JCGT 6(1), 2017).
dvec3 perpendicular(const dvec3& normal) {
  const double sign = std::copysign(1.0, normal.z);
  const double a = -1.0 / (sign + normal.z);
  return {1.0 + sign * normal.x * normal.x * a, sign * normal.x * normal.y * a, -sign * normal.x};
}

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

FacetWorld::FacetWorld(const scene::Scene& scene) : motions_(std::max<size_t>(1, scene.bodies.size())) {
  const auto outlines = std::make_shared<Outlines>();
  facets_.reserve(scene.facets.size());
  outlines->facets.reserve(scene.facets.size());
  outlines->triangles.reserve(scene.facet_triangles.size());
  outlines->corners.reserve(scene.facet_triangles.size());
  for (const scene::Facet& facet : scene.facets) add(scene, facet, *outlines);
  for (uint32_t body = 0; body <= motions_.size(); ++body) {
    const auto first = std::ranges::lower_bound(facets_, body, {}, &PosedFacet::body);
    outlines->first_facet.push_back(static_cast<uint32_t>(first - facets_.begin()));
  }
  outlines_ = outlines;
}

void FacetWorld::add(const scene::Scene& scene, const scene::Facet& facet, Outlines& outlines) {
  const size_t index = facets_.size();
  GREATX_CHECK(facets_.empty() || facets_.back().body <= facet.body,
               "facet {} of body {} after one of body {}", index, facet.body, facets_.back().body);
  GREATX_CHECK(facet.triangle_count > 0 &&
                   facet.first_triangle + size_t{facet.triangle_count} <= scene.facet_triangles.size(),
               "facet {}: triangles {} + {} of {}", index, facet.first_triangle, facet.triangle_count,
               scene.facet_triangles.size());
  GREATX_CHECK(facet.body < motions_.size(), "facet {}: body {} of {}", index, facet.body, motions_.size());
  GREATX_CHECK(std::abs(glm::length(facet.normal) - 1.0) < 1e-9, "facet {}: normal of length {}", index,
               glm::length(facet.normal));

  BodyFacet base{};
  base.normal = facet.normal;
  base.axis_u = perpendicular(facet.normal);
  base.axis_v = glm::cross(facet.normal, base.axis_u);
  // The reference corner is moved into the plane, because corners may be off it by the merging tolerance.
  const dvec3 first = scene.facet_triangles[facet.first_triangle].corners[0];
  base.corner = first - (glm::dot(facet.normal, first) - facet.offset) * facet.normal;

  PosedFacet posed;
  posed.body = facet.body;
  posed.owner = facet.body < scene.bodies.size() ? scene.owner_of(facet.body) : facet.body;
  posed.material = facet.material;
  posed.first_triangle = static_cast<uint32_t>(outlines.triangles.size());
  dvec2 low(1e300), high(-1e300), weighted(0.0);
  double area = 0.0;
  for (uint32_t t = 0; t < facet.triangle_count; ++t) {
    dvec2 corner[3];
    for (int k = 0; k < 3; ++k) {
      const dvec3 from_corner = scene.facet_triangles[facet.first_triangle + t].corners[k] - base.corner;
      corner[k] = {glm::dot(base.axis_u, from_corner), glm::dot(base.axis_v, from_corner)};
      low = glm::min(low, corner[k]);
      high = glm::max(high, corner[k]);
    }
    const double doubled = cross(corner[1] - corner[0], corner[2] - corner[0]);
    if (doubled == 0.0) continue;  // a triangle without area reflects nothing
    area += std::abs(doubled);
    weighted += std::abs(doubled) / 3.0 * (corner[0] + corner[1] + corner[2]);
    PlanarTriangle planar{};
    for (int k = 0; k < 3; ++k) {
      const dvec2 along = corner[(k + 1) % 3] - corner[k];
      const double scale = std::copysign(1.0 / std::hypot(along.x, along.y), doubled);
      planar.normal_u[k] = -along.y * scale;
      planar.normal_v[k] = along.x * scale;
      planar.offset[k] = -(planar.normal_u[k] * corner[k].x + planar.normal_v[k] * corner[k].y);
    }
    outlines.triangles.push_back(planar);
    const dvec3* corners = scene.facet_triangles[facet.first_triangle + t].corners;
    outlines.corners.push_back({corners[0], corners[1], corners[2]});
  }
  posed.triangle_count = static_cast<uint32_t>(outlines.triangles.size()) - posed.first_triangle;
  posed.min_u = low.x, posed.max_u = high.x, posed.min_v = low.y, posed.max_v = high.y;
  base.extent = std::hypot(high.x - low.x, high.y - low.y);
  const dvec2 center = area > 0.0 ? weighted / area : 0.5 * (low + high);
  base.centroid = base.corner + center.x * base.axis_u + center.y * base.axis_v;
  outlines.facets.push_back(base);
  facets_.push_back(posed);
  pose(base, Pose{}, facets_.back());
  if (facet.body == 0) facets_.back().offset = facet.offset;  // exactly the number of the scene
}

void FacetWorld::pose(const BodyFacet& base, const Pose& local_from_body, PosedFacet& facet) {
  facet.normal = local_from_body.rotate(base.normal);
  facet.axis_u = local_from_body.rotate(base.axis_u);
  facet.axis_v = local_from_body.rotate(base.axis_v);
  const dvec3 corner = local_from_body.apply(base.corner);
  facet.offset = glm::dot(facet.normal, corner);
  facet.offset_u = glm::dot(facet.axis_u, corner);
  facet.offset_v = glm::dot(facet.axis_v, corner);
  facet.centroid = local_from_body.apply(base.centroid);
  facet.tolerance_m = 1e-9 * base.extent + 1e-13 * (glm::length(corner) + base.extent);
}

void FacetWorld::move(uint32_t body, const Motion& motion) {
  GREATX_CHECK(body > 0 && body < motions_.size(), "body {} of {} cannot move", body, motions_.size());
  motions_[body] = motion;
  const std::vector<uint32_t>& first = outlines_->first_facet;
  for (uint32_t index = first[body]; index < first[body + 1]; ++index)
    pose(outlines_->facets[index], motion.pose, facets_[index]);
}

void FacetWorld::take_poses(const FacetWorld& other) {
  GREATX_CHECK(outlines_ == other.outlines_, "poses of another scene's facets: {} here, {} there",
               facets_.size(), other.facets_.size());
  motions_ = other.motions_;
  const auto moving = static_cast<std::ptrdiff_t>(outlines_->first_facet[1]);
  std::copy(other.facets_.begin() + moving, other.facets_.end(), facets_.begin() + moving);
}

bool FacetWorld::contains(uint32_t index, const dvec2& at) const {
  const PosedFacet& facet = facets_[index];
  const double slack = -facet.tolerance_m;
  if (at.x < facet.min_u + slack || at.x > facet.max_u - slack) return false;
  if (at.y < facet.min_v + slack || at.y > facet.max_v - slack) return false;
  for (uint32_t t = 0; t < facet.triangle_count; ++t) {
    const PlanarTriangle& triangle = outlines_->triangles[facet.first_triangle + t];
    bool inside = true;
    for (int k = 0; k < 3 && inside; ++k)
      inside = triangle.normal_u[k] * at.x + triangle.normal_v[k] * at.y + triangle.offset[k] >= slack;
    if (inside) return true;
  }
  return false;
}

std::array<dvec3, 3> FacetWorld::corners(uint32_t index, uint32_t triangle) const {
  const PosedFacet& facet = facets_[index];
  GREATX_CHECK(triangle < facet.triangle_count, "facet {}: triangle {} of {}", index, triangle,
               facet.triangle_count);
  std::array<dvec3, 3> corners = outlines_->corners[facet.first_triangle + triangle];
  if (facet.body == 0) return corners;  // exactly the numbers of the scene
  for (dvec3& corner : corners) corner = motions_[facet.body].pose.apply(corner);
  return corners;
}

dvec3 FacetWorld::velocity(uint32_t index, const dvec3& point) const {
  const Motion& motion = motions_[facets_[index].body];
  return motion.velocity + glm::cross(motion.angular_velocity, point - motion.pose.position);
}

}  // namespace greatx::rf
