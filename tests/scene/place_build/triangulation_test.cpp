// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/plane/triangulation.h"

#include <set>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "scene/place/plane/noding.h"

namespace greatx::scene::place {
namespace {

/// Checks links, areas, and that every edge that is not forced is Delaunay.
void expect_sound(const Triangulation& t) {
  const auto& points = t.points();
  int64_t twice = 0;
  for (uint32_t i = 0; i < t.triangles().size(); ++i) {
    const auto& triangle = t.triangles()[i];
    const auto& c = triangle.corners;
    const int64_t own = orientation(points[c[0]], points[c[1]], points[c[2]]);
    ASSERT_GT(own, 0) << "triangle " << i;
    twice += own;
    for (uint32_t side = 0; side < 3; ++side) {
      const uint32_t other = triangle.across[side];
      if (other == Triangulation::none) {
        ASSERT_TRUE(triangle.fixed[side]);
        continue;
      }
      const auto& far = t.triangles()[other];
      uint32_t back = 3;
      for (uint32_t k = 0; k < 3; ++k)
        if (far.across[k] == i && far.corners[(k + 1) % 3] == c[(side + 2) % 3]) back = k;
      ASSERT_LT(back, 3u);
      ASSERT_EQ(far.corners[(back + 2) % 3], c[(side + 1) % 3]);
      ASSERT_EQ(far.fixed[back], triangle.fixed[side]);
      const bool breaks = in_circle(points[c[0]], points[c[1]], points[c[2]], points[far.corners[back]]);
      ASSERT_TRUE(triangle.fixed[side] || !breaks);
    }
  }
  EXPECT_EQ(twice,
            orientation(points[0], points[1], points[2]) + orientation(points[0], points[2], points[3]));
}

TEST(PlaceTriangulation, PointsAtRandomAreDelaunay) {
  Triangulation t({0, 0}, {1 << 20, 1 << 20});
  RandomStream random(1, 7);
  for (int i = 0; i < 2000; ++i) {
    t.add({random.below(1 << 20), random.below(1 << 20)});
  }
  expect_sound(t);
}

TEST(PlaceTriangulation, PointsOnAGridAndOnEdgesAreFoundAgain) {
  // Many points are on lines and circles with others, the worst case for predicates.
  Triangulation t({0, 0}, {1024, 1024});
  for (int64_t y = 0; y <= 1024; y += 64)
    for (int64_t x = 0; x <= 1024; x += 64) {
      const uint32_t index = t.add({x, y});
      EXPECT_EQ(t.add({x, y}), index);
    }
  EXPECT_EQ(t.points().size(), 17u * 17u);
  EXPECT_EQ(t.triangles().size(), 2u * 16u * 16u);
  expect_sound(t);
}

TEST(PlaceTriangulation, ForcedEdgesAreThereAndPassThroughPointsOnThem) {
  Triangulation t({-8, -8}, {1032, 1032});
  for (int64_t i = 0; i <= 16; ++i)
    for (int64_t j = 0; j <= 16; ++j) t.add({64 * i, 64 * j});
  // The diagonal passes 15 points; the other line passes none.
  t.force(t.add({0, 0}), t.add({1024, 1024}));
  t.force(t.add({0, 512}), t.add({448, 576}));
  std::set<std::pair<GridPoint, GridPoint>> forced;
  for (const auto& triangle : t.triangles())
    for (uint32_t side = 0; side < 3; ++side)
      if (triangle.fixed[side])
        forced.emplace(t.points()[triangle.corners[(side + 1) % 3]],
                       t.points()[triangle.corners[(side + 2) % 3]]);
  for (int64_t i = 0; i < 16; ++i)
    EXPECT_EQ(forced.count({{64 * i, 64 * i}, {64 * i + 64, 64 * i + 64}}), 1u) << i;
  expect_sound(t);
}

TEST(PlaceTriangulation, AForcedEdgeIsDividedWhereAPlaceOnItWasRoundedTo) {
  for (uint32_t seed = 0; seed < 6; ++seed) {
    Triangulation t({0, 0}, {1 << 20, 1 << 20});
    RandomStream random(seed, 11);
    for (int i = 0; i < 100; ++i) t.add({random.below(1 << 20), random.below(1 << 20)});
    const GridPoint from{1000 + seed, 3001}, to{900'003, 700'007 + 13 * seed};
    t.force(t.add(from), t.add(to));
    size_t divided = 0, bent = 0;
    for (uint32_t i = 0; i < t.triangles().size() && divided < 40; ++i)
      for (uint32_t side = 0; side < 3; ++side) {
        const auto triangle = t.triangles()[i];
        if (!triangle.fixed[side] || triangle.across[side] == Triangulation::none) continue;
        const GridPoint a = t.points()[triangle.corners[(side + 1) % 3]],
                        b = t.points()[triangle.corners[(side + 2) % 3]];
        const GridPoint middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
        const auto index = t.divide(i, side, middle);
        if (!index) continue;
        EXPECT_EQ(t.points()[*index], middle);
        bent += orientation(from, to, middle) != 0 ? 1 : 0;
        ++divided;
        break;
      }
    EXPECT_GE(divided, 20u);
    EXPECT_GE(bent, 10u);
    expect_sound(t);
    size_t forced = 0;
    for (const auto& triangle : t.triangles())
      for (uint32_t side = 0; side < 3; ++side)
        if (triangle.fixed[side] && triangle.across[side] != Triangulation::none) ++forced;
    EXPECT_EQ(forced, 2 * (divided + 1));
  }
}

TEST(PlaceTriangulation, CrossingForcedEdgesAreRefused) {
  Triangulation t({0, 0}, {100, 100});
  t.force(t.add({10, 10}), t.add({90, 90}));
  EXPECT_THROW(t.force(t.add({10, 90}), t.add({90, 10})), UserError);
}

TEST(PlaceTriangulation, ExtentsBeyondTheLimitAreRefused) {
  EXPECT_THROW(Triangulation({0, 0}, {to_grid(most_extent_m) + 1, 10}), UserError);
  EXPECT_THROW(Triangulation({0, 0}, {0, 10}), UserError);
}

TEST(PlaceNoding, SegmentsAtRandomBecomeAFullTriangulation) {
  for (uint32_t seed = 0; seed < 8; ++seed) {
    RandomStream random(seed, 3);
    std::vector<Segment> segments;
    for (int i = 0; i < 60; ++i)
      segments.push_back({dvec2(random.uniform(-50, 50), random.uniform(-50, 50)),
                          dvec2(random.uniform(-50, 50), random.uniform(-50, 50))});
    const auto edges = node(segments, 1.0 / grid_per_m);
    const Triangulation t = triangulate_noded(to_grid(dvec2(-60)), to_grid(dvec2(60)), edges);
    expect_sound(t);
    size_t forced = 0;
    for (const auto& triangle : t.triangles())
      for (uint32_t side = 0; side < 3; ++side) forced += triangle.fixed[side] ? 1 : 0;
    EXPECT_EQ(forced, 2 * edges.size() + 4);  // each inner edge twice, the rectangle's sides once
  }
}

TEST(PlaceNoding, OrderOfSegmentsDoesNotMatter) {
  RandomStream random(5, 3);
  std::vector<Segment> segments;
  for (int i = 0; i < 40; ++i)
    segments.push_back({dvec2(random.uniform(0, 9), random.uniform(0, 9)),
                        dvec2(random.uniform(0, 9), random.uniform(0, 9))});
  std::vector<Segment> reversed(segments.rbegin(), segments.rend());
  for (Segment& segment : reversed) std::swap(segment[0], segment[1]);
  EXPECT_EQ(node(segments, 1.0 / grid_per_m), node(reversed, 1.0 / grid_per_m));
}

TEST(PlaceNoding, RegionsAreTheFacesBetweenEdges) {
  // Two squares that share a side, one of them with a square hole.
  const auto box = [](double x0, double y0, double x1, double y1, std::vector<Segment>& out) {
    const dvec2 a(x0, y0), b(x1, y0), c(x1, y1), d(x0, y1);
    for (const Segment& s : {Segment{a, b}, Segment{b, c}, Segment{c, d}, Segment{d, a}}) out.push_back(s);
  };
  std::vector<Segment> segments;
  box(0, 0, 10, 10, segments);
  box(10, 0, 20, 10, segments);
  box(3, 3, 6, 6, segments);
  const Triangulation t =
      triangulate_noded(to_grid(dvec2(-1)), to_grid(dvec2(21, 11)), node(segments, 1.0 / grid_per_m));
  uint32_t count = 0;
  t.regions(&count);
  EXPECT_EQ(count, 4u);  // outside, left, hole, right
}

}  // namespace
}  // namespace greatx::scene::place
