// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/buildings/complex.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "scene/place/buildings/make_buildings.h"
#include "scene/place/buildings/roofs.h"

namespace greatx::scene::place {
namespace {

using Key = std::array<double, 3>;
Key key(const dvec3& p) { return {p.x, p.y, p.z}; }

/// The boundary of one building: its own faces, and those of neighbours that it shares.
std::vector<std::array<dvec3, 3>> boundary(const Complex& complex, uint32_t building) {
  std::vector<std::array<dvec3, 3>> result;
  const auto reversed = [](const std::array<dvec3, 3>& t) { return std::array{t[0], t[2], t[1]}; };
  for (const WallPiece& wall : complex.walls)
    for (const auto& t : triangles_of(wall)) {
      if (wall.building == building) result.push_back(t);
      if (wall.neighbour == building) result.push_back(reversed(t));
    }
  for (const FlatFace& face : complex.flats) {
    if (face.building == building) result.push_back(face.corners);
    if (face.neighbour == building) result.push_back(reversed(face.corners));
  }
  return result;
}

/// Checks that a boundary is closed: at each edge, as many triangles run one way as the other. Corners are
/// compared exactly. Returns the volume.
double closed_volume(const std::vector<std::array<dvec3, 3>>& triangles) {
  std::map<std::pair<Key, Key>, int> balance;
  double volume = 0.0;
  for (const auto& t : triangles) {
    EXPECT_GT(glm::length(glm::cross(t[1] - t[0], t[2] - t[0])), 0.0);
    for (size_t i = 0; i < 3; ++i) {
      ++balance[{key(t[i]), key(t[(i + 1) % 3])}];
      --balance[{key(t[(i + 1) % 3]), key(t[i])}];
    }
    volume +=
        glm::dot(t[0] - triangles[0][0], glm::cross(t[1] - triangles[0][0], t[2] - triangles[0][0])) / 6.0;
  }
  size_t open = 0;
  for (const auto& [edge, count] : balance) open += count != 0 ? 1 : 0;
  EXPECT_EQ(open, 0u);
  return volume;
}

Feature house(const std::string& id, const Ring& ring, std::map<std::string, std::string, std::less<>> tags) {
  Feature feature;
  feature.source = "test";
  feature.id = id;
  feature.polygons = {{ring, {}}};
  feature.tags = std::move(tags);
  feature.tags.emplace("building", "yes");
  return feature;
}
Ring box(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

struct Built {
  std::vector<Building> buildings;
  Complex complex;
  std::vector<Finding> findings;
  size_t count(const std::string& topic) const {
    size_t n = 0;
    for (const Finding& finding : findings) n += finding.topic == topic ? 1 : 0;
    return n;
  }
};

Built build(
    std::vector<Feature> features, const GroundAt& ground = [](const dvec2&) { return 0.0; }) {
  PlaceInput input;
  input.features = std::move(features);
  Built built;
  built.buildings = make_buildings(input, {}, ground, built.findings);
  built.complex = make_complex(built.buildings, {0.5}, built.findings);
  return built;
}

TEST(PlaceComplex, ABoxHasTwelveTrianglesAndItsVolume) {
  const Built built = build({house("a", box(0, 0, 10, 8), {{"height", "9.3"}})});
  EXPECT_EQ(built.complex.walls.size(), 4u);
  EXPECT_EQ(built.complex.flats.size(), 4u);
  EXPECT_NEAR(closed_volume(boundary(built.complex, 0)), 80.0 * 9.8, 1e-2);
  double top = 0.0;
  for (const FlatFace& face : built.complex.flats) top = std::max(top, face.corners[0].z);
  EXPECT_NEAR(top, 9.3, 1e-5);
}

TEST(PlaceComplex, ACourtIsOpenToTheSky) {
  Feature feature = house("a", box(0, 0, 30, 30), {{"height", "12"}});
  feature.polygons[0].holes = {box(10, 10, 20, 20)};
  const Built built = build({feature});
  EXPECT_NEAR(closed_volume(boundary(built.complex, 0)), (900.0 - 100.0) * 12.5, 1e-2);
  for (const FlatFace& face : built.complex.flats) {
    const dvec3 middle = (face.corners[0] + face.corners[1] + face.corners[2]) / 3.0;
    EXPECT_FALSE(middle.x > 10 && middle.x < 20 && middle.y > 10 && middle.y < 20);
  }
}

TEST(PlaceComplex, NeighboursHaveOnePartyWallAndBothAreClosed) {
  const Built built = build(
      {house("a", box(0, 0, 10, 10), {{"height", "9"}}), house("b", box(10, 2, 20, 12), {{"height", "15"}})});
  EXPECT_NEAR(closed_volume(boundary(built.complex, 0)), 100 * 9.5, 1e-2);
  EXPECT_NEAR(closed_volume(boundary(built.complex, 1)), 100 * 15.5, 1e-2);
  double party = 0.0, above = 0.0;
  for (const WallPiece& wall : built.complex.walls) {
    if (wall.from.x != to_grid(10.0) || wall.to.x != to_grid(10.0)) continue;
    const double size =
        std::abs(to_metres(wall.to.y - wall.from.y)) * (wall.from_z.back() - wall.from_z.front());
    if (wall.neighbour != no_building) {
      party += size;
      EXPECT_EQ(wall.building, 1u);  // the higher one
    } else if (wall.beside_neighbour) {
      above += size;
    }
  }
  EXPECT_NEAR(party, 8.0 * 9.5, 1e-2);
  EXPECT_NEAR(above, 8.0 * 6.0, 1e-2);
}

TEST(PlaceComplex, AGableCrossesItsNeighboursRoof) {
  // The gable of b rises from 5 m to 10 m beside the flat roof of a at 7 m: the wall changes sides twice.
  const Built built = build(
      {house("a", box(0, 0, 10, 10), {{"height", "7"}}),
       house("b", box(10, 0, 24, 10), {{"height", "10"}, {"roof:shape", "gabled"}, {"roof:height", "5"}})});
  EXPECT_NEAR(closed_volume(boundary(built.complex, 0)), 100 * 7.5, 1e-2);
  EXPECT_NEAR(closed_volume(boundary(built.complex, 1)), 140 * (5.5 + 2.5), 1e-1);
}

TEST(PlaceComplex, PartsStackAndBridge) {
  std::vector<Feature> features{house("a", box(0, 0, 20, 20), {{"height", "30"}})};
  const auto part = [&](const char* id, const Ring& ring, const char* low, const char* high) {
    Feature feature = house(id, ring, {{"building:part", "yes"}, {"height", high}});
    feature.tags.erase("building");
    if (*low) feature.tags["min_height"] = low;
    features.push_back(feature);
  };
  part("p1", box(0, 0, 20, 20), "", "10");
  part("p2", box(5, 5, 15, 15), "10", "30");
  part("p3", box(15, 8, 20, 12), "20", "25");  // hangs over the podium
  const Built built = build(features);
  ASSERT_EQ(built.buildings.size(), 1u);
  EXPECT_NEAR(closed_volume(boundary(built.complex, 0)), 400 * 10.5 + 100 * 20 + 20 * 5, 1e-1);
}

TEST(PlaceComplex, SpiresRiseFromTheirBottomAndRoofsEndAboveTheGround) {
  std::vector<Feature> features{house("a", box(0, 0, 6, 6), {{"height", "30"}})};
  Feature tower = house("t", box(0, 0, 6, 6), {{"building:part", "yes"}, {"height", "20"}});
  Feature spire = house("s", box(0, 0, 6, 6),
                        {{"building:part", "yes"},
                         {"min_height", "20"},
                         {"height", "30"},
                         {"roof:shape", "pyramidal"},
                         {"roof:height", "10"}});
  for (Feature* part : {&tower, &spire}) {
    part->tags.erase("building");
    features.push_back(*part);
  }
  features.push_back(
      house("b", box(20, 0, 30, 8), {{"height", "5"}, {"roof:shape", "gabled"}, {"roof:height", "5"}}));
  // An L whose walls are not quite straight: the planes of its wings go on below the eaves.
  features.push_back(
      house("c", {{40, 0}, {60, 0.2}, {60, 8}, {48.1, 8}, {48, 18}, {40.2, 18}},
            {{"height", "6"}, {"min_height", "3"}, {"roof:shape", "hipped"}, {"roof:height", "3"}}));
  const Built built = build(features);
  EXPECT_NEAR(closed_volume(boundary(built.complex, 0)), 36 * 20.5 + 36 * 10 / 3.0, 0.05);
  EXPECT_NEAR(closed_volume(boundary(built.complex, 1)), 80 * (0.5 + 0.1 + 4.9 / 2), 0.1);
  EXPECT_GT(closed_volume(boundary(built.complex, 2)), 100.0);
  EXPECT_EQ(built.count("roof_reaches_bottom"), 2u);
}

TEST(PlaceComplex, WhatPartsLeaveUncoveredIsBuiltAndReported) {
  std::vector<Feature> features{house("a", box(0, 0, 20, 20), {{"height", "30"}})};
  Feature tower = house("t", box(0, 0, 10, 10), {{"building:part", "yes"}, {"height", "30"}});
  tower.tags.erase("building");
  features.push_back(tower);
  const Built built = build(features);
  EXPECT_EQ(built.count("parts_leave_rest"), 1u);
  EXPECT_NEAR(closed_volume(boundary(built.complex, 0)), 400 * 30.5, 1e-1);
}

TEST(PlaceComplex, OverlapsAreReportedAndTheHigherOneStands) {
  const Built built = build(
      {house("a", box(0, 0, 10, 10), {{"height", "5"}}), house("b", box(8, 0, 18, 10), {{"height", "10"}}),
       house("c", box(30, 0, 40, 10), {{"height", "5"}}), house("d", box(30, 0, 40, 10), {{"height", "6"}})});
  EXPECT_EQ(built.count("buildings_overlap"), 2u);
  EXPECT_NEAR(closed_volume(boundary(built.complex, 0)), 80 * 5.5, 1e-2);
  EXPECT_NEAR(closed_volume(boundary(built.complex, 1)), 100 * 10.5, 1e-2);
  EXPECT_TRUE(boundary(built.complex, 2).empty());
}

TEST(PlaceComplex, WallsThatNearlyTouchBecomeOne) {
  // 1 cm apart, and 1 cm into each other; heights differ by 4 mm.
  const Built built = build({house("a", box(0, 0, 10, 10), {{"height", "9"}}),
                             house("b", box(10.01, 0, 20, 10), {{"height", "9.004"}}),
                             house("c", box(19.99, 3, 30, 7), {{"height", "12"}})});
  for (uint32_t i = 0; i < 3; ++i) closed_volume(boundary(built.complex, i));
  for (const WallPiece& wall : built.complex.walls) {
    EXPECT_GT(glm::distance(to_metres(wall.from), to_metres(wall.to)), 0.02);
    for (const auto* z : {&wall.from_z, &wall.to_z})
      for (size_t i = 0; i + 1 < z->size(); ++i) EXPECT_GE((*z)[i + 1] - (*z)[i], same_height_m);
  }
  EXPECT_LE(built.complex.most_welded_m, same_height_m);
}

TEST(PlaceComplex, OnASlopeFoundationsReachBelowTheGround) {
  const GroundAt ground = [](const dvec2& p) { return 0.2 * p.x; };
  const Built built = build(
      {house("a", box(0, 0, 10, 10), {{"height", "6"}}), house("b", box(10, 0, 20, 10), {{"height", "6"}}),
       house("c", box(20, 0, 30, 10), {{"height", "6"}})},
      ground);
  for (uint32_t i = 0; i < 3; ++i) {
    closed_volume(boundary(built.complex, i));
    EXPECT_NEAR(built.buildings[i].parts[0].top_z, 2.0 * i + 6.0, 1e-9);  // above the lowest ground
    EXPECT_LE(built.buildings[i].parts[0].bottom_z, 2.0 * i - 0.5);
  }
}

TEST(PlaceComplex, AnyRoofsOverAnyNeighboursAreClosed) {
  const char* const shapes[] = {"flat",    "skillion", "gabled",  "half-hipped", "hipped", "pyramidal",
                                "gambrel", "mansard",  "saltbox", "round",       "dome"};
  for (uint32_t seed = 0; seed < 20; ++seed) {
    RandomStream random(seed, 11);
    std::vector<Feature> features;
    const double turn = random.uniform(0.0, pi);
    const auto place = [&](double x, double y) {
      return dvec2(1234.5 + std::cos(turn) * x - std::sin(turn) * y,
                   -777.7 + std::sin(turn) * x + std::cos(turn) * y);
    };
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 3; ++j) {
        const double x = 12.0 * i, y = 9.0 * j, w = 12.0, h = 9.0;
        Ring ring{place(x, y), place(x + w, y), place(x + w, y + h), place(x, y + h)};
        if (random.below(3) == 0)  // an L
          ring = {place(x, y),
                  place(x + w, y),
                  place(x + w, y + 0.5 * h),
                  place(x + 0.6 * w, y + 0.5 * h),
                  place(x + 0.6 * w, y + h),
                  place(x, y + h)};
        if (random.below(5) == 0)  // askew, over its neighbours
          ring = {place(x - 1, y), place(x + w, y + 1), place(x + w + 2, y + h), place(x, y + h - 2)};
        features.push_back(house(std::to_string(10 * i + j), ring,
                                 {{"height", std::to_string(random.uniform(5, 14))},
                                  {"roof:shape", shapes[random.below(11)]},
                                  {"roof:height", std::to_string(random.uniform(1, 4))}}));
      }
    const Built built = build(features);
    for (uint32_t i = 0; i < built.buildings.size(); ++i)
      if (const auto faces = boundary(built.complex, i); !faces.empty()) {
        EXPECT_GT(closed_volume(faces), 0.0) << "seed " << seed << " building " << i;
      }
  }
}

}  // namespace
}  // namespace greatx::scene::place
