// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Plants overlaps, junctions, wrong sides, sizes and materials, and expects each, and nothing else, in its
// place.
#include <limits>

#include "core/units.h"
#include "tests/scene/check_places.h"

namespace greatx::scene::test {
namespace {

TEST(SceneCheckOverlaps, TheSameTriangleTwice) {
  for (const bool opposite : {false, true}) {
    SceneWriter scene;
    Shape shape = box({0, 0, 0}, {10, 8, 6});
    Shape copy;
    copy.triangle(shape.corner(4, 0), shape.corner(4, 1), shape.corner(4, 2));
    if (opposite) copy.flip(0);
    shape.append(copy);
    scene.add("house", shape);
    const SceneFaults faults = scene.check();
    EXPECT_EQ(faults.find("duplicate")->count, 1u) << kinds_of(faults);
    expect_near(only_place(faults, "duplicate").at, shape.center(4), 1e-4);
    EXPECT_NEAR(only_place(faults, "duplicate").size, 30.0, 1e-3);
    EXPECT_EQ(faults.find("hole"), nullptr);
  }
}

TEST(SceneCheckOverlaps, FacesOnEachOtherByTheirArea) {
  SceneWriter scene;
  scene.add("road", terrain(20.0, 1, flat));
  // A square of 6 x 6 m turned by 30 degrees: another triangulation and another object.
  scene.add("marking", terrain(6.0, 1, flat),
            {{"rotation", {0.0, std::sin(pi / 12), 0.0, std::cos(pi / 12)}}});
  const SceneFaults faults = scene.check();
  ASSERT_NE(faults.find("coincident"), nullptr) << kinds_of(faults);
  EXPECT_NEAR(faults.find("coincident")->total, 36.0, 1e-4);
  EXPECT_EQ(faults.faults.size(), 1u) << kinds_of(faults);
  EXPECT_EQ(faults.find("coincident")->places.front().other, "marking");
}

TEST(SceneCheckOverlaps, ASmallGapIsADoubtAndALargerOneNothing) {
  for (const double gap : {0.0005, 0.002}) {
    SceneWriter scene;
    scene.add("road", terrain(20.0, 1, flat));
    scene.add("marking", terrain(6.0, 1, [gap](double, double) { return gap; }));
    const SceneFaults faults = scene.check();
    if (gap < 0.001)
      EXPECT_NEAR(faults.find("close_faces")->total, 36.0, 1e-4);
    else
      EXPECT_EQ(kinds_of(faults), "");
  }
}

TEST(SceneCheckOverlaps, TwoWallsBackToBackAreADoubt) {
  SceneWriter scene;
  scene.add("house_1", box({0, 0, 0}, {10, 8, 12}));
  scene.add("house_2", box({10, 2, 0}, {20, 8, 12}));
  const SceneFaults faults = scene.check();
  EXPECT_EQ(faults.faults.size(), 1u) << kinds_of(faults);
  EXPECT_NEAR(faults.find("back_to_back")->total, 72.0, 1e-4);
}

TEST(SceneCheckOverlaps, APlateThinnerThanTheGapIsNone) {
  SceneWriter scene;
  scene.add("plate", box({0, 0, 0}, {1, 1, 0.0005}));
  CheckOptions options;
  options.sliver_m = options.facet_m = 0.0;
  EXPECT_EQ(kinds_of(scene.check(options)), "");
}

TEST(SceneCheckOverlaps, AHeapOfCopiesIsCountedWithABound) {
  SceneWriter scene;
  Shape heap;
  for (int i = 0; i < 100; ++i) heap.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  scene.add("ground", heap);
  // 84 triangles have at least 16 later ones: 84 * 16 + (15 + 14 + ... + 1).
  EXPECT_EQ(kinds_of(scene.check()), "duplicate 1464");
}

TEST(SceneCheckJunctions, ACornerOnAnEdge) {
  SceneWriter scene;
  Shape shape = box({0, 0, 0}, {10, 8, 6}, all_faces & ~top);
  // The roof has a corner in the middle of its southern edge, which the wall has not.
  shape.quad({0, 0, 6}, {5, 0, 6}, {5, 8, 6}, {0, 8, 6});
  shape.triangle({5, 0, 6}, {10, 0, 6}, {10, 8, 6});
  shape.triangle({5, 0, 6}, {10, 8, 6}, {5, 8, 6});
  // Its northern edge has one as well.
  scene.add("house", shape);
  const SceneFaults faults = scene.check();
  EXPECT_EQ(kinds_of(faults), "t_junction 2");
  for (const FaultPlace& place : faults.find("t_junction")->places)
    EXPECT_LT(std::min(glm::distance(place.at, dvec3(5, 0, 6)), glm::distance(place.at, dvec3(5, 8, 6))),
              1e-6);
}

TEST(SceneCheckSides, AFlippedTriangle) {
  SceneWriter scene;
  Shape shape = box({0, 0, 0}, {10, 8, 6});
  shape.flip(5);
  scene.add("house", shape);
  const SceneFaults faults = scene.check();
  EXPECT_EQ(kinds_of(faults), "flipped 1");
  expect_near(only_place(faults, "flipped").at, shape.center(5), 1e-6);
}

TEST(SceneCheckSides, ASolidInsideOutAndARoom) {
  Shape inwards = box({0, 0, 0}, {10, 8, 6});
  for (size_t t = 0; t < inwards.count(); ++t) inwards.flip(t);
  SceneWriter scene;
  scene.add("house", inwards);
  scene.add("ground", terrain(100.0, 2, [](double, double) { return -1.0; }));
  const SceneFaults faults = scene.check();
  EXPECT_EQ(kinds_of(faults), "inside_out 1");
  EXPECT_NEAR(only_place(faults, "inside_out").size, 480.0, 1e-3);
  SceneWriter room;
  room.add("room", inwards);
  room.add("table", box({4, 3, 1}, {6, 5, 2}));
  EXPECT_EQ(kinds_of(room.check()), "looks_inwards 1");
}

TEST(SceneCheckSides, NormalsAgainstTheWinding) {
  SceneWriter scene;
  scene.itu_material();
  const std::vector<vec3> positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}};
  for (const float y : {1.0f, -1.0f}) {
    const json primitive = {{"attributes",
                             {{"POSITION", scene.vec3s(positions)},
                              {"NORMAL", scene.vec3s(std::vector<vec3>(4, vec3(0, y, 0)))}}},
                            {"indices", scene.indices32(quad_indices())},
                            {"material", 0}};
    const std::string name = y > 0 ? "ground_good" : "ground_bad";
    scene.root({{"name", name},
                {"mesh", scene.mesh(name, json::array({primitive}))},
                {"translation", {2.0 * y, 0.0, 0.0}}});
  }
  const SceneFaults faults = scene.check();
  EXPECT_EQ(kinds_of(faults), "normals_against_winding 2");
  EXPECT_EQ(faults.faults.front().places.front().object, "ground_bad");
}

