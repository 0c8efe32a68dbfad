// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/facets/placement.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/support/tiny_scene.h"

namespace greatx::rf {
namespace {

using test::TinyScene;
using test::Triangle;

/// Holds a scene and returns placements in it as names of objects; "" is none.
struct Asked {
  explicit Asked(const TinyScene& tiny, const dvec3& origin = dvec3(0.0)) : scene(tiny.build(origin)) {
    kinds.assign(scene.facets.size(), FacetKind::opaque);
    poses.resize(scene.bodies.size());
  }
  /// Sets the kind of all facets of an object.
  Asked& kind(const std::string& object, FacetKind which) {
    for (size_t i = 0; i < kinds.size(); ++i)
      if (scene.instances[scene.facets[i].instance].name == object) kinds[i] = which;
    return *this;
  }
  Placement of(const dvec3& world, uint32_t own_body = 0) const {
    return Surroundings(scene, kinds).of(world - scene.origin, poses, own_body);
  }
  std::string name(uint32_t facet) const {
    return facet == Placement::none ? "" : scene.instances[scene.facets[facet].instance].name;
  }
  std::string solid(const dvec3& world, uint32_t own_body = 0) const {
    return name(of(world, own_body).solid);
  }

  std::string beneath(const dvec3& world) const { return name(of(world).beneath); }

