// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Expects nothing in sound scenes, and each planted hole, and nothing else, in its place.
#include "scene/generator/generate.h"
#include "tests/scene/check_places.h"

namespace greatx::scene::test {
namespace {

TEST(SceneCheckClean, AClosedBox) {
  SceneWriter scene;
  scene.add("house", box({0, 0, 0}, {10, 8, 6}));
  const SceneFaults faults = scene.check();
  EXPECT_EQ(kinds_of(faults), "");
  EXPECT_EQ(faults.figures.closed_parts, 1u);
  EXPECT_EQ(faults.figures.facets, 6u);
  EXPECT_EQ(faults.figures.rays, 256u);
  EXPECT_EQ(faults.figures.rays_out, 0u);
}

TEST(SceneCheckClean, TwoBoxesWithOnePartyWall) {
  SceneWriter scene;
  scene.add("house_1", box({0, 0, 0}, {10, 8, 12}));
  scene.add("house_2", box({10, 0, 0}, {20, 8, 12}, all_faces & ~west));
  // The lower neighbour's wall is a part of the higher one's.
  scene.add("house_3", box({-10, 0, 0}, {0, 8, 6}, all_faces & ~east));
  const SceneFaults faults = scene.check();
  EXPECT_EQ(kinds_of(faults), "");
  EXPECT_EQ(faults.figures.closed_parts, 1u);
  EXPECT_EQ(faults.figures.nearly_closed_parts, 2u);
  EXPECT_EQ(faults.figures.open_edges, 8u);
  EXPECT_EQ(faults.figures.closed_by_others, 8u);
}

TEST(SceneCheckClean, ATerrainASphereAndABoxThatReachesIntoTheGround) {
  SceneWriter scene;
  scene.add("terrain", terrain(100.0, 20, hills));
  scene.add("dome", sphere(5.0, 3, {20, 20, 12}));
  scene.add("house", box({-10, -10, -6}, {0, 0, 12}));
  EXPECT_EQ(kinds_of(scene.check()), "");
}

TEST(SceneCheckClean, ABoxWithoutAFloorOnTheGround) {
  SceneWriter scene;
  scene.add("ground", terrain(100.0, 7, flat));
  scene.add("house", box({-10, -10, 0}, {3, 4, 12}, all_faces & ~bottom));
  const SceneFaults faults = scene.check();
  EXPECT_EQ(kinds_of(faults), "");
  EXPECT_EQ(faults.figures.nearly_closed_parts, 1u);
}

TEST(SceneCheckClean, AHouseWithACavity) {
  SceneWriter scene;
  Shape house = box({0, 0, 0}, {10, 8, 6});
  Shape room = box({1, 1, 1}, {9, 7, 5});
  for (size_t t = 0; t < room.count(); ++t) room.flip(t);
  house.append(room);
  scene.add("house", house);
  EXPECT_EQ(kinds_of(scene.check()), "");
}

TEST(SceneCheckClean, TransformsAndOffsetsOfFiveKilometresChangeNothing) {
  for (const double angle : {0.0, 0.4, 1.1, 2.9})
    for (const double offset : {0.0, 5000.0}) {
      SceneWriter scene;
      const json node = {{"translation", {offset, 3.0, -offset}},
                         {"rotation", {0.0, std::sin(0.5 * angle), 0.0, std::cos(0.5 * angle)}},
                         {"scale", {1.7, 1.3, 0.9}}};
      scene.add("terrain", terrain(100.0, 9, flat), node);
      scene.add("house_1", box({0, 0, -1}, {10, 8, 12}), node);
      scene.add("house_2", box({10, 0, -1}, {20, 8, 12}, all_faces & ~west), node);
      scene.add("dome", sphere(4.0, 2, {-20, 20, 9}), node);
      EXPECT_EQ(kinds_of(scene.check()), "") << angle << ", " << offset;
    }
}

TEST(SceneCheckClean, AMirroredBoxLooksOutwards) {
  SceneWriter scene;
  scene.add("house", box({0, 0, -1}, {10, 8, 6}), {{"scale", {-1.0, 1.0, 1.0}}});
  scene.add("ground", terrain(40.0, 3, flat));
  EXPECT_EQ(kinds_of(scene.check()), "");
}

TEST(SceneCheckClean, Fp32AtFiveKilometresIsRoundedAndNoMore) {
  SceneWriter scene;
  const dvec3 far(5000.123, -5000.077, 30.0);
  scene.add("house_1", box(far, far + dvec3(10, 8, 12)));
  scene.add("house_2", box(far + dvec3(10, 0, 0), far + dvec3(20, 8, 12), all_faces & ~west));
  scene.add("house_3", box(far + dvec3(0, 30, 0), far + dvec3(20, 42, 12)));
  EXPECT_EQ(kinds_of(scene.check()), "rounded 3");
}

TEST(SceneCheckClean, EverythingThatTheGeneratorMakes) {
  for (const std::string& kind : generator_kinds()) {
    std::vector<std::string> variants = generator_variants(kind);
    if (variants.empty()) variants.push_back("");
    for (const std::string& variant : variants) {
      GenerateOptions generated;
      generated.kind = kind, generated.variant = variant, generated.seed = 3;
      if (kind == "city" || kind == "country") generated.size_m = 160.0;
      const SceneFaults faults = check_scene(load_model(kind, generate_glb(generated), {}));
      EXPECT_EQ(faults.count(FaultSeverity::fault), 0u) << kind << ' ' << variant << ": " << kinds_of(faults);
      EXPECT_EQ(faults.find("open_sheet"), nullptr) << kind << ' ' << variant;
      EXPECT_EQ(faults.figures.rays_out, 0u) << kind << ' ' << variant;
    }
  }
}

TEST(SceneCheckHoles, AMissingTriangle) {
  SceneWriter scene;
  Shape shape = sphere(5.0, 2);
  const dvec3 gone = shape.center(77);
  shape.remove(77);
  scene.add("dome", shape);
  scene.add("ground", terrain(40.0, 2, [](double, double) { return -8.0; }));
  CheckOptions options;
  options.rays = 0;
  const SceneFaults faults = scene.check(options);
  EXPECT_EQ(kinds_of(faults), "hole 1");
  const FaultPlace& place = only_place(faults, "hole");
  EXPECT_EQ(place.object, "dome");
  EXPECT_EQ(place.material, "itu_concrete");
  expect_near(place.at, gone, 1.0);
  EXPECT_NEAR(place.size, 4.6, 0.5);  // three sides
}

TEST(SceneCheckHoles, AMissingRoofLeaksRays) {
  SceneWriter scene;
  scene.add("ground", terrain(100.0, 7, flat));
  scene.add("house", box({-10, -10, -1}, {3, 4, 25}, all_faces & ~top));
  const SceneFaults faults = scene.check();
  EXPECT_EQ(kinds_of(faults), "hole 1, ray_leak 1");
  EXPECT_NEAR(only_place(faults, "hole").size, 54.0, 1e-6);
  EXPECT_EQ(only_place(faults, "ray_leak").object, "house");
}

TEST(SceneCheckHoles, ACrackWiderThanTheToleranceAlone) {
  for (const double shift : {0.0005, 0.003}) {
    SceneWriter scene;
    Shape shape = box({0, 0, 0}, {10, 8, 6});
    // One triangle of the roof has corners of its own; its middle one sinks.
    const size_t roof = shape.count() - 1;
    shape.corners[shape.indices[3 * roof + 2]].z -= shift;
    scene.add("house", shape);
    CheckOptions options;
    options.rays = 0;
    EXPECT_EQ(kinds_of(scene.check(options)), shift < 0.001 ? "" : "hole 1") << shift;
  }
}

TEST(SceneCheckHoles, AHigherNeighboursOpeningIsClosedInPart) {
  SceneWriter scene;
  scene.add("house_1", box({0, 0, 0}, {10, 8, 6}));
  scene.add("house_2", box({10, 0, 0}, {20, 8, 12}, all_faces & ~west));
  CheckOptions options;
  options.rays = 0;
  const SceneFaults faults = scene.check(options);
  EXPECT_EQ(kinds_of(faults), "hole 1, t_junction 2");
  // 6 m of both sides and the edge of the roof stay open.
  EXPECT_NEAR(only_place(faults, "hole").size, 20.0, 1e-2);
}

TEST(SceneCheckHoles, AHouseWithoutAFloorThatReachesIntoTheGroundIsADoubt) {
  SceneWriter scene;
  scene.add("ground", terrain(100.0, 7, flat));
  scene.add("house", box({-10, -10, -1}, {3, 4, 12}, all_faces & ~bottom));
  EXPECT_EQ(kinds_of(scene.check()), "hidden_opening 1");
}

TEST(SceneCheckHoles, AnOpenSillWithinAWallIsADoubt) {
  SceneWriter scene;
  scene.add("house", box({0, 0, 0}, {10, 8, 6}));
  scene.add("sill", box({4, -0.3, 2}, {6, 0.2, 2.2}, all_faces & ~north));
  EXPECT_EQ(kinds_of(scene.check()), "hidden_opening 1");
}

TEST(SceneCheckHoles, ASheetIsADoubtUnlessItIsGround) {
  SceneWriter scene;
  scene.add("fence", box({0, 0, 0}, {10, 8, 2}, south));
  const SceneFaults faults = scene.check();
  EXPECT_EQ(kinds_of(faults), "open_sheet 1");
  EXPECT_NEAR(only_place(faults, "open_sheet").size, 24.0, 0.02);
  SceneWriter roads;
  roads.add("road", box({0, 0, 0}, {10, 8, 2}, top));
  EXPECT_EQ(kinds_of(roads.check()), "");
}

TEST(SceneCheckHoles, AHoleAndACrackInTheGround) {
  SceneWriter hole;
  Shape ground = terrain(100.0, 20, hills);
  ground.remove(411);
  hole.add("terrain", ground);
  const SceneFaults faults = hole.check();
  EXPECT_EQ(kinds_of(faults), "ground_hole 1");
  EXPECT_NEAR(only_place(faults, "ground_hole").size, 17.1, 1.5);
  // Two tiles of which one is 5 mm lower along their common border, 100 m long: its border is open, and the
  // other one lies above it. Then both meet.
  for (const double step : {0.005, 0.0}) {
    SceneWriter tiles;
    const Shape tile = terrain(100.0, 10, hills);
    Shape other = terrain(100.0, 10, [step](double x, double y) { return hills(x + 100.0, y) - step; });
    for (dvec3& corner : other.corners) corner.x += 100.0;
    tiles.add("terrain_0", tile);
    tiles.add("terrain_1", other);
    const SceneFaults found = tiles.check();
    EXPECT_EQ(kinds_of(found), step > 0.0 ? "ground_hole 1" : "") << step;
    if (step > 0.0) {
      EXPECT_NEAR(found.find("ground_hole")->worst, 102.0, 2.0);
    }
  }
  // A lawn with a hole, on the ground: its borders are no cracks.
  SceneWriter lawn;
  lawn.add("terrain", terrain(100.0, 3, flat));
  Shape grass = terrain(20.0, 5, [](double, double) { return 0.05; });
  grass.remove(24);
  lawn.add("grass", grass);
  EXPECT_EQ(kinds_of(lawn.check()), "");
}

TEST(SceneCheckHoles, FoliageClaimsToBeASolid) {
  SceneWriter scene;
  scene.material(
      {{"name", "leaves"}, {"extensions", {{"GREATX_radio_material", {{"foliage", "weissberger"}}}}}});
  scene.add("crown", box({0, 0, 0}, {10, 8, 2}, south | top));
  EXPECT_EQ(kinds_of(scene.check()), "hole 1");
}

TEST(SceneCheckHoles, LeavesThatRadioDoesNotSeeMayBeOpen) {
  SceneWriter scene;
  scene.material(
      {{"name", "sprays"},
       {"extensions", {{"GREATX_radio_material", {{"foliage", {{"attenuation_db_per_m", 0.0}}}}}}}});
  scene.add("spray", box({0, 0, 0}, {10, 8, 2}, south | top));
  EXPECT_EQ(kinds_of(scene.check()), "");
}

TEST(SceneCheckHoles, AHallClaimsToBeASolidAndABasinDoesNot) {
  for (const double height : {6.5, 5.0}) {
    SceneWriter scene;
    scene.add("hall", box({0, 0, 0}, {20, 20, height}, all_faces & ~bottom));
    CheckOptions options;
    options.rays = 0;
    EXPECT_EQ(kinds_of(scene.check(options)), height > 6.0 ? "hole 1" : "open_sheet 1") << height;
  }
}

TEST(SceneCheckHoles, ATubeIsASheet) {
  SceneWriter scene;
  scene.add("pipe", box({0, 0, 0}, {1, 1, 20}, west | east | south | north));
  EXPECT_EQ(kinds_of(scene.check()), "open_sheet 2");
}

}  // namespace
}  // namespace greatx::scene::test
