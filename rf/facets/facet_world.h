// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The scene's facets as they stand at this instant, ready for the image method.
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
  dvec3 centroid{0.0};                                 ///< of its area
  double min_u = 0.0, max_u = 0.0, min_v = 0.0, max_v = 0.0;  ///< bounding box in the plane, metres
  /// A point this close to the plane is in it, this close to the outline is inside, metres: 1e-9 of the
  /// facet's extent plus 1e-13 of its coordinates (some 500 roundings).
  double tolerance_m = 0.0;
  uint32_t body = 0, material = 0;
  uint32_t owner = 0;  ///< scene::Scene::owner_of(body)
  uint32_t first_triangle = 0, triangle_count = 0;

  double distance(const dvec3& point) const { return glm::dot(normal, point) - offset; }
  dvec2 plane_coordinates(const dvec3& point) const {
    return {glm::dot(axis_u, point) - offset_u, glm::dot(axis_v, point) - offset_v};
  }
};

/// All facets of a scene, posed. Static ones are worked out once; move() re-poses those of one body. A copy
/// is a snapshot: it shares the outlines and has poses of its own, which no later move() of the original
/// changes.
class FacetWorld {
 public:
  /// Every body at rest with the identity pose.
  explicit FacetWorld(const scene::Scene& scene);
  /// Puts `body` where `motion` says: pose = local_from_body, velocities in local axes. Body 0 cannot move.
  void move(uint32_t body, const Motion& motion);
  /// Puts every body where `other`, a world of the same scene, has it.
  void take_poses(const FacetWorld& other);

  /// Where `body` was put: pose = local_from_body.
  const Motion& motion(uint32_t body) const { return motions_[body]; }

  uint32_t facet_count() const { return static_cast<uint32_t>(facets_.size()); }
  const PosedFacet& facet(uint32_t index) const { return facets_[index]; }
  /// Is a point of the facet's plane inside? The facet is closed: its outline, and the edges between its own
  /// triangles, are part of it, within tolerance_m.
  bool contains(uint32_t facet, const dvec2& plane_coordinates) const;
  /// Corners of one of the facet's triangles (below its triangle_count), local coordinates, as the mesh has
  /// them: off the facet's plane by up to the merging tolerance. Triangles without area are none of the
  /// facet's.
  std::array<dvec3, 3> corners(uint32_t facet, uint32_t triangle) const;
  /// Velocity of the facet's body at a point, m/s.
  dvec3 velocity(uint32_t facet, const dvec3& point) const;

 private:
  struct PlanarTriangle {
    double normal_u[3], normal_v[3],
        offset[3];  ///< inside: normal . (u, v) + offset >= 0, normals of unit length
  };
  struct BodyFacet {  ///< in the body's frame, as the scene has it
    dvec3 normal, axis_u, axis_v, corner, centroid;
    double extent;
  };
  /// What no motion changes; all copies of a world share it.
  struct Outlines {
    std::vector<BodyFacet> facets;
    std::vector<PlanarTriangle> triangles;
    std::vector<std::array<dvec3, 3>> corners;  ///< [triangles], in the body's frame
    std::vector<uint32_t> first_facet;          ///< [bodies + 1]: each body's facets are a range
  };
  void add(const scene::Scene& scene, const scene::Facet& facet, Outlines& outlines);
  static void pose(const BodyFacet& base, const Pose& local_from_body, PosedFacet& facet);

  std::shared_ptr<const Outlines> outlines_;
  std::vector<PosedFacet> facets_;
  std::vector<Motion> motions_;  ///< [bodies]
};

}  // namespace greatx::rf
