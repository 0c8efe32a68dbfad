// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "scene/check/check.h"
#include "scene/place/assemble/build_place.h"
#include "scene/place/assemble/picture_cover.h"
#include "scene/place/assemble/windows.h"
#include "scene/place/surfaces/material_table.h"

namespace greatx::scene::place {
namespace {

WallPiece wall(const dvec2& from, const dvec2& to, std::vector<double> from_z, std::vector<double> to_z) {
  WallPiece piece;
  piece.from = to_grid(from);
  piece.to = to_grid(to);
  piece.from_z = std::move(from_z);
  piece.to_z = std::move(to_z);
  return piece;
}

double area_of(const std::array<dvec3, 3>& t) {
  return 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
}

TEST(PlaceWindows, HaveTheirShareAndKeepTheOutline) {
  // A gable wall askew to the axes, with a corner of a neighbour's roof on one side.
  const WallPiece gable = wall({3.0, 1.0}, {13.2, 7.4}, {0.0, 3.0, 9.0}, {0.0, 12.0});
  const double length = glm::distance(dvec2(3.0, 1.0), dvec2(13.2, 7.4));
  const std::vector<WallTriangle> triangles = with_windows(gable, {0.0, length / 4.0, 0.0, 3.0, 3});
  double whole = 0.0, glass = 0.0;
  std::map<std::array<double, 3>, int> corners;
  const dvec2 along = glm::normalize(dvec2(10.2, 6.4));
  const dvec3 outwards(along.y, -along.x, 0.0);
  for (const WallTriangle& t : triangles) {
    whole += area_of(t.corners);
    if (t.window) glass += area_of(t.corners);
    EXPECT_GT(glm::dot(glm::cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]), outwards), 0.0);
    for (const dvec3& c : t.corners) {
      ++corners[{c.x, c.y, c.z}];
      EXPECT_NEAR(glm::dot(c - dvec3(3.0, 1.0, 0.0), outwards), 0.0, 3e-5);
    }
  }
  EXPECT_NEAR(whole, length * 10.5, 1e-3);
  EXPECT_NEAR(glass, 12.0 * (0.45 * length / 4.0) * (0.45 * 3.0), 2e-2);
  for (const double z : gable.from_z)
    EXPECT_EQ(corners.count({to_metres(gable.from.x), to_metres(gable.from.y), z}), 1u);
  for (const double z : gable.to_z)
    EXPECT_EQ(corners.count({to_metres(gable.to.x), to_metres(gable.to.y), z}), 1u);
}

TEST(PlaceWindows, WindowsThatDoNotFitAreNotThere) {
  for (const WallTriangle& t : with_windows(wall({0, 0}, {9, 0}, {0, 1}, {0, 1}), {0.0, 3.0, 0.0, 3.0, 1}))
    EXPECT_FALSE(t.window);
  for (const WallTriangle& t : with_windows(wall({0, 0}, {1, 0}, {0, 9}, {0, 9}), {1.0, 3.0, 0.0, 3.0, 3}))
    EXPECT_FALSE(t.window);
}

TEST(PlaceMaterials, OwnTablesReplaceClasses) {
  MaterialTable table;
  table.read_text(
      "greatx_place_materials: 1\nclasses:\n  roof/flat: [{name: my_roof, like: concrete, color: "
      "\"#808080\", "
      "radio: {itu: metal, thickness_m: 0.001}}]\n",
      "mine.yaml");
  const generator::MaterialSpec& mine = table[table.of("roof/flat", 0.5)];
  EXPECT_EQ(mine.name, "my_roof");
  EXPECT_NEAR(mine.color.r, 0.2159, 1e-3);
  EXPECT_NE(mine.radio.find("metal"), std::string::npos);
  EXPECT_NE(table[table.of("roof/tiles", 0.0)].name, table[table.of("roof/tiles", 0.99)].name);
}

