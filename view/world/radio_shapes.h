// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Facets and wedges: the surfaces and edges that radio paths are computed with, as lines in the world.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "view/overlay/shapes.h"
#include "view/world/radio_facts.h"

namespace greatx::view {

enum class FacetColors { kind, material };

struct RadioShapeOptions {
  bool facets = true, wedges = true;
  FacetColors colors = FacetColors::kind;
  size_t most_facets = 1'000, most_wedges = 1'000;  ///< the nearest; the legend says how many there are
  double within_m = 1e6;                            ///< of the middle of the view
};

/// The outlines of all facets in their bodies' frames. An edge that two triangles of a facet share, corner to
/// corner, is inside it and left out.
class FacetOutlines {
 public:
  explicit FacetOutlines(const scene::Scene& scene);
  using Edge = std::array<dvec3, 2>;
  std::span<const Edge> of(uint32_t facet) const {
    return std::span(edges_).subspan(first_[facet], first_[facet + 1] - first_[facet]);
  }
  const scene::Bounds& bounds(uint32_t facet) const { return bounds_[facet]; }

 private:
  std::vector<Edge> edges_;
  std::vector<size_t> first_;          ///< [facets + 1]
  std::vector<scene::Bounds> bounds_;  ///< [facets] in the body's frame
};

/// The facets and wedges whose boxes are nearest to `focus` (world), at the poses `bodies` (local
/// coordinates). Facets are coloured by kind or material, wedges by their exterior angle. The row of a facet
/// says its number, object, material with permittivity, conductivity and thickness, and kind; that of a wedge
/// its number, length, exterior angle and faces. Facets that have no effect are left out and counted.
Shapes radio_shapes(const RadioFacts& facts, const FacetOutlines& outlines, std::span<const Pose> bodies,
                    const dvec3& focus, const RadioShapeOptions& options);

}  // namespace greatx::view