  scene::Scene scene;
  FacetKinds kinds;
  std::vector<Pose> poses;
};

/// Adds four walls with their normals outwards, without floor and roof.
TinyScene& walls(TinyScene& tiny, const dvec3& low, const dvec3& high) {
  const auto wall = [&](double ax, double ay, double bx, double by) {
    tiny.quad({ax, ay, low.z}, {bx, by, low.z}, {bx, by, high.z}, {ax, ay, high.z});
  };
  wall(low.x, low.y, high.x, low.y);
  wall(high.x, low.y, high.x, high.y);
  wall(high.x, high.y, low.x, high.y);
  wall(low.x, high.y, low.x, low.y);
  return tiny;
}

TinyScene& level(TinyScene& tiny, double half, double z) {
  return tiny.quad({-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z});
}

/// Adds a box with its normals inwards.
TinyScene& room(TinyScene& tiny, const dvec3& low, const dvec3& high) {
  const scene::Scene box = TinyScene().object("box").box(low, high).build();
  for (const scene::FacetTriangle& t : box.facet_triangles)
    tiny.triangle(t.corners[0], t.corners[2], t.corners[1]);
  return tiny;
}

TEST(Placement, InsideAndOutsideOfABox) {
  TinyScene tiny;
  tiny.object("house").box({0, 0, 0}, {10, 8, 6}).object("shed").box({20, 0, 0}, {24, 4, 3});
  const Asked asked(tiny);
  EXPECT_EQ(asked.solid({5, 4, 3}), "house");
  EXPECT_EQ(asked.solid({22, 1, 1}), "shed");
  EXPECT_EQ(asked.solid({15, 2, 1}), "");
  EXPECT_EQ(asked.solid({5, 4, 7}), "");
  EXPECT_EQ(asked.solid({5, 4, -1}), "") << "below it, into it and out again";
  EXPECT_TRUE(asked.of({15, 2, 1}).free());
}

// Rays straight below corners, edges and diagonals meet the edge between two triangles.
TEST(Placement, SymmetricPointsAreDecidedToo) {
  TinyScene tiny;
  tiny.object("cube").box({-1, -1, -1}, {1, 1, 1});
  const Asked asked(tiny);
  for (const double x : {-0.5, 0.0, 0.5})
    for (const double y : {-0.5, 0.0, 0.5})
      for (const double z : {-0.5, 0.0, 0.5}) {
        EXPECT_EQ(asked.solid({x, y, z}), "cube") << x << " " << y << " " << z;
        EXPECT_EQ(asked.solid({x + 3, y, z}), "");
        EXPECT_EQ(asked.solid({x, y, z - 3}), "");
      }
}

// A closed fan of slivers is queried along its axis and at random points. The expected answer is analytic.
TEST(Placement, AConeOfSliversKeepsItsInside) {
  TinyScene tiny;
  tiny.object("cone");
  constexpr int sides = 720;
  const auto rim = [](int i) {
    const double a = 2 * pi * (i % sides) / sides;
    return dvec3(std::cos(a), std::sin(a), 0.0);
  };
  for (int i = 0; i < sides; ++i)
    tiny.triangle(rim(i), rim(i + 1), {0, 0, 2}).triangle(rim(i + 1), rim(i), {0, 0, 0});
  const Asked asked(tiny);
  for (const double z : {0.1, 1.0, 1.9}) EXPECT_EQ(asked.solid({0, 0, z}), "cone") << z;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-1.2, 1.2);
  int inside = 0;
  for (int i = 0; i < 500; ++i) {
    const dvec3 p(at(random), at(random), 1.0 + at(random));
    const double margin = 1.0 - p.z / 2 - std::hypot(p.x, p.y);
    if (std::abs(margin) < 1e-3 || std::abs(p.z) < 1e-3) continue;
    const bool expected = margin > 0.0 && p.z > 0.0;
    EXPECT_EQ(asked.solid(p) == "cone", expected) << p.x << " " << p.y << " " << p.z;
    inside += expected;
  }
  EXPECT_GT(inside, 30);
}

TEST(Placement, AHouseOfWallsAndRoofWithoutFloorIsSolid) {
  TinyScene tiny;
  tiny.object("ground");
  level(tiny, 500, 0);
  tiny.object("walls");
  walls(tiny, {-10, -10, 0}, {10, 10, 12});
  tiny.object("roof");
  level(tiny, 10, 12);
  tiny.object("cupboard").box({2, 2, 0}, {4, 4, 2});
  const Asked asked(tiny);
  EXPECT_EQ(asked.solid({0, 0, 1}), "walls") << "most of what is around it";
  EXPECT_EQ(asked.solid({-9, 9, 11}), "walls");
  EXPECT_EQ(asked.solid({1, 3, 1}), "walls") << "one ray meets the cupboard first";
  EXPECT_EQ(asked.solid({3, 3, 1}).empty(), false);
  EXPECT_EQ(asked.solid({15, 0, 1}), "") << "rays go in by a wall and out by the roof";
  EXPECT_EQ(asked.solid({0, 0, 13}), "");
  EXPECT_EQ(asked.solid({0, 0, -3}), "") << "a sheet is no solid";
  EXPECT_EQ(asked.beneath({0, 0, -3}), "ground");
  EXPECT_EQ(asked.beneath({0, 0, 1}), "");
}

// A single sheet encloses no point, however wide and near it is.
TEST(Placement, UnderAnOpenSheetIsNotInside) {
  TinyScene tiny;
  tiny.object("sheet");
  level(tiny, 500, 5);
  const Asked alone(tiny);
  for (const double z : {4.99, 4.0, 0.0, -50.0}) {
    EXPECT_EQ(alone.solid({3, 7, z}), "") << z;
    EXPECT_EQ(alone.beneath({3, 7, z}), "sheet") << z;
    EXPECT_FALSE(alone.of({3, 7, z}).free()) << "it sees nothing that is above";
  }
  for (const double z : {5.01, 6.0, 60.0}) EXPECT_TRUE(alone.of({3, 7, z}).free()) << z;
  EXPECT_TRUE(alone.of({700, 7, 4.0}).free()) << "beside it";
  EXPECT_EQ(
      describe(alone.of({3, 7, 4}), alone.scene, alone.kinds),
      "lies beneath 'sheet' (material default), an open surface with nothing below: it sees nothing that "
      "is above");
  // With a ground below, the sheet is a roof without walls.
  tiny.object("ground");
  level(tiny, 500, 0);
  const Asked roof(tiny);
  EXPECT_TRUE(roof.of({3, 7, 4.0}).free());
  EXPECT_EQ(roof.beneath({3, 7, -1.0}), "ground");
  // A house below the sheet remains solid.
  tiny.object("house").box({0, 0, 0}, {10, 8, 3});
  const Asked house(tiny);
  EXPECT_EQ(house.solid({3, 7, 2}), "house");
  EXPECT_EQ(house.solid({30, 7, 2}), "");
}

TEST(Placement, ABoxThatIsOpenSomewhere) {
  const auto box_without = [](int missing) {
    TinyScene tiny;
    const scene::Scene whole = TinyScene().object("box").box({0, 0, 0}, {10, 8, 6}).build();
    const dvec3 outwards[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    tiny.object("box");
    for (const scene::FacetTriangle& t : whole.facet_triangles) {
      const dvec3 normal =
          glm::normalize(glm::cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]));
      if (missing < 6 && glm::dot(normal, outwards[missing]) > 0.5) continue;
      tiny.triangle(t.corners[0], t.corners[1], t.corners[2]);
    }
    return Asked(tiny);
  };
  for (int missing = 0; missing < 5; ++missing) {
    const Asked open = box_without(missing);
    EXPECT_EQ(open.solid({5, 4, 3}), "") << missing;
    EXPECT_EQ(open.solid({5, 4, 9}), "") << missing;
  }
  EXPECT_EQ(box_without(5).solid({5, 4, 3}), "box") << "a house without a floor";
  EXPECT_EQ(box_without(5).solid({5, 4, -1}), "") << "below it";
  EXPECT_EQ(box_without(6).solid({5, 4, 3}), "box");
}

