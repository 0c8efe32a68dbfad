// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the search for what hides one facet against the search for all facets that a beam sees.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "core/random.h"
#include "rf/radar/echoes/visible_cells.h"
#include "tests/support/tiny_scene.h"

namespace greatx::rf {
namespace {

/// Returns whether two polygons have the same corners to the bit.
bool same(const Polygon& a, const Polygon& b) {
  if (a.size() != b.size()) return false;
  for (uint32_t i = 0; i < a.size(); ++i)
    if (std::memcmp(&a[i], &b[i], sizeof a[i]) != 0) return false;
  return true;
}

/// Plates in a small room hide each other in part or wholly, and pass through each other.
TEST(VisibleCells, WhatIsNotHiddenIsThatOfTheSearchForAll) {
  RandomStream random(11, 0);
  size_t whole = 0, cut = 0, hidden = 0;
  for (int round = 0; round < 12; ++round) {
    const auto anywhere = [&](double reach) {
      return reach * (2.0 * dvec3(random.uniform(), random.uniform(), random.uniform()) - 1.0);
    };
    test::TinyScene tiny;
    for (int i = 0; i < 60; ++i) {
      const dvec3 at = anywhere(4.0), a = anywhere(1.5), b = anywhere(1.5);
      i % 2 == 0 ? tiny.quad(at, at + a, at + a + b, at + b) : tiny.triangle(at, at + a, at + b);
    }
    const scene::Scene scene = tiny.build();
    const FacetWorld world(scene);
    const FacetTrees trees(scene);
    std::vector<FacetPiece> pieces;
    for (uint32_t facet = 0; facet < scene.facets.size(); ++facet)
      for (const uint32_t piece : trees.pieces(facet)) pieces.push_back({facet, piece});
    VisibleScratch scratch;
    for (uint32_t own = 0; own < scene.facets.size(); ++own) {
      const dvec3 source = dvec3(12.0, 0.0, 0.0) + anywhere(3.0);
      const TubeBeam beam(source, glm::normalize(world.facet(own).centroid - source));
      std::vector<dvec2> corners;
      for (const dvec3& corner : trees.corners(*trees.pieces(own).begin()))
        corners.push_back(beam.uv(corner));
      const Polygon outline(corners);
      if (!(outline.area() > 0.0)) continue;
      const double smallest = 1e-9 * outline.area();
      std::vector<VisibleCell> cells;
      find_visible(world, trees, beam, {}, outline, own, pieces, smallest, scratch, cells);
      std::erase_if(cells, [&](const VisibleCell& cell) { return cell.facet != own; });
      std::vector<Polygon> parts;
      find_unhidden(world, trees, beam, {}, outline, own, pieces, smallest, scratch, parts);
      ASSERT_EQ(parts.size(), cells.size()) << round << ", " << own;
      double area = 0.0;
      for (size_t i = 0; i < parts.size(); ++i) {
        EXPECT_TRUE(same(parts[i], cells[i].part)) << round << ", " << own << ", " << i;
        area += parts[i].area();
      }
      ++(parts.empty() ? hidden : area > (1.0 - 1e-9) * outline.area() ? whole : cut);
    }
  }
  EXPECT_GT(whole, 20u);
  EXPECT_GT(cut, 100u);
  EXPECT_GT(hidden, 5u);
}

}  // namespace
}  // namespace greatx::rf
