// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the surfaces between two points for the reference: every triangle is tested in fp64 on the host.
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

/// Describes a straight segment of a path and the facets and bodies at its ends.
struct Stretch {
  static constexpr uint32_t none = ~0u;
  dvec3 a{0.0}, b{0.0};                     ///< local coordinates
  uint32_t facet_a = none, facet_b = none;  ///< reflecting facets at the ends, or faces of wedges
  uint32_t other_a = none, other_b = none;  ///< the other faces of wedges
  uint32_t body_a = none, body_b = none;    ///< bodies that carry the ends
};

/// Describes a wall that a stretch passes.
struct WallPassed {
  double t = 0.0;  ///< place between a (0) and b (1)
  uint32_t facet = 0;
  friend bool operator==(const WallPassed&, const WallPassed&) = default;
};

class Occluders {
 public:
  /// `world` has every body posed as in `body_poses` ([bodies], local_from_body, [0] the identity). Later
  /// calls read `world` and `kinds`, which must outlive this object.
  Occluders(const scene::Scene& scene, const FacetWorld& world, std::span<const Pose> body_poses,
            const FacetKinds& kinds);

  /// Tells whether nothing but at most `budget` walls blocks the stretch. If no opaque facet blocks it, the
  /// walls are appended to `passed`, in order. The rules are those that rf/paths/crossings.h states for
  /// greatx:
  /// - Facets and bodies that the stretch names never block it.
  /// - A facet does not block if one of the ends lies in its plane, within 0.1 mm + 2^-22 of the largest
  ///   coordinate of the end and of the facet's first corner.
  /// - Opaque facets always block. Foliage and absent facets never do.
  /// - A facet of kind wall is passed once, however many of its triangles meet at the point. Walls in one
  ///   plane are one wall, within the tolerance of visibility, and so are walls that are met in their common
  ///   edge. The wall with the lowest index is kept.
  /// - Triangles are closed: edges and corners block.
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
