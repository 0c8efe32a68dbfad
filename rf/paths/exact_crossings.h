// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Decides in fp64 what lies on a segment, for the few segments that pass an edge so closely that the GPU's
// fp32 cannot tell. The facets are closed polygons in their planes, as the image method and the diffraction
// see them (FacetWorld), so that a path's geometry, its visibility and the side of a shadow boundary on which
// UTD places it agree to 1e-9 of the facet's extent.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/paths/segment.h"
#include "scene/description/box_tree.h"

namespace greatx::rf {

class ExactCrossings {
 public:
  ExactCrossings(const scene::Scene& scene, const FacetKinds& kinds);

  /// Sets Crossing::blocked and walls by the rules of CrossingPass. Foliage stays as it is. `world` has the
  /// bodies in the poses of the tick. Thread-safe.
  void settle(const FacetWorld& world, const Segment& segment, Crossing& crossing) const;

 private:
  struct Met {
    double t = 0.0;  ///< along the segment, 0 to 1
    uint32_t facet = 0;
  };
  static std::optional<Met> meets(const FacetWorld& world, const Segment& segment, uint32_t facet);
  static std::vector<uint32_t> walls_of(const FacetWorld& world, const Segment& segment,
                                        std::vector<Met>& met);

  FacetKinds kinds_;
  std::vector<uint32_t> fixed_, moving_;  ///< facets of walls and opaque ones, of body 0 and of the others
  scene::BoxTree boxes_;                  ///< of fixed_
};

}  // namespace greatx::rf