TEST(PlaceMaterials, FaultsNameFileLineAndField) {
  const auto message = [](const char* classes) {
    MaterialTable table;
    try {
      table.read_text(std::string("greatx_place_materials: 1\nclasses:\n  ") + classes + "\n", "mine.yaml");
    } catch (const UserError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(message("roof/straw: [concrete]").find("mine.yaml:3"), std::string::npos);
  EXPECT_NE(message("roof/straw: [concrete]").find("roof/flat"), std::string::npos);
  EXPECT_NE(message("roof/flat: [marble]").find("expected one of asphalt"), std::string::npos);
  EXPECT_NE(message("roof/flat: [{like: concrete, radio: {itu: gold}}]").find("gold"), std::string::npos);
  EXPECT_NE(message("roof/flat: [{like: concrete, glass: 1.5}]").find("glass"), std::string::npos);
  EXPECT_NE(message("roof/flat: [{like: concrete, colour: 3}]").find("colour"), std::string::npos);
}

TEST(PlacePictures, ArePutWhereTheirPixelsLie) {
  GroundPicture picture;
  picture.width = 64;
  picture.height = 32;
  picture.rgb.assign(64 * 32 * 3, 100);
  picture.pixel_from_local =
      glm::dmat3x2(dvec2(2.0, 0.0), dvec2(0.0, -2.0), dvec2(10.0, 20.0));  // half a metre a pixel
  std::vector<Finding> findings;
  const PictureCover cover({picture}, 32, findings);  // halved once
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].topic, "picture_made_smaller");
  EXPECT_NEAR(cover.uv(0, {-5.0, 10.0}).x, 0.0, 1e-12);
  EXPECT_NEAR(cover.uv(0, {-5.0, 10.0}).y, 0.0, 1e-12);
  EXPECT_NEAR(cover.uv(0, {27.0, -6.0}).x, 1.0, 1e-12);
  EXPECT_NEAR(cover.uv(0, {27.0, -6.0}).y, 1.0, 1e-12);
  EXPECT_TRUE(cover.over({0, 0}, {5, 0}, {0, 5}));
  EXPECT_FALSE(cover.over({0, 0}, {50, 0}, {0, 5}));
  EXPECT_EQ(cover.textures().at("picture_0").color.width, 32u);
  EXPECT_NEAR(cover.textures().at("picture_0").color.rgb[0], 100, 1);
}

/// A small place: two houses with a party wall on a slope, a road, a wood, a row of trees, a bridge, a lamp.
PlaceInput small_place() {
  PlaceInput input;
  input.reference.origin = {-33.0, 18.0, 30.0};
  HeightGrid grid;
  grid.columns = grid.rows = 41;
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x) {
      const dvec2 p(5.0 * (x - 20), 5.0 * (20 - y));
      grid.samples.emplace_back(p, 0.05 * p.x + std::sin(p.y / 9.0));
    }
  input.terrain.add(grid);
  input.area = {{{-60, -60}, {60, -60}, {60, 60}, {-60, 60}}, {}};
  const auto area = [&](const char* id, const Ring& ring,
                        std::map<std::string, std::string, std::less<>> tags) {
    Feature feature;
    feature.source = "map";
    feature.id = id;
    feature.polygons = {{ring, {}}};
    feature.tags = std::move(tags);
    input.features.push_back(std::move(feature));
  };
  const auto line = [&](const char* id, const std::vector<dvec2>& points,
                        std::map<std::string, std::string, std::less<>> tags) {
    Feature feature;
    feature.source = "map";
    feature.id = id;
    feature.lines = {points};
    feature.tags = std::move(tags);
    input.features.push_back(std::move(feature));
  };
  area("way/1", {{0, 10}, {12, 10}, {12, 20}, {0, 20}},
       {{"building", "house"}, {"height", "8"}, {"roof:shape", "gabled"}});
  area("way/2", {{12, 10}, {24, 10}, {24, 20}, {12, 20}},
       {{"building", "apartments"}, {"building:levels", "4"}});
  area("way/3", {{-50, -50}, {-10, -50}, {-10, -20}, {-50, -20}}, {{"landuse", "forest"}});
  line("way/4", {{-70, 0}, {70, 0}}, {{"highway", "residential"}});
  line("way/5", {{30, -40}, {30, -8}}, {{"highway", "service"}, {"bridge", "yes"}});
  line("way/6", {{-40, 30}, {-10, 30}}, {{"natural", "tree_row"}});
  line("way/7", {{-40, 40}, {-10, 40}}, {{"barrier", "hedge"}});
  Feature lamp;
  lamp.source = "map";
  lamp.id = "node/1";
  lamp.point = dvec2(5.0, 5.0);
  lamp.tags = {{"highway", "street_lamp"}};
  input.features.push_back(lamp);
  return input;
}

