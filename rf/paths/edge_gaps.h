// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Closes the gaps that the visibility test leaves along edges. A surface on which an end of a segment lies,
// as far as fp32 can tell, does not block the segment (rf/paths/crossings.h). Where two walls meet in a
// corner, a reflection point within 0.1 mm of the edge lies on both of them in this sense, and the wall
// behind would let the wave out of a closed room. Here the wall is tested in fp64.
//
//   lit paths of CrossingPass ─► legs before and after each reflection ─► EdgeGaps ─► paths that stay
#pragma once

#include <vector>

#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/geometry/path.h"
#include "scene/description/triangle_tree.h"

namespace greatx::rf {

class EdgeGaps {
 public:
  /// `kinds`: [facets of the scene].
  EdgeGaps(const scene::Scene& scene, const FacetKinds& kinds);

  /// Tells whether a leg of the path next to a reflection passes an opaque facet so close to the reflection
  /// point that the visibility test may have missed it. The facet is one of the world at rest or of the body
  /// that reflects. Facets of the bodies that carry the ends (0: none) do not count on the legs to these
  /// ends. A point within 1e-7 m of both facets lies in their edge and belongs to both: it passes neither.
  /// Nor does a leg pass a facet on which it ends.
  bool passes_one(const FacetWorld& world, const GeometricPath& path, uint32_t transmitter_body,
                  uint32_t receiver_body) const;

 private:
  struct Shell {
    std::vector<uint32_t> facets;  ///< [triangles of the tree]
    scene::TriangleTree tree;
  };
  bool blocked(const FacetWorld& world, uint32_t facet, const dvec3& point, const dvec3& other,
               uint32_t ignored_body) const;
  bool blocked_by(uint32_t body, const FacetWorld& world, uint32_t facet, const dvec3& point,
                  const dvec3& other, uint32_t ignored_body) const;

  std::vector<Shell> shells_;  ///< [bodies], in the body's frame
};

}  // namespace greatx::rf