TEST(SceneCheckSides, AMoebiusStrip) {
  SceneWriter scene;
  Shape strip;
  constexpr int n = 24;
  const auto at = [](int i, double w) {
    const double a = 2.0 * pi * i / n;
    const double r = 5.0 + w * std::cos(0.5 * a);
    return dvec3(r * std::cos(a), r * std::sin(a), w * std::sin(0.5 * a));
  };
  for (int i = 0; i + 1 < n; ++i) strip.quad(at(i, -1), at(i + 1, -1), at(i + 1, 1), at(i, 1));
  strip.quad(at(n - 1, -1), at(0, 1), at(0, -1), at(n - 1, 1));
  scene.add("strip", strip);
  const SceneFaults faults = scene.check();
  ASSERT_NE(faults.find("not_orientable"), nullptr) << kinds_of(faults);
  EXPECT_EQ(faults.find("not_orientable")->count, 1u);
}

TEST(SceneCheckSides, ABodyThatReachesIntoItself) {
  SceneWriter scene;
  // A corridor of square rings about a path that crosses itself: one skin, which goes through itself.
  const std::vector<dvec2> path = {{0, 0}, {20, 0}, {20, 10}, {10, 10}, {10, -10}};
  Shape shape;
  const auto ring = [&](size_t i) {
    const dvec2 in = i > 0 ? glm::normalize(path[i] - path[i - 1]) : glm::normalize(path[1] - path[0]);
    const dvec2 out = i + 1 < path.size() ? glm::normalize(path[i + 1] - path[i]) : in;
    const dvec2 side(-(in + out).y, (in + out).x);
    const dvec2 miter = glm::length(in - out) < 1e-9 ? 0.5 * side : side;
    return std::vector<dvec3>{dvec3(path[i] - miter, -1), dvec3(path[i] + miter, -1),
                              dvec3(path[i] + miter, 1), dvec3(path[i] - miter, 1)};
  };
  for (size_t i = 0; i + 1 < path.size(); ++i) {
    const auto a = ring(i), b = ring(i + 1);
    for (size_t k = 0; k < 4; ++k) shape.quad(a[k], a[(k + 1) % 4], b[(k + 1) % 4], b[k]);
  }
  const auto first = ring(0), last = ring(path.size() - 1);
  shape.quad(first[3], first[2], first[1], first[0]);
  shape.quad(last[0], last[1], last[2], last[3]);
  scene.add("corridor", shape);
  const SceneFaults faults = scene.check();
  EXPECT_NE(faults.find("overlaps_itself"), nullptr) << kinds_of(faults);
  EXPECT_EQ(faults.find("hole"), nullptr) << kinds_of(faults);
}

TEST(SceneCheckSizes, SliversAndNarrowFacets) {
  SceneWriter scene;
  scene.add("terrain", terrain(10.0, 2, flat));
  Shape sliver;
  sliver.triangle({0, 0, 1}, {2, 0, 1}, {1, 0.004, 1});
  scene.add("ground_sliver", sliver);
  const SceneFaults faults = scene.check();
  EXPECT_EQ(kinds_of(faults), "sliver 1, tiny_facet 1");
  EXPECT_NEAR(only_place(faults, "sliver").size, 0.004, 1e-6);
  EXPECT_NEAR(only_place(faults, "tiny_facet").size, 0.002, 1e-6);
  CheckOptions options;
  options.sliver_m = options.facet_m = 0.001;
  EXPECT_EQ(kinds_of(scene.check(options)), "");
}

