// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/plane/cleaning.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "scene/place/plane/noding.h"

namespace greatx::scene::place {
namespace {

Edges ring(const std::vector<dvec2>& corners) {
  std::vector<Segment> segments;
  for (size_t i = 0; i < corners.size(); ++i)
    segments.push_back({corners[i], corners[(i + 1) % corners.size()]});
  return node(segments, 1.0 / grid_per_m);
}

size_t corners_of(const Edges& edges) {
  std::set<GridPoint> corners;
  for (const auto& edge : edges) corners.insert(edge.begin(), edge.end());
  return corners.size();
}

TEST(PlaceCleaning, CornersOnAStraightWallGo) {
  const Edges edges = cleaned(ring({{0, 0}, {5, 0.004}, {10, 0}, {10, 8}, {5, 7.9}, {0, 8}}), {0.02, 0.01});
  EXPECT_EQ(corners_of(edges), 5u);  // the one that bends the wall by 4 mm went, that by 10 cm stayed
}

TEST(PlaceCleaning, CornersThatNearlyCoincideBecomeOne) {
  std::vector<Segment> segments;
  for (const dvec2& shift : {dvec2(0.0), dvec2(0.012, -0.009)})
    for (int i = 0; i < 6; ++i)
      segments.push_back({dvec2(0.0), 10.0 * dvec2(std::cos(i), std::sin(i))}), segments.back()[0] += shift,
          segments.back()[1] += shift;
  const Edges edges = cleaned(node(segments, 1.0 / grid_per_m), {0.02, 0.0});
  EXPECT_EQ(corners_of(edges), 7u);
  EXPECT_EQ(edges.size(), 6u);
}

TEST(PlaceCleaning, NothingNearIsLeft) {
  for (uint32_t seed = 0; seed < 6; ++seed) {
    RandomStream random(seed, 4);
    std::vector<Segment> segments;
    for (int i = 0; i < 60; ++i) {
      const dvec2 a(random.uniform(-20, 20), random.uniform(-20, 20));
      segments.push_back({a, a + dvec2(random.uniform(-9, 9), random.uniform(-9, 9))});
      segments.push_back({a + dvec2(0.01, 0.004), segments.back()[1] + dvec2(-0.006, 0.012)});
    }
    const Edges edges = cleaned(node(segments, 1.0 / grid_per_m), {0.02, 0.01});
    std::set<GridPoint> corners;
    for (const auto& edge : edges) corners.insert(edge.begin(), edge.end());
    for (const GridPoint& p : corners)
      for (const auto& edge : edges) {
        if (p == edge[0] || p == edge[1]) continue;
        const dvec2 a = to_metres(edge[0]), along = to_metres(edge[1]) - a, q = to_metres(p) - a;
        const double t = std::clamp(glm::dot(q, along) / glm::dot(along, along), 0.0, 1.0);
        EXPECT_GT(glm::length(q - along * t), 0.0099) << "seed " << seed;
      }
    // Lines move by a few centimetres at most.
    std::vector<dvec2> ends;
    for (const Segment& segment : segments) ends.insert(ends.end(), segment.begin(), segment.end());
    EXPECT_LT(largest_distance(ends, edges, 1.0), 0.04);
  }
}

TEST(PlaceCleaning, AClosedRingStaysARing) {
  std::vector<dvec2> circle;
  for (int i = 0; i < 200; ++i)
    circle.push_back(5.0 * dvec2(std::cos(2 * pi * i / 200), std::sin(2 * pi * i / 200)));
  const Edges coarse = cleaned(ring(circle), {0.0, 0.1});
  EXPECT_GT(corners_of(coarse), 8u);
  EXPECT_LT(corners_of(coarse), 40u);
  EXPECT_EQ(coarse.size(), corners_of(coarse));
  EXPECT_LE(largest_distance(circle, coarse, 1.0), 0.1);
}

}  // namespace
}  // namespace greatx::scene::place
