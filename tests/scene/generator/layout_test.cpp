// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the layout of scenes: sizes, heights, free space, and the names on which other parts rely.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "scene/generator/city/city_plan.h"
#include "scene/generator/mesh/mesh_builder.h"
#include "tests/scene/generator/soup.h"

namespace greatx::scene {
namespace {

std::map<std::string, Bounds> bounds_of_instances(const Soup& soup) {
  std::map<std::string, Bounds> bounds;
  for (const SoupTriangle& t : soup.triangles)
    for (const dvec3& corner : t.corners) bounds[soup.model.instances[t.instance].name].add(corner);
  return bounds;
}

Bounds bounds_of(const Soup& soup) {
  Bounds all;
  for (const auto& [name, bounds] : bounds_of_instances(soup)) all.add(bounds);
  return all;
}

/// Returns the height of the highest of these triangles over (x, y), or -1e9 if there is none.
double height_over(const std::vector<SoupTriangle>& triangles, const dvec2& p) {
  double best = -1e9;
  for (const SoupTriangle& t : triangles) {
    const dvec2 a(t.corners[0]), b(t.corners[1]), c(t.corners[2]);
    const auto cross = [](const dvec2& u, const dvec2& v) { return u.x * v.y - u.y * v.x; };
    const double area = cross(b - a, c - a);
    if (area <= 1e-12) continue;
    const double u = cross(p - a, c - a) / area, v = cross(b - a, p - a) / area;
    if (u < 0 || v < 0 || u + v > 1) continue;
    best = std::max(
        best, t.corners[0].z + u * (t.corners[1].z - t.corners[0].z) + v * (t.corners[2].z - t.corners[0].z));
  }
  return best;
}

TEST(City, FillsItsSquareAndStandsOnZero) {
  for (const double size : {100.0, 300.0, 517.0}) {
    const Bounds b = bounds_of(load_soup({.kind = "city", .seed = 2, .size_m = size}));
    EXPECT_NEAR(b.min.x, -size / 2, 1e-3);
    EXPECT_NEAR(b.max.x, size / 2, 1e-3);
    EXPECT_NEAR(b.min.y, -size / 2, 1e-3);
    EXPECT_NEAR(b.max.y, size / 2, 1e-3);
    EXPECT_EQ(b.min.z, -1.0);
  }
}

TEST(City, HasAllThatACityNeeds) {
  const Soup soup = load_soup({.kind = "city", .seed = 1, .size_m = 300});
  std::map<SemanticClass, int> count;
  for (const ModelInstance& i : soup.model.instances) ++count[i.semantic_class];
  EXPECT_GE(count[SemanticClass::building], 40);
  EXPECT_GE(count[SemanticClass::vegetation], 30);
  EXPECT_GE(count[SemanticClass::street_lamp], 15);
  EXPECT_GE(count[SemanticClass::vehicle], 5);
  EXPECT_EQ(count[SemanticClass::road], 1);
  EXPECT_EQ(count[SemanticClass::lane_marking], 1);
  EXPECT_EQ(static_cast<size_t>(count[SemanticClass::street_lamp]), soup.model.lights.size());
  // Façades of all four families occur over a few seeds.
  std::map<std::string, int> families;
  for (const uint64_t seed : {1u, 2u, 3u})
    for (const Material& m : load_soup({.kind = "city", .seed = seed, .size_m = 300}).model.materials)
      for (const char* family : {"facade_glass", "facade_concrete", "facade_brick", "facade_metal"})
        if (m.name.starts_with(family)) ++families[family];
  EXPECT_EQ(families.size(), 4u);
}

TEST(City, BuildingsAre8To45MetresHighAndApart) {
  for (const uint64_t seed : {1u, 2u, 3u, 4u}) {
    const Soup soup = load_soup({.kind = "city", .seed = seed, .size_m = 300});
    const std::vector<SoupTriangle> roads = soup.of_class(SemanticClass::road);
    for (const auto& [name, bounds] : bounds_of_instances(soup)) {
      if (!name.starts_with("building_")) continue;
      EXPECT_GE(bounds.max.z - 0.15, 7.0) << name;
      EXPECT_LE(bounds.max.z - 0.15, 46.0) << name << " with what stands on the roof";
    }
    // No building's wall foot is over a street.
    for (const SoupTriangle& t : soup.of_class(SemanticClass::building))
      ASSERT_LT(height_over(roads, dvec2(t.corners[0])), -1e8) << soup.model.instances[t.instance].name;
  }
}

TEST(City, CenterIsACrossingOpenToTheSky) {
  for (const uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const Soup soup = load_soup({.kind = "city", .seed = seed, .size_m = 300});
    EXPECT_EQ(height_over(soup.triangles, dvec2(0.0)), 0.0) << "seed " << seed;
    EXPECT_EQ(height_over(soup.of_class(SemanticClass::road), dvec2(0.0)), 0.0) << "seed " << seed;
    // Awnings and signs reach over the pavement.
    for (const SoupTriangle& t : soup.of_class(SemanticClass::building))
      for (const dvec3& c : t.corners)
        ASSERT_GT(std::max(std::abs(c.x), std::abs(c.y)), c.z > 2.4 ? 10.2 : 11.0) << "seed " << seed;
  }
}

TEST(City, NeighboursHaveDifferentFacades) {
  size_t pairs = 0;
  for (const uint64_t seed : {1u, 2u, 3u, 7u}) {
    const Soup soup = load_soup({.kind = "city", .seed = seed, .size_m = 300});
    struct House {
      std::string name, facade;
      Bounds walls;
    };
    std::vector<House> houses;
    for (uint32_t i = 0; i < soup.model.instances.size(); ++i) {
      if (soup.model.instances[i].semantic_class != SemanticClass::building) continue;
      House house{soup.model.instances[i].name, "", {}};
      for (const SoupTriangle& t : soup.of_instance(i)) {
        const std::string& material = soup.model.materials[t.material].name;
        if (!material.starts_with("facade_")) continue;
        house.facade = material;
        for (const dvec3& c : t.corners) house.walls.add(c);
      }
      houses.push_back(house);
    }
    // Only an alley of 5 m is between neighbours; the narrowest street with its pavements has 14 m.
    for (size_t a = 0; a < houses.size(); ++a)
      for (size_t b = 0; b < a; ++b) {
        const dvec2 gap = glm::max(dvec2(houses[a].walls.min - houses[b].walls.max),
                                   dvec2(houses[b].walls.min - houses[a].walls.max));
        if (std::max(gap.x, gap.y) > 5.2) continue;
        ++pairs;
        EXPECT_NE(houses[a].facade, houses[b].facade)
            << houses[a].name << ", " << houses[b].name << ", seed " << seed;
      }
  }
  EXPECT_GT(pairs, 100u);
}

TEST(City, CrownsLeaveRoomForLorries) {
  for (const uint64_t seed : {1u, 7u}) {
    const Soup soup = load_soup({.kind = "city", .seed = seed, .size_m = 300});
    const std::vector<SoupTriangle> roads = soup.of_class(SemanticClass::road);
    size_t over = 0;
    for (const SoupTriangle& t : soup.of_class(SemanticClass::vegetation))
      for (int i = 0; i <= 4; ++i)
        for (int j = 0; i + j <= 4; ++j) {
          const dvec3 p = t.corners[2] + 0.25 * i * (t.corners[0] - t.corners[2]) +
                          0.25 * j * (t.corners[1] - t.corners[2]);
          if (p.z > 4.6) continue;
          EXPECT_LT(height_over(roads, dvec2(p)), -1e8)
              << soup.model.instances[t.instance].name << " " << p.z;
          ++over;
        }
    EXPECT_GT(over, 100u) << "trunks and the park's trees";
  }
}

TEST(City, ItsExtrasKeepTheirBudgets) {
  size_t scaffolds = 0, fences = 0;
  for (const uint64_t seed : {1u, 2u, 3u, 5u, 7u, 11u}) {
    const Soup soup = load_soup({.kind = "city", .seed = seed, .size_m = 300});
    std::map<std::string, size_t> triangles;
    for (const SoupTriangle& t : soup.triangles) ++triangles[soup.model.instances[t.instance].name];
    size_t extra = 0;
    for (const auto& [name, count] : triangles) {
      const bool scaffold = name.ends_with("_scaffold"), fence = name.starts_with("site_fence_");
      scaffolds += scaffold;
      fences += fence;
      if (scaffold || fence || name.starts_with("grass_")) extra += count;
    }
    EXPECT_GT(triangles["grass_000"], 200u) << "seed " << seed;
    EXPECT_LE(triangles["grass_000"], 600u) << "seed " << seed;
    EXPECT_LE(extra, 3500u) << "seed " << seed;
  }
  EXPECT_GE(scaffolds, 3u);
  EXPECT_GE(fences, scaffolds);
}

TEST(City, NothingStandsWherePeopleWalk) {
  // People walk within 0.6 m of a line at these distances from the kerb (city_street.h).
  for (const uint64_t seed : {1u, 7u}) {
    const Soup soup = load_soup({.kind = "city", .seed = seed, .size_m = 300});
    const generator::CityPlan plan = generator::plan_city(300.0, seed);
    std::vector<std::pair<dvec2, dvec2>> lines;
    for (const generator::Block& block : plan.block) {
      const auto depth = [](double pavement) { return pavement == 4.0 ? 3.1 : pavement == 3.0 ? 2.0 : 1.0; };
      std::vector<double> depths;
      for (size_t i = 0; i < 4; ++i) {
        const size_t arcs = block.corners[i].size() - 1;
        for (size_t k = 0; k < arcs; ++k) {
          const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(arcs);
          depths.push_back((1.0 - t) * depth(block.pavement_m[(i + 3) % 4]) + t * depth(block.pavement_m[i]));
        }
        depths.push_back(depth(block.pavement_m[i]));
      }
      const std::vector<dvec2> line = generator::inset(block.outline(), depths);
      for (size_t i = 0; i < line.size(); ++i) lines.emplace_back(line[i], line[(i + 1) % line.size()]);
    }
    size_t tried = 0;
    for (const SoupTriangle& t : soup.triangles) {
      const ModelInstance& instance = soup.model.instances[t.instance];
      const SemanticClass c = instance.semantic_class;
      const bool stands = c == SemanticClass::furniture || c == SemanticClass::pole ||
                          c == SemanticClass::vegetation || c == SemanticClass::street_lamp ||
                          c == SemanticClass::building;
      if (!stands) continue;
      for (int i = 0; i <= 4; ++i)
        for (int j = 0; i + j <= 4; ++j) {
          const dvec3 p = t.corners[2] + 0.25 * i * (t.corners[0] - t.corners[2]) +
                          0.25 * j * (t.corners[1] - t.corners[2]);
          if (p.z > 0.15 + 2.3) continue;
          ++tried;
          for (const auto& [a, b] : lines) {
            const double along = std::clamp(glm::dot(dvec2(p) - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
            ASSERT_GE(glm::length(dvec2(p) - glm::mix(a, b, along)), 0.6)
                << instance.name << " at " << p.x << ", " << p.y << ", " << p.z << ", seed " << seed;
          }
        }
    }
    EXPECT_GT(tried, 1000u);
  }
}

TEST(City, PavementsAreRaisedAboveTheRoad) {
  const Soup soup = load_soup({.kind = "city", .seed = 1, .size_m = 300});
  for (const SoupTriangle& t : soup.of_class(SemanticClass::pavement)) {
    if (t.normal().z < 0.99) continue;
    EXPECT_GE(t.corners[0].z, 0.149);
  }
  for (const SoupTriangle& t : soup.of_class(SemanticClass::lane_marking)) EXPECT_EQ(t.corners[0].z, 0.0);
}

TEST(Country, RoadPondAndBarns) {
  for (const uint64_t seed : {1u, 2u, 3u, 4u}) {
    for (const double size : {160.0, 300.0, 900.0}) {
      const Soup soup = load_soup({.kind = "country", .seed = seed, .size_m = size});
      const std::string where = "seed " + std::to_string(seed) + ", " + std::to_string(size) + " m";
      std::map<SemanticClass, int> count;
      for (const ModelInstance& i : soup.model.instances) ++count[i.semantic_class];
      EXPECT_GE(count[SemanticClass::building], 4) << where;  // two farmhouses, two to four barns, a silo
      EXPECT_LE(count[SemanticClass::building], 7) << where;
      EXPECT_GT(count[SemanticClass::vegetation], 10) << where;
      // The rim of the pond lies in its banks. Its middle is open water.
      std::vector<SoupTriangle> land = soup.of_class(SemanticClass::ground);
      const std::vector<SoupTriangle> pond = soup.of_class(SemanticClass::water);
      dvec2 middle(0.0);
      for (const SoupTriangle& t : pond)
        for (const dvec3& c : t.corners) {
          EXPECT_GT(height_over(land, dvec2(c)), c.z + 0.05) << where;
          middle += dvec2(c) / (3.0 * static_cast<double>(pond.size()));
        }
      EXPECT_LT(height_over(land, middle), pond[0].corners[0].z - 0.5) << where;
      // No house stands in the pond or on the road.
      const auto all = bounds_of_instances(soup);
      const Bounds& water = all.at("pond");
      const std::vector<SoupTriangle> roads = soup.of_class(SemanticClass::road);
      for (const SoupTriangle& t : soup.of_class(SemanticClass::building))
        for (const dvec3& c : t.corners) {
          EXPECT_GT(glm::length(dvec2(c - water.center())), 0.5 * water.size().x)
              << where << ": " << soup.model.instances[t.instance].name;
          EXPECT_LT(height_over(roads, dvec2(c)), -1e8)
              << where << ": " << soup.model.instances[t.instance].name;
        }
      // The road runs from edge to edge.
      Bounds road;
      for (const SoupTriangle& t : soup.of_class(SemanticClass::road))
        for (const dvec3& c : t.corners) road.add(c);
      EXPECT_NEAR(road.size().x, size, 1e-3) << where;
      EXPECT_GT(road.size().y, 10.0) << where << ": winding";
    }
  }
}

TEST(Country, ThingsStandOnTheGround) {
  const Soup soup = load_soup({.kind = "country", .seed = 2, .size_m = 300});
  const std::vector<SoupTriangle> land = soup.of_class(SemanticClass::ground);
  const auto bounds = bounds_of_instances(soup);
  for (const ModelInstance& instance : soup.model.instances) {
    const bool tree = instance.name.starts_with("tree_"), pole = instance.name.starts_with("pole_");
    const bool house = instance.semantic_class == SemanticClass::building;
    if (!tree && !pole && !house) continue;
    const dvec2 foot(instance.model_from_mesh[3]);
    const double ground = height_over(land, foot), low = bounds.at(instance.name).min.z;
    EXPECT_LT(low, ground) << instance.name << " floats";
    EXPECT_GT(low, ground - 2.5) << instance.name << " is buried";
  }
}

TEST(Mast, LeavesTheAntennaAt25MetresFree) {
  const Bounds b = bounds_of(load_soup({.kind = "mast"}));
  EXPECT_GT(b.max.z, 24.0);
  EXPECT_LE(b.max.z, 24.6);
  EXPECT_LT(std::max(b.size().x, b.size().y), 5.0);
}

TEST(Car, StandsOnItsWheelsAndLooksAlongX) {
  for (const auto& [variant, length, height] :
       {std::tuple{"hatchback", 4.0, 1.47}, std::tuple{"van", 5.3, 2.2}}) {
    const Soup soup = load_soup({.kind = "car", .variant = variant});
    const Bounds b = bounds_of(soup);
    EXPECT_NEAR(b.size().x, length, 0.1) << variant;
    EXPECT_NEAR(b.max.z, height, 0.05) << variant;
    EXPECT_NEAR(b.min.z, 0.0, 0.03) << variant;  // from the flat side of an octagon
    EXPECT_NEAR(b.center().y, 0.0, 1e-3) << variant;
    for (const SoupTriangle& t : soup.triangles)
      if (soup.model.materials[t.material].name == "headlight") {
        EXPECT_GT(t.corners[0].x, 1.5) << variant;
      }
  }
}

TEST(Quadrotor, HasFourRotorsAboutItsCenter) {
  for (const auto& [variant, diagonal] :
       {std::pair{"small", 0.35}, std::pair{"medium", 0.9}, std::pair{"large", 2.2}}) {
    const Soup soup = load_soup({.kind = "quadrotor", .variant = variant});
    EXPECT_EQ(soup.model.instances.size(), 5u);
    std::vector<dvec3> hubs;
    for (int i = 0; i < 4; ++i) {
      const ModelInstance& rotor = soup.model.instances[soup.instance("rotor_" + std::to_string(i))];
      EXPECT_EQ(rotor.semantic_class, SemanticClass::uav);
      hubs.emplace_back(rotor.model_from_mesh[3]);
    }
    EXPECT_NEAR(glm::length(dvec2(hubs[0] - hubs[2])), diagonal, 2e-3) << variant;
    EXPECT_NEAR(glm::length(dvec2(hubs[1] - hubs[3])), diagonal, 2e-3) << variant;
    EXPECT_TRUE(hubs[0].x > 0 && hubs[0].y > 0) << "front left";
    EXPECT_TRUE(hubs[1].x > 0 && hubs[1].y < 0) << "front right";
    EXPECT_TRUE(hubs[2].x < 0 && hubs[2].y < 0) << "rear right";
    EXPECT_TRUE(hubs[3].x < 0 && hubs[3].y > 0) << "rear left";
    const Bounds b = bounds_of(soup);
    EXPECT_LT(glm::length(dvec2(b.center())), 0.08 * diagonal) << variant;
    EXPECT_LT(b.min.z, 0.0);
    EXPECT_GT(b.max.z, 0.0);
  }
}

}  // namespace
}  // namespace greatx::scene
