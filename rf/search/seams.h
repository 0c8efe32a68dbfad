// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Removes paths that exist only by roundings. The visibility test lets a segment end within a tolerance
// behind a surface. Along an edge where two facets meet, a strip of the facet behind therefore counts as lit.
// A search by beams knows that this strip is dark. A search by bounds alone (MovingSearch) does not, and uses
// this test in fp64.
#pragma once

#include <memory>
#include <vector>

#include "rf/facets/facet_world.h"
#include "rf/geometry/geometry.h"
#include "rf/search/beam_scene.h"

namespace greatx::rf {

class Seams {
 public:
  /// `fixed` holds the facets at rest, `moving` the facets of bodies at their present poses.
  Seams(std::shared_ptr<const BeamScene> fixed, BeamScene moving, uint32_t max_depth,
        uint32_t max_transmissions)
      : fixed_(std::move(fixed)),
        moving_(std::move(moving)),
        max_depth_(max_depth),
        max_transmissions_(max_transmissions) {}

  /// Removes reflected paths that are dark in a seam. Paths with other interactions stay. A leg passes a
  /// facet in a seam if this facet is crossed within `reach_m` before the leg's point of reflection and
  /// stands at an angle to the facet of the reflection. A path is removed if its legs pass an opaque facet in
  /// this way, or more walls than the path may pass. Legs run from the source. On the first leg, facets of
  /// `source_body`, which carries the source (0: none), do not count.
  void drop_behind(std::vector<GeometricPath>& paths, Source source, uint32_t source_body) const;

 private:
  static constexpr double reach_m = 5e-3;
  bool is_behind(const GeometricPath& path, Source source, uint32_t source_body) const;
  /// Returns the number of walls passed on the last millimetres from `other` to `point`. For an opaque facet
  /// it returns more than any path may pass.
  uint32_t passed(const BeamScene& scene, const dvec3& point, const dvec3& other, uint32_t facet,
                  uint32_t ignored_body) const;

  std::shared_ptr<const BeamScene> fixed_;
  BeamScene moving_;
  uint32_t max_depth_, max_transmissions_;
};

}  // namespace greatx::rf