TEST(PlaceBuild, MakesASceneWithoutFaults) {
  PlaceConfig config;
  config.name = "small";
  const BuiltPlace built = build_place(small_place(), config);
  const Model model = load_model("small.glb", built.glb, {});
  ASSERT_TRUE(model.georeference);
  EXPECT_EQ(model.georeference->origin.latitude_deg, -33.0);
  const SceneFaults faults = check_scene(model);
  EXPECT_EQ(faults.count(FaultSeverity::fault), 0u);
  EXPECT_EQ(faults.figures.rays_out, 0u);
  std::map<SemanticClass, int> classes;
  for (const ModelInstance& instance : model.instances) ++classes[instance.semantic_class];
  EXPECT_EQ(classes[SemanticClass::building], 2);
  EXPECT_EQ(classes[SemanticClass::street_lamp], 1);
  EXPECT_EQ(classes[SemanticClass::road], 2);         // the road on the ground and the bridge
  EXPECT_GT(classes[SemanticClass::vegetation], 15);  // 24 trees in the wood at 200 per hectare, 4 in the row
  EXPECT_LE(built.report.terrain_error_m, 0.25 + 1e-4);
  EXPECT_NEAR(built.report.built_area_m2, 240.0, 0.05);
  EXPECT_NEAR(built.report.built_volume_m3, built.report.source_volume_m3, 1.0);
  EXPECT_EQ(model.lights.size(), 1u);
}

TEST(PlaceBuild, GivesEqualBytes) {
  PlaceConfig config;
  config.name = "small";
  EXPECT_EQ(build_place(small_place(), config).glb, build_place(small_place(), config).glb);
  PlaceConfig other = config;
  other.vegetation.seed = 2;
  EXPECT_NE(build_place(small_place(), config).glb, build_place(small_place(), other).glb);
}

TEST(PlaceBuild, WindowsAsGeometryKeepTheSolids) {
  PlaceConfig config;
  config.name = "small";
  config.buildings.facades = FacadeDetail::geometry;
  const BuiltPlace built = build_place(small_place(), config);
  const SceneFaults faults = check_scene(load_model("small.glb", built.glb, {}));
  EXPECT_EQ(faults.count(FaultSeverity::fault), 0u);
  EXPECT_EQ(faults.figures.rays_out, 0u);
}

TEST(PlaceBuild, NothingToBuildIsAnError) {
  PlaceConfig config;
  config.name = "nothing";
  config.file = "nothing.yaml";
  EXPECT_THROW(build_place(PlaceInput(), config), UserError);
}

TEST(PlaceBuild, AnEmptyAreaIsGroundAlone) {
  PlaceConfig config;
  config.name = "empty";
  PlaceInput input;
  input.area = {{{-10, -10}, {10, -10}, {10, 10}, {-10, 10}}, {}};
  const BuiltPlace built = build_place(input, config);
  EXPECT_EQ(built.report.buildings, 0u);
  EXPECT_EQ(load_model("empty.glb", built.glb, {}).instances.size(), 1u);
}

}  // namespace
}  // namespace greatx::scene::place
