// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Which triangles of a facet may a part of a tube fall on? Facets of many triangles (ground) have a tree of boxes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/facet_world.h"
#include "scene/scene.h"

namespace greatx::rf {

/// normal . x + offset >= 0.
struct KeptSide {
  dvec3 normal{0.0};
  double offset = 0.0;
};

class FacetTrees {
 public:
  explicit FacetTrees(const scene::Scene& scene);
  /// Indices of triangles, ascending, below the facet's triangle_count, whose boxes are not wholly outside of one of the
  /// half-spaces (local coordinates).
  void find(const FacetWorld& world, uint32_t facet, std::span<const KeptSide> spaces,
            std::vector<uint32_t>& triangles) const;

 private:
  static constexpr uint32_t no_tree = ~0u, leaf_size = 4, small_facet = 8;
  struct Node {
    dvec3 center{0.0}, half{0.0};  ///< in the body's frame
    uint32_t first = 0,
             count = 0;  ///< of order_, relative to the facet; an inner node has its children at `left`
    uint32_t left = 0;
  };
  void split(uint32_t node, const scene::Scene& scene, const scene::Facet& facet);

  std::vector<uint32_t> root_;  ///< [facets]
  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;
};

}  // namespace greatx::rf