TEST(SceneCheckSizes, SliversOfAPlaneAreNoNarrowFacets) {
  SceneWriter scene;
  Shape ground = terrain(10.0, 1, flat);
  const Shape more = box({5, -5, 0}, {5.004, 5, 0}, top);
  ground.append(more);
  scene.add("ground", ground);
  EXPECT_EQ(kinds_of(scene.check()), "sliver 2");
}

TEST(SceneCheckSizes, NotFiniteAndNoArea) {
  SceneWriter scene;
  Shape shape = box({0, 0, 0}, {10, 8, 6});
  shape.triangle({0, 0, 0}, {1, std::numeric_limits<double>::quiet_NaN(), 0}, {0, 1, 0});
  shape.triangle({0, 0, 3}, {1, 0, 3}, {2, 0, 3});
  scene.add("house", shape);
  EXPECT_EQ(kinds_of(scene.check()), "not_finite 1, no_area 1");
  expect_user_error([&] { scene.load(); }, {"vertex 37 is not finite"});
}

TEST(SceneCheckSizes, CoordinatesOfAnySizeEnd) {
  for (const double size : {1e-30, 1e15, 1e30}) {
    SceneWriter scene;
    scene.add("thing", box({0, 0, 0}, {size, size, size}, all_faces & ~top));
    const SceneFaults faults = scene.check();
    EXPECT_NE(faults.find("scene_size"), nullptr) << size << ": " << kinds_of(faults);
    EXPECT_NE(faults.find("hole"), nullptr) << size << ": " << kinds_of(faults);
  }
}

TEST(SceneCheckSizes, AnObjectFarAway) {
  SceneWriter scene;
  for (int i = 0; i < 6; ++i)
    scene.add("house_" + std::to_string(i), box(dvec3(20 * i, 0, 0), dvec3(20 * i + 9, 8, 6)));
  scene.add("house_lost", box({9000, 0, 0}, {9009, 8, 6}), json::object());
  CheckOptions options;
  options.weld_m = 0.01;  // 9 km are rounded to 1 mm
  const SceneFaults faults = scene.check(options);
  EXPECT_EQ(kinds_of(faults), "far_away 1");
  EXPECT_EQ(only_place(faults, "far_away").object, "house_lost");
}

TEST(SceneCheckSizes, UnitsAndAxes) {
  SceneWriter centimetres;
  centimetres.add("car", box({0, 0, 0}, {400, 180, 150}));
  EXPECT_EQ(kinds_of(centimetres.check()), "object_size 1");
  SceneWriter millimetres;
  millimetres.add("thing", box({0, 0, 0}, {0.03, 0.02, 0.05}));
  EXPECT_EQ(kinds_of(millimetres.check()), "scene_size 1");
  SceneWriter lying;
  const json turned = {{"rotation", {std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}}};
  lying.add("ground", terrain(100.0, 2, flat), turned);
  lying.add("house", box({0, 0, -1}, {10, 8, 6}), turned);
  EXPECT_EQ(kinds_of(lying.check()), "on_its_side 1");
}

TEST(SceneCheckMaterials, WithoutRadioPropertiesWithoutPicturesAndUnused) {
  SceneWriter scene;
  scene.material({{"name", "Window.003"}});
  scene.material({{"name", "wood_07"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  scene.material({{"name", "spare"}});
  scene.document["textures"] = json::array({{{"source", 0}}});
  scene.document["images"] = json::array({{{"uri", "gone.png"}}});
  scene.add("house_1", box({0, 0, 0}, {1, 1, 1}));
  scene.add("house_2", box({3, 0, 0}, {5, 1, 1}), json::object(), 1);
  const TemporaryFolder folder;
  const auto file = folder.write("scene.glb", scene.glb());
  LoadOptions load;
  load.optical_only = load.keep_faults = true;
  const SceneFaults faults = check_scene(load_model(file, load));
  EXPECT_EQ(kinds_of(faults), "no_radio 2, lost_picture 1, unused_material 1");
  const std::vector<FaultPlace>& places = faults.find("no_radio")->places;
  EXPECT_EQ(places[0].material, "wood_07");  // the larger area first
  EXPECT_EQ(places[0].other, "itu: wood, thickness_m: 0.04");
  EXPECT_EQ(places[1].other, "itu: glass, thickness_m: 0.006");
  EXPECT_THAT(only_place(faults, "lost_picture").material, testing::HasSubstr("gone.png"));
  EXPECT_EQ(only_place(faults, "unused_material").material, "spare");
  CheckOptions optical;
  optical.radio = false;
  EXPECT_EQ(check_scene(load_model(file, load), optical).find("no_radio"), nullptr);
}

}  // namespace
}  // namespace greatx::scene::test
