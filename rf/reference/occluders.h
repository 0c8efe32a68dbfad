// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The reference's own answer to what stands between two points: every triangle, fp64, on the host.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/reference/box_tree.h"
#include "scene/description/scene.h"

namespace greatx::rf::reference {

/// A straight piece of a path and what its ends belong to.
struct Stretch {
  static constexpr uint32_t none = ~0u;
  dvec3 a{0.0}, b{0.0};                     ///< local coordinates
  uint32_t facet_a = none, facet_b = none;  ///< reflecting facets at the ends
  uint32_t body_a = none, body_b = none;    ///< bodies that carry the ends
};

/// A wall passed.
struct WallPassed {
  double t = 0.0;  ///< where between a (0) and b (1)
  uint32_t facet = 0;
  friend bool operator==(const WallPassed&, const WallPassed&) = default;
};

class Occluders {
 public:
  /// `world` with every body posed as in `body_poses` ([bodies], local_from_body, [0] the identity); all are
  /// read later too, `world` and `kinds` must outlive this.
  Occluders(const scene::Scene& scene, const FacetWorld& world, std::span<const Pose> body_poses,
            const FacetKinds& kinds);

  /// Whether the stretch is free but for `budget` walls at most, which `passed` then has in order (appended).
  /// Rules, the same as rf/paths/crossings.h states for greatx:
  /// - facets and bodies that the stretch names are never in its way;
  /// - nor is a facet whose plane one of the ends lies in, within 0.1 mm + 2^-22 of the largest coordinate of
  ///   the end
  ///   and of the facet's first corner;
  /// - opaque facets always block, foliage and what is absent never does;
  /// - a facet of kind wall is passed once however many of its triangles meet in the point, and walls in one
  ///   plane met in
  ///   one point (within 1e-6 m) are one, the first by index;
  /// - triangles are closed: edges and corners block.
  bool free_but_for(const Stretch& stretch, uint32_t budget, std::vector<WallPassed>& passed) const;

 private:
  struct Triangle {
    dvec3 corners[3];
    uint32_t facet;
  };
  bool passed_over(const Stretch& stretch, uint32_t facet) const;
  bool one_wall(const Stretch& stretch, const WallPassed& a, const WallPassed& b) const;

  const FacetWorld* world_;
  const FacetKinds* kinds_;
  std::vector<Triangle> triangles_;
  std::vector<dvec3> first_corners_;  ///< [facets]
  BoxTree tree_;
};

}  // namespace greatx::rf::reference
