// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paths that only roundings make. The visibility test lets a segment end a tolerance behind a surface, so
// along an edge where two facets meet, a strip of the one behind counts as lit. A search by beams knows that
// it is dark; a search by bounds alone (MovingSearch) does not, and asks here, in fp64.
#pragma once

#include <memory>
#include <vector>

#include "rf/facets/facet_world.h"
#include "rf/geometry/geometry.h"
#include "rf/search/beam_scene.h"

namespace greatx::rf {

class Seams {
 public:
  /// Facets at rest, and those of bodies where they stand now.
  Seams(std::shared_ptr<const BeamScene> fixed, BeamScene moving, uint32_t max_depth,
        uint32_t max_transmissions)
      : fixed_(std::move(fixed)),
        moving_(std::move(moving)),
        max_depth_(max_depth),
        max_transmissions_(max_transmissions) {}

  /// Removes paths of reflections alone one of whose legs passes, within `reach_m` before its point of
  /// reflection, a facet that stands at an angle to the one it is reflected at: an opaque one, or more walls
  /// than the path may have. Legs run from the source; not facets of `source_body`, which carries it (0:
  /// none), on the first one.
  void drop_behind(std::vector<GeometricPath>& paths, Source source, uint32_t source_body) const;

 private:
  static constexpr double reach_m = 5e-3;
  bool is_behind(const GeometricPath& path, Source source, uint32_t source_body) const;
  /// Walls passed on the last millimetres from `other` to `point`; opaque: more than any path may pass.
  uint32_t passed(const BeamScene& scene, const dvec3& point, const dvec3& other, uint32_t facet,
                  uint32_t ignored_body) const;

  std::shared_ptr<const BeamScene> fixed_;
  BeamScene moving_;
  uint32_t max_depth_, max_transmissions_;
};

}  // namespace greatx::rf
