// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where an end of a channel stands: free, inside a solid, beneath an open surface, inside foliage, exactly on
// a surface. fp64, on the host.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "scene/description/scene.h"
#include "scene/description/triangle_tree.h"

namespace greatx::rf {

/// Each a facet (index into Scene::facets) that tells the object and its material; none: it is not so.
struct Placement {
  static constexpr uint32_t none = ~0u;
  uint32_t solid = none;  ///< of the object that surrounds the point
  uint32_t beneath =
      none;  ///< of the open surface above it, with nothing below: in the ground, if that is a mere sheet
  uint32_t foliage = none;  ///< of the foliage around it
  uint32_t surface = none;  ///< that it lies on, the nearest one
  double surface_m = 0.0;   ///< its distance from that
  bool free() const { return solid == none && beneath == none && foliage == none && surface == none; }
  friend bool operator==(const Placement&, const Placement&) = default;
};

/// The facets of a scene, ready to be asked where a point stands among them.
///
/// Inside a solid: of 17 rays, one upwards, eight all around just over the horizon and eight along it, each
/// comes out of more surfaces than it went into, counted from the point to somewhere on its way (normals
/// point out of what is solid). For a closed mesh this is the winding number; and it holds, too, for what
/// files have instead: houses without a floor, walls and roof as two objects, furniture within. A room whose
/// normals point inwards is not solid, nor is what is under a roof without walls however wide (rays along the
/// horizon find no wall), or behind walls with a hole that one of the rays finds. Rays that meet an edge
/// between two triangles meet one of them. Meshes without consistent winding give chance answers.
///
/// Beneath an open surface: the first nine rays come out of one, some along the horizon do not, and downwards
/// nothing is met that a ray goes into, as under a bridge; of the static world alone. So is a point below a
/// ground that is a sheet.
///
/// On a surface: within shared::visibility_tolerance of a facet (rf/paths/crossings.h): the surface does not
/// stand in the point's way to either side.
class Surroundings {
 public:
  /// `kinds` [facets of the scene]; absent facets are left out. `scene` is read by every call and must
  /// outlive this.
  Surroundings(const scene::Scene& scene, const FacetKinds& kinds);

  /// `point` in local coordinates, `body_poses` [bodies of the scene] as they stand. Facets of `own_body`,
  /// which carries the point, do not count; 0: none does. Each body is judged alone, the static world first.
  /// Thread-safe.
  Placement of(const dvec3& point, std::span<const Pose> body_poses, uint32_t own_body = 0) const;

 private:
  /// The facets of one body that are hard, or foliage.
  struct Shell {
    uint32_t body = 0;
    bool foliage = false;
    std::vector<scene::FacetTriangle> triangles;
    std::vector<uint32_t> facets;  ///< [triangles]
    scene::Bounds bounds;          ///< in the body's frame
    scene::TriangleTree tree;
  };
  struct Hit;
  void surround(const Shell& shell, const dvec3& point, Placement& placement) const;
  uint32_t most_named(std::span<const uint32_t> facets) const;
  bool floor_below(const Shell& shell, const dvec3& point) const;
  std::vector<Hit> hits(const Shell& shell, const dvec3& point, const dvec3& direction, double reach_m) const;
  uint32_t comes_out_of(const Shell& shell, const dvec3& point, const dvec3& direction) const;
  void touch(const Shell& shell, const dvec3& point, Placement& placement) const;

  const scene::Scene* scene_;
  std::vector<Shell> shells_;  ///< by body, hard ones before foliage
};

/// What a placement means for what the point sees, as in "lies inside 'house' (material brick): ..."; "is
/// free" if it is.
std::string describe(const Placement& placement, const scene::Scene& scene, const FacetKinds& kinds);

}  // namespace greatx::rf
