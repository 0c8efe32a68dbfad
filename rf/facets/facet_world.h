// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the scene's facets at their present poses, prepared for the image method.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// A facet in local coordinates, with plane coordinates (u, v) in which its outline never changes.
struct PosedFacet {
  dvec3 normal{0.0, 0.0, 1.0};                         ///< unit
  double offset = 0.0;                                 ///< normal . x = offset
  dvec3 axis_u{1.0, 0.0, 0.0}, axis_v{0.0, 1.0, 0.0};  ///< unit, axis_u x axis_v = normal
  double offset_u = 0.0, offset_v = 0.0;               ///< u = axis_u . x - offset_u: (0, 0) is a corner
  dvec3 centroid{0.0};                                 ///< centroid of the facet's area
  double min_u = 0.0, max_u = 0.0, min_v = 0.0, max_v = 0.0;  ///< bounding box in the plane, metres
  /// A point within this distance of the plane counts as in the plane, and a point within this distance of
  /// the outline as inside, metres. The value is 1e-9 of the facet's extent plus 1e-13 of its coordinates
  /// (about 500 rounding errors).
  double tolerance_m = 0.0;
  uint32_t body = 0, material = 0;
  uint32_t owner = 0;  ///< scene::Scene::owner_of(body)
  uint32_t first_triangle = 0, triangle_count = 0;

  double distance(const dvec3& point) const { return glm::dot(normal, point) - offset; }
  dvec2 plane_coordinates(const dvec3& point) const {
    return {glm::dot(axis_u, point) - offset_u, glm::dot(axis_v, point) - offset_v};
  }
};

/// Holds all facets of a scene at their poses. Static facets are computed once; move() poses the facets of
/// one body again. A copy is a snapshot: it shares the outlines and has its own poses, which no later move()
/// of the original changes.
class FacetWorld {
 public:
  /// Every body is at rest with the identity pose.
  explicit FacetWorld(const scene::Scene& scene);
  /// Moves `body` to `motion`: pose = local_from_body, velocities along local axes. Body 0 cannot move.
  void move(uint32_t body, const Motion& motion);
  /// Gives every body its pose in `other`, which must be a copy of this world or its original.
  void take_poses(const FacetWorld& other);

  /// Returns the last motion of `body`: pose = local_from_body.
  const Motion& motion(uint32_t body) const { return motions_[body]; }

  uint32_t facet_count() const { return static_cast<uint32_t>(facets_.size()); }
  const PosedFacet& facet(uint32_t index) const { return facets_[index]; }
  /// Tells whether a point of the facet's plane is inside the facet. The facet is closed: its outline, and
  /// the edges between its own triangles, belong to it, within tolerance_m.
  bool contains(uint32_t facet, const dvec2& plane_coordinates) const;
  /// Returns the corners of one triangle of the facet (below its triangle_count) in local coordinates, as the
  /// mesh has them. They may be off the facet's plane by the merging tolerance. Triangles without area do not
  /// belong to the facet.
  std::array<dvec3, 3> corners(uint32_t facet, uint32_t triangle) const;
  /// Returns the velocity of the facet's body at a point, m/s.
  dvec3 velocity(uint32_t facet, const dvec3& point) const;

 private:
  /// Holds the sides of a triangle: inside, normal . (u, v) + offset >= 0, with normals of unit length.
  struct PlanarTriangle {
    double normal_u[3], normal_v[3], offset[3];
  };
  /// Holds a facet in its body's frame, as in the scene.
  struct BodyFacet {
    dvec3 normal, axis_u, axis_v, corner, centroid;
    double extent;
  };
  /// Holds everything that no motion changes. All copies of a world share it.
  struct Outlines {
    std::vector<BodyFacet> facets;
    std::vector<PlanarTriangle> triangles;
    std::vector<std::array<dvec3, 3>> corners;  ///< [triangles], in the body's frame
    std::vector<uint32_t> first_facet;          ///< [bodies + 1]; the facets of a body are a range
  };
  void add(const scene::Scene& scene, const scene::Facet& facet, Outlines& outlines);
  static void pose(const BodyFacet& base, const Pose& local_from_body, PosedFacet& facet);

  std::shared_ptr<const Outlines> outlines_;
  std::vector<PosedFacet> facets_;
  std::vector<Motion> motions_;  ///< [bodies]
};

}  // namespace greatx::rf