TEST(Placement, WhatIsOpenIsNotSolid) {
  TinyScene tiny;
  tiny.object("canopy");
  level(tiny, 10, 5);
  tiny.object("court");
  walls(tiny, {30, -10, 0}, {50, 10, 12});
  tiny.object("room");
  room(tiny, {60, 0, 0}, {70, 8, 3});
  tiny.object("sheet").quad({80, -9, 0}, {80, 9, 0}, {80, 9, 9}, {80, -9, 9});
  tiny.quad({80, 9, 0}, {80, -9, 0}, {80, -9, 9}, {80, 9, 9});
  const Asked asked(tiny);
  EXPECT_EQ(asked.solid({0, 0, 2}), "") << "under a roof without walls";
  EXPECT_EQ(asked.solid({40, 0, 2}), "") << "the sky is open";
  EXPECT_EQ(asked.solid({65, 4, 1.5}), "") << "normals point inwards: that is a room";
  EXPECT_EQ(asked.solid({79, 0, 4}), "") << "in front of a sheet with two sides";
}

TEST(Placement, WithinAThickWallOfARoom) {
  TinyScene tiny;
  tiny.object("shell").box({0, 0, 0}, {10, 8, 4});
  room(tiny, {1, 1, 1}, {9, 7, 3});
  const Asked asked(tiny);
  EXPECT_EQ(asked.solid({5, 4, 2}), "");
  EXPECT_EQ(asked.solid({0.5, 4, 2}), "shell");
  EXPECT_EQ(asked.solid({5, 4, 0.5}), "shell");
}

TEST(Placement, OnASurfaceWithinTheToleranceOfTheVisibilityTest) {
  TinyScene tiny;
  tiny.object("house").box({0, 0, 0}, {10, 8, 6});
  const Asked asked(tiny);
  for (const double off : {0.0, 5e-5, -5e-5}) {
    const Placement placement = asked.of({3, 4, 6 + off});
    EXPECT_EQ(asked.name(placement.surface), "house") << off;
    EXPECT_NEAR(placement.surface_m, std::abs(off), 1e-12);
    EXPECT_EQ(placement.solid, Placement::none) << "what it lies on is on neither side of it";
  }
  EXPECT_TRUE(asked.of({3, 4, 6 + 2e-4}).free());
  EXPECT_EQ(asked.of({3, 4, 6 - 2e-4}).surface, Placement::none);
  EXPECT_EQ(asked.solid({3, 4, 6 - 2e-4}), "house");
  EXPECT_TRUE(asked.of({10.5, 4, 6}).free()) << "in the plane, outside of the outline";
  EXPECT_EQ(asked.name(asked.of({10, 8, 6}).surface), "house") << "a corner";
  EXPECT_EQ(asked.name(asked.of({10.00005, 4, 6}).surface), "house") << "beside an edge";
}

