// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds out where an end of a channel stands: free, inside a solid, beneath an open surface, inside foliage,
// or exactly on a surface. It runs on the host in fp64.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "scene/description/scene.h"
#include "scene/description/triangle_tree.h"

namespace greatx::rf {

/// Describes where a point stands. Each index is a facet (into Scene::facets) that identifies the object and
/// its material; `none` means that the case does not apply.
struct Placement {
  static constexpr uint32_t none = ~0u;
  uint32_t solid = none;  ///< facet of the object that surrounds the point
  /// Facet of the open surface above the point, with nothing below the point: the point is in the ground, if
  /// the ground is a mere sheet.
  uint32_t beneath = none;
  uint32_t foliage = none;  ///< facet of the foliage around the point
  uint32_t surface = none;  ///< nearest facet that the point lies on
  double surface_m = 0.0;   ///< distance from that facet, metres
  bool free() const { return solid == none && beneath == none && foliage == none && surface == none; }
  friend bool operator==(const Placement&, const Placement&) = default;
};

/// Finds the placement of points among the facets of a scene.
///
/// Inside a solid. 17 rays start at the point: one goes upwards, eight go in all directions just above the
/// horizon, and eight go along the horizon. The point is inside if on every ray, somewhere on its way, the
/// ray has left more surfaces than it has entered since the point (normals point out of solids). For a closed
/// mesh this is the winding number. The rule also holds for common faults of files: houses without a floor,
/// walls and roof as two objects, furniture inside. A room whose normals point inwards is not solid. Neither
/// is the space under a roof without walls, however wide (rays along the horizon find no wall), or behind
/// walls with a hole that one of the rays finds. A ray that meets the edge between two triangles meets
/// exactly one of them. Meshes without consistent winding give arbitrary results.
///
/// Beneath an open surface. The first nine rays leave a surface, at least one ray along the horizon does not,
/// and the first surface straight below is not one that a ray enters (as it would be under a bridge). Only
/// the static world counts. This also covers a point below a ground that is a sheet.
///
/// On a surface. The point is within shared::visibility_tolerance of a facet (rf/paths/crossings.h), so that
/// the facet blocks the view to neither side.
class Surroundings {
 public:
  /// `kinds`: [facets of the scene]; absent facets are left out. Every call reads `scene`, which must outlive
  /// this object.
  Surroundings(const scene::Scene& scene, const FacetKinds& kinds);

  /// Returns the placement of `point` (local coordinates) for the present `body_poses` [bodies of the scene].
  /// Facets of `own_body`, which carries the point, do not count; 0: no body carries it. Each body is judged
  /// on its own, the static world first. Thread-safe.
  Placement of(const dvec3& point, std::span<const Pose> body_poses, uint32_t own_body = 0) const;
  /// Returns the placement of `point` among the facets of the static world alone.
  Placement in_static_world(const dvec3& point) const;

  /// Returns the distance from `point` (local coordinates) to the static world, m, or `most_m` if that is
  /// less.
  double distance(const dvec3& point, double most_m) const;
  /// Returns the facet of the static world that a segment passes through first, foliage left out. A segment
  /// that begins or ends on a surface does not pass through it.
  std::optional<uint32_t> first_passed(const dvec3& from, const dvec3& to) const;
  /// Returns the facet that a ray meets first, on any body but those of `own_body`; nothing: the sky.
  std::optional<uint32_t> first_seen(const dvec3& origin, const dvec3& direction,
                                     std::span<const Pose> body_poses, uint32_t own_body) const;

 private:
  /// Holds the hard facets, or the foliage facets, of one body.
  struct Shell {
    uint32_t body = 0;
    bool foliage = false;
    std::vector<uint32_t> triangles;  ///< into Scene::facet_triangles
    std::vector<uint32_t> facets;     ///< [triangles]
    scene::Bounds bounds;             ///< in the body's frame
    scene::TriangleTree tree;
  };
  struct Hit;
  struct Met;
  const scene::FacetTriangle& triangle_of(const Shell& shell, uint32_t index) const {
    return scene_->facet_triangles[shell.triangles[index]];
  }
  void place(const Shell& shell, const dvec3& point, Placement& placement) const;
  void surround(const Shell& shell, const dvec3& point, Placement& placement) const;
  uint32_t most_named(std::span<const uint32_t> facets) const;
  bool floor_below(const Shell& shell, const dvec3& point) const;
  std::vector<Hit> hits(const Shell& shell, const dvec3& point, const dvec3& direction, double reach_m) const;
  uint32_t comes_out_of(const Shell& shell, const dvec3& point, const dvec3& direction) const;
  void touch(const Shell& shell, const dvec3& point, Placement& placement) const;
  std::optional<Met> first_met(const Shell& shell, const dvec3& from, const dvec3& along, double least_t,
                               double most_t) const;

  const scene::Scene* scene_;
  std::vector<Shell> shells_;  ///< by body; within a body the hard facets come first
};

/// Returns a text that explains a placement and its consequence for the visibility, as in "lies inside
/// 'house' (material brick): ..."; "is free" for a free point.
std::string describe(const Placement& placement, const scene::Scene& scene, const FacetKinds& kinds);

}  // namespace greatx::rf
