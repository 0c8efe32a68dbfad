// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/ground/terrain.h"

#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "core/random.h"
#include "scene/place/ground/bridges.h"

namespace greatx::scene::place {
namespace {

/// A grid turned by 7 degrees about the origin, as those of projected coordinates are.
HeightGrid grid(uint32_t columns, uint32_t rows, double step,
                const std::function<double(const dvec2&)>& height, const dvec2& shift = dvec2(0.0)) {
  HeightGrid out;
  out.columns = columns;
  out.rows = rows;
  const double c = std::cos(0.12), s = std::sin(0.12);
  for (uint32_t y = 0; y < rows; ++y)
    for (uint32_t x = 0; x < columns; ++x) {
      const dvec2 q((x - 0.5 * columns) * step, (0.5 * rows - y) * step);
      const dvec2 p = dvec2(c * q.x - s * q.y, s * q.x + c * q.y) + shift;
      out.samples.emplace_back(p, height(p));
    }
  return out;
}

double hills(const dvec2& p) { return 6.0 * std::sin(p.x / 25.0) * std::cos(p.y / 31.0) + 0.05 * p.x; }

TerrainMesh build(const HeightField& field, double error, std::vector<GroundArea> areas = {}) {
  const GroundLevel level(field);
  return make_terrain(field, level, areas, {{dvec2(-100.0), dvec2(100.0)}, error});
}

TEST(PlaceTerrain, IsWithinItsBoundAtEverySample) {
  HeightField field;
  field.add(grid(140, 140, 2.0, hills));
  size_t before = SIZE_MAX;
  for (const double bound : {0.05, 0.25, 1.0}) {
    const TerrainMesh mesh = build(field, bound);
    double worst = 0.0;
    size_t samples = 0;
    for (const dvec3& sample : field.grids()[0].samples)
      if (std::abs(sample.x) <= 100.0 && std::abs(sample.y) <= 100.0) {
        worst = std::max(worst, std::abs(mesh.height_at(dvec2(sample)) - sample.z));
        ++samples;
      }
    EXPECT_LE(worst, bound + 1e-4);
    EXPECT_NEAR(worst, mesh.largest_error_m, 1e-4);
    EXPECT_EQ(samples, mesh.samples);
    EXPECT_LT(mesh.plan.triangles().size(), before);  // a larger bound takes fewer triangles
    before = mesh.plan.triangles().size();
  }
  EXPECT_LT(before, 800u);
}

TEST(PlaceTerrain, AreasHaveTheirSizesAndCoverEachOtherByRank) {
  HeightField field;
  field.add(grid(140, 140, 2.0, hills));
  const Polygon park{{{-80, -80}, {80, -80}, {80, 80}, {-80, 80}}, {}},
      road{{{-100, -4}, {100, -4}, {100, 4}, {-100, 4}}, {}},
      lake{{{20, 20}, {50, 20}, {50, 50}, {20, 50}}, {{{30, 30}, {40, 30}, {40, 40}, {30, 40}}}};
  const std::vector<GroundArea> areas{{Cover::grass, {park}, box_of(park)},
                                      {Cover::road, {road}, box_of(road)},
                                      {Cover::water, {lake}, box_of(lake)}};
  const TerrainMesh mesh = build(field, 0.25, areas);
  std::map<Cover, double> sizes;
  for (uint32_t t = 0; t < mesh.covers.size(); ++t) {
    const auto& c = mesh.plan.triangles()[t].corners;
    const dvec2 a(mesh.point(c[0])), b = dvec2(mesh.point(c[1])) - a, d = dvec2(mesh.point(c[2])) - a;
    sizes[mesh.covers[t]] += 0.5 * (b.x * d.y - b.y * d.x);
  }
  EXPECT_NEAR(sizes[Cover::road], 1600.0, 0.1);
  EXPECT_NEAR(sizes[Cover::water], 800.0, 0.1);
  EXPECT_NEAR(sizes[Cover::grass], 160.0 * 160.0 - 160.0 * 8.0 - 800.0, 0.2);
  EXPECT_NEAR(sizes[Cover::base] + sizes[Cover::road] + sizes[Cover::water] + sizes[Cover::grass], 40000.0,
              1e-3);
}

TEST(PlaceTerrain, BordersFollowTheTerrainBetweenItsSamples) {
  // A bank of 4 m between two rows of samples, along which a border runs, and borders at odd angles.
  HeightField field;
  field.add(grid(140, 140, 2.0, [](const dvec2& p) {
    return 4.0 * std::tanh((p.y - 0.12 * p.x) / 3.0) * std::sin(p.x / 20.0) + 0.02 * p.x;
  }));
  const Polygon along{{{-90, -11}, {90, 10.7}, {90, 60}, {-90, 55}}, {}};
  const Polygon road{{{-100, -40}, {100, 31}, {100, 37}, {-100, -34}}, {}};
  for (const double bound : {0.1, 0.25}) {
    const TerrainMesh mesh =
        build(field, bound, {{Cover::meadow, {along}, box_of(along)}, {Cover::road, {road}, box_of(road)}});
    EXPECT_LE(mesh.largest_error_m, bound + 1e-4);
    size_t places = 0;
    for (const Polygon& polygon : {along, road})
      for (size_t i = 0; i < polygon.outer.size(); ++i) {
        const dvec2 a = polygon.outer[i], b = polygon.outer[(i + 1) % polygon.outer.size()];
        const int steps = static_cast<int>(glm::distance(a, b));
        for (int k = 0; k <= steps; ++k) {
          const dvec2 p = glm::mix(a, b, static_cast<double>(k) / steps);
          // Corners of borders may move by simplify_m, 0.05 m, on slopes of up to 1.4.
          EXPECT_NEAR(mesh.height_at(p), *field.at(p), bound + 0.1) << p.x << " " << p.y;
          ++places;
        }
      }
    EXPECT_GT(places, 800u);
    for (const auto& triangle : mesh.plan.triangles()) {
      const auto& c = triangle.corners;
      const dvec3 n = glm::normalize(
          glm::cross(mesh.point(c[1]) - mesh.point(c[0]), mesh.point(c[2]) - mesh.point(c[0])));
      ASSERT_GT(n.z, 0.3);  // no triangle stands upright at a border
    }
  }
}

TEST(PlaceTerrain, HasNoCracks) {
  HeightField field;
  field.add(grid(140, 140, 2.0, hills));
  const Polygon road{{{-100, -40}, {100, 31}, {100, 37}, {-100, -34}}, {}};
  const TerrainMesh mesh = build(field, 0.1, {{Cover::road, {road}, box_of(road)}});
  size_t open = 0;
  for (const auto& triangle : mesh.plan.triangles())
    for (uint32_t side = 0; side < 3; ++side) {
      if (triangle.across[side] != Triangulation::none) continue;
      ++open;  // on the rectangle's border
      const dvec3 a = mesh.point(triangle.corners[(side + 1) % 3]),
                  b = mesh.point(triangle.corners[(side + 2) % 3]);
      EXPECT_TRUE((a.x == b.x && std::abs(a.x) == 100.0) || (a.y == b.y && std::abs(a.y) == 100.0));
    }
  EXPECT_GT(open, 3u);
}

TEST(PlaceTerrain, OverlappingTilesAndVoidsAreTaken) {
  HeightField field;
  HeightGrid west = grid(80, 120, 2.0, hills, {-60.0, 0.0});
  for (size_t i = 0; i < west.samples.size(); i += 7)
    west.samples[i].z = std::numeric_limits<double>::quiet_NaN();
  field.add(west);
  // The second tile disagrees by 3 m where both have data: there the first one counts.
  field.add(grid(100, 120, 2.0, [](const dvec2& p) { return hills(p) + 3.0; }, {60.0, 0.0}));
  const TerrainMesh mesh = build(field, 0.25);
  EXPECT_LE(mesh.largest_error_m, 0.25 + 1e-4);
  EXPECT_NEAR(mesh.height_at({-90.0, 0.0}), hills({-90.0, 0.0}), 0.6);
  EXPECT_NEAR(mesh.height_at({90.0, 0.0}), hills({90.0, 0.0}) + 3.0, 0.6);
}

TEST(PlaceTerrain, WithoutATerrainTheGroundIsLevel) {
  const TerrainMesh mesh = build(HeightField(), 0.25);
  EXPECT_EQ(mesh.plan.triangles().size(), 2u);
  EXPECT_EQ(mesh.samples, 0u);
  EXPECT_EQ(mesh.height_at({3.0, 4.0}), 0.0);
}

TEST(PlaceTerrain, BridgesClearWhatLiesBelow) {
  const HeightField none;
  const GroundLevel level(none);
  const Bridge flat{"s", "1", Cover::road, {{0, 0}, {200, 0}}, 8.0, 1};
  const Deck deck = make_deck(flat, level);
  EXPECT_NEAR(deck.lift_m, 5.0, 1e-9);
  double highest = 0.0;
  for (const Deck::Section& section : deck.sections) {
    highest = std::max(highest, section.z);
    EXPECT_NEAR(glm::distance(section.left, section.right), 8.0, 1e-9);
  }
  EXPECT_NEAR(highest, 5.05, 1e-9);
  EXPECT_NEAR(deck.sections.front().z, 0.05, 1e-9);
  HeightField valley;
  valley.add(grid(200, 200, 2.0, [](const dvec2& p) { return 0.1 * std::abs(p.x); }));
  const GroundLevel slopes(valley);
  const Deck over = make_deck({"s", "2", Cover::road, {{-90, 0}, {90, 0}}, 8.0, 1}, slopes);
  EXPECT_EQ(over.lift_m, 0.0);  // 9 m above the bottom of the valley
}

}  // namespace
}  // namespace greatx::scene::place