TEST(Placement, FoliageIsNoSolid) {
  TinyScene tiny;
  tiny.object("crown").box({0, 0, 3}, {4, 4, 8}).object("house").box({10, 0, 0}, {14, 4, 8});
  Asked asked(tiny);
  asked.kind("crown", FacetKind::foliage);
  const Placement inside = asked.of({2, 2, 5});
  EXPECT_EQ(inside.solid, Placement::none);
  EXPECT_EQ(asked.name(inside.foliage), "crown");
  EXPECT_EQ(asked.of({2, 2, 8}).surface, Placement::none) << "its boundary is none that blocks";
  EXPECT_EQ(asked.of({2, 2, 2}).foliage, Placement::none);
  asked.kind("crown", FacetKind::absent);
  EXPECT_TRUE(asked.of({2, 2, 5}).free()) << "with the effect off it is not there";
}

TEST(Placement, BodiesWhereTheyStandAndNotTheOnesOwn) {
  TinyScene tiny;
  tiny.object("ground");
  level(tiny, 100, 0);
  const uint32_t car = tiny.body("car"), bus = tiny.body("bus");
  tiny.object("car", car)
      .box({-2, -1, 0.2}, {2, 1, 1.5})
      .object("bus", bus)
      .box({-6, -1.3, 0.2}, {6, 1.3, 3});
  Asked asked(tiny);
  asked.poses[car] = {{30, 0, 0}, orientation_from_yaw_pitch_roll(0.5 * pi, 0, 0)};
  asked.poses[bus] = {{-30, 0, 0}, dquat(1, 0, 0, 0)};
  EXPECT_EQ(asked.solid({30, 1.8, 1}), "car") << "turned by a quarter";
  EXPECT_EQ(asked.solid({31.8, 0, 1}), "");
  EXPECT_EQ(asked.solid({30, 0, 1}, car), "");
  EXPECT_EQ(asked.solid({-30, 0, 1}, car), "bus");
  EXPECT_EQ(asked.solid({0, 0, 1}), "");
}

TEST(Placement, FarFromTheOriginTheSame) {
  TinyScene tiny;
  const dvec3 there(500000, 5400000, 120);
  tiny.object("house").box(there, there + dvec3(10, 8, 6));
  const Asked asked(tiny, there + dvec3(1000, -2000, 0));
  EXPECT_EQ(asked.solid(there + dvec3(5, 4, 3)), "house");
  EXPECT_EQ(asked.solid(there + dvec3(5, 4, 7)), "");
  EXPECT_EQ(asked.name(asked.of(there + dvec3(5, 4, 6)).surface), "house");
}

TEST(Placement, WordsNameObjectAndMaterial) {
  TinyScene tiny;
  tiny.object("house", 0, tiny.material("brick", 0.5f)).box({0, 0, 0}, {10, 8, 6});
  Asked asked(tiny);
  EXPECT_EQ(describe(asked.of({5, 4, 3}), asked.scene, asked.kinds),
            "lies inside 'house' (material brick): it sees only what is inside");
  asked.kind("house", FacetKind::wall);
  EXPECT_EQ(describe(asked.of({5, 4, 3}), asked.scene, asked.kinds),
            "lies inside 'house' (material brick): what is outside it sees through walls alone");
  EXPECT_EQ(
      describe(asked.of({5, 4, 6.00002}), asked.scene, asked.kinds),
      "lies on a surface of 'house' (material brick), 0.02 mm off it: that one neither blocks nor hides "
      "anything from it");
  asked.kind("house", FacetKind::foliage);
  EXPECT_EQ(describe(asked.of({5, 4, 3}), asked.scene, asked.kinds),
            "lies inside the foliage of 'house' (material brick): every path of it is attenuated");
  EXPECT_EQ(describe(asked.of({50, 4, 3}), asked.scene, asked.kinds), "is free");
}

TEST(Placement, AnEmptySceneIsFree) {
  const Asked asked{TinyScene()};
  EXPECT_TRUE(asked.of({1, 2, 3}).free());
  EXPECT_THROW(Surroundings(asked.scene, FacetKinds(3)), ContractError);
}

}  // namespace
}  // namespace greatx::rf
