// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds sequences of facets under test by the reference: images, bounds, reflection points, passed walls.
// exhaustive_paths.h states the rules.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/geometry/path.h"
#include "rf/reference/box_tree.h"
#include "rf/reference/occluders.h"
#include "rf/reference/pyramid.h"
#include "scene/description/scene.h"
#include "scene/description/wedges.h"

namespace greatx::rf::reference {

/// Holds a sequence of facets, with the image of its beginning in each.
struct Chain {
  std::vector<uint32_t> facets;
  std::vector<double> sides;  ///< [facets] +1 if the paths are on the side of the facet's normal, else -1
  std::vector<dvec3> images;  ///< [facets + 1]: the beginning, then its images
};

/// Holds the facets of a scene at their present poses.
class Chains {
 public:
  Chains(const scene::Scene& scene, const FacetWorld& world, std::span<const Pose> body_poses,
         const FacetKinds& kinds);

  /// Extends the chain by a facet. Returns false if the sides alone show that no path has this facet next.
  bool push(Chain& chain, uint32_t facet) const;
  static void pop(Chain& chain);
  /// Sets `half_spaces` to half-spaces that hold everything the chain's last image sees through its facet,
  /// after the facets before. `before` are those of the chain without the last facet.
  void view(const Chain& chain, const std::vector<HalfSpace>& before,
            std::vector<HalfSpace>& half_spaces) const;
  /// Calls visit(facet) for the facets that may come next, within the half-spaces.
  template <typename Visit>
  void next(const std::vector<HalfSpace>& half_spaces, const Visit& visit) const {
    tree_.within(half_spaces, [&](uint32_t item) {
      if (may_meet(hulls_[facets_[item]], half_spaces)) visit(facets_[item]);
    });
  }
  /// Returns the facets that can reflect.
  std::span<const uint32_t> facets() const { return facets_; }
  const FacetWorld& world() const { return world_; }

  /// Sets `points` to the beginning, the reflection points of the chain on the way to `end`, and `end`.
  /// Returns false if there are none. The end is mirrored from the last facet to the first, and the lines to
  /// its images are intersected from the beginning on, in the opposite direction to the enumeration.
  bool reflect(const Chain& chain, const dvec3& end, std::vector<dvec3>& points) const;

  /// Holds what a path may pass and what carries its ends.
  struct Limits {
    uint32_t max_depth = 0, max_transmissions = 0;
    uint32_t transmitter_body = 0, receiver_body = 0;
  };
  /// Turns passed walls into interactions of the path. Returns false if the path is blocked. `wedges` are
  /// those that diffractions of the path name; their faces do not block it there.
  bool pass_walls(GeometricPath& path, const Limits& limits, std::span<const scene::Wedge> wedges = {}) const;

 private:
  const FacetWorld& world_;
  Occluders occluders_;
  std::vector<Hull> hulls_;  ///< [facets of the scene]; without corners if the facet cannot reflect
  std::vector<uint32_t> facets_;
  BoxTree tree_{{}};  ///< over facets_
};

}  // namespace greatx::rf::reference
