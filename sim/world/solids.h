// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Answers geometric questions about a world on the host, in fp64: where a point stands, how far it is from
// the static world, and what a ray meets. Trajectories that keep clear of walls, warnings of sensors within
// walls, and `greatx check` ask them; nothing that a sensor measures depends on them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rf/facets/placement.h"
#include "scene/description/scene.h"
#include "scene/description/triangle_tree.h"

namespace greatx::sim {

/// The surfaces of a scene in trees. Every function is thread-safe.
class Solids {
 public:
  /// `scene` outlives this.
  explicit Solids(const scene::Scene& scene);

  /// Returns where `point` (local coordinates) stands, as rf::Surroundings::of() does. Every surface counts,
  /// whatever the effects of a run; foliage is what a radio material calls foliage.
  rf::Placement placement(const dvec3& point, std::span<const Pose> body_poses, uint32_t own_body) const {
    return surroundings_.of(point, body_poses, own_body);
  }
  /// Does the same among the surfaces of the static world alone.
  rf::Placement placement_in_static_world(const dvec3& point) const {
    return surroundings_.in_static_world(point);
  }
  /// Returns the name of the object that a facet belongs to.
  const std::string& object_of(uint32_t facet) const;

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
  struct Shell {
    uint32_t body = 0;
    std::vector<scene::FacetTriangle> triangles;
    std::vector<uint32_t> facets;  ///< [triangles]
    std::unique_ptr<scene::TriangleTree> tree;
  };
  struct Met {
    double t = 0.0;
    uint32_t facet = 0;
  };
  std::optional<Met> first_met(const Shell& shell, const dvec3& from, const dvec3& along, double least_t,
                               double most_t, bool through_foliage) const;

  const scene::Scene& scene_;
  rf::FacetKinds kinds_;
  rf::Surroundings surroundings_;
  std::vector<Shell> shells_;  ///< [0] the static world; then every body that has facets
};

}  // namespace greatx::sim
