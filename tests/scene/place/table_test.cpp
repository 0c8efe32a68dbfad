// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks GeoJSON, GeoPackage and Shapefile: vocabularies, ids, units, layers, and files that say nothing.
#include <gdal_priv.h>
#include <memory>
#include <ogrsf_frmts.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/place/source/vocabulary.h"
#include "tests/scene/place/place_folder.h"

namespace greatx::scene::place {
namespace {

using test::area_of;
using test::find_feature;
using test::findings_of;
using test::message_of;
using test::PlaceFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A square of 1e-4 degrees at (10 + column / 1000, 48), with a court.
std::string square_json(int column, bool court = false) {
  const double x = 10.0 + 0.001 * column, y = 48.0;
  const auto ring = [&](double low, double high) {
    return fmt::format("[[{0},{1}],[{0},{3}],[{2},{3}],[{2},{1}],[{0},{1}]]", x + low, y + low, x + high,
                       y + high);
  };
  return fmt::format(R"({{"type":"Polygon","coordinates":[{}{}]}})", ring(0.0, 1e-4),
                     court ? "," + ring(4e-5, 6e-5) : "");
}

std::string feature_json(const std::string& properties, const std::string& geometry,
                         const std::string& id = "") {
  return fmt::format(R"({{"type":"Feature",{}"properties":{{{}}},"geometry":{}}})",
                     id.empty() ? "" : "\"id\":" + id + ",", properties, geometry);
}

std::string collection(const std::vector<std::string>& features) {
  return fmt::format(R"({{"type":"FeatureCollection","features":[{}]}})", fmt::join(features, ","));
}

TEST(PlaceTable, OverpassAndQgisFormsOfTags) {
  const PlaceFolder folder;
  folder.write(
      "flat.geojson",
      collection({feature_json(R"("@id":"way/17","building":"house","height":"7 m","building:levels":2)",
                               square_json(0, true), "\"way/17\""),
                  feature_json(R"("id":"relation/9","building":"yes")", square_json(1)),
                  feature_json(R"("@id":"node/5","natural":"tree")",
                               R"({"type":"Point","coordinates":[10.002,48]})", "\"node/5\"")}));
  folder.write("tags.geojson",
               collection({feature_json(R"("type":"way","id":17,"tags":{"building":"house","height":"7 m"})",
                                        square_json(0))}));
  folder.write("qgis.geojson",
               collection({feature_json(R"("osm_id":null,"osm_way_id":"17","building":"house",)"
                                        R"("other_tags":"\"height\"=>\"7 m\",\"note\"=>\"a \\\"b\\\"\"")",
                                        square_json(0))}));
  const PlaceInput flat = folder.read("maps: [{file: flat.geojson}]\n");
  ASSERT_EQ(flat.features.size(), 3u);
  const Feature* house = find_feature(flat, "way/17");
  ASSERT_TRUE(house);
  EXPECT_EQ(house->polygons.at(0).holes.size(), 1u);
  EXPECT_EQ(*house->tag("building:levels"), "2");
  EXPECT_EQ(*house->tag("height"), "7 m");
  EXPECT_FALSE(house->tag("@id"));
  EXPECT_TRUE(find_feature(flat, "relation/9"));
  EXPECT_TRUE(find_feature(flat, "node/5")->point);
  for (const char* file : {"tags.geojson", "qgis.geojson"}) {
    const PlaceInput input = folder.read(fmt::format("maps: [{{file: {}}}]\n", file));
    ASSERT_EQ(input.features.size(), 1u) << file;
    EXPECT_EQ(input.features[0].id, "way/17") << file;
    EXPECT_EQ(*input.features[0].tag("building"), "house");
    EXPECT_EQ(*input.features[0].tag("height"), "7 m");
    EXPECT_FALSE(input.features[0].tag("tags"));
    EXPECT_FALSE(input.features[0].tag("other_tags"));
  }
}

TEST(PlaceTable, OsmBuildingsVocabulary) {
  const PlaceFolder folder;
  folder.write("b.geojson",
               collection({feature_json(R"("height":22,"levels":5,"roofShape":"gabled","roofLevels":1,)"
                                        R"("type":"apartments","roofColor":"#aabbcc")",
                                        square_json(0), "\"a1\""),
                           feature_json(R"("levels":2,"building":"a1")", square_json(1), "\"a2\""),
                           feature_json(R"("levels":3,"building":"gone")", square_json(2), "\"a3\""),
                           feature_json(R"("shape":"none")", square_json(3), "\"a4\"")}));
  const PlaceInput input = folder.read("maps: [{file: b.geojson, vocabulary: osm_buildings}]\n");
  ASSERT_EQ(input.features.size(), 3u);
  const Feature& block = *find_feature(input, "a1");
  EXPECT_THAT(block.tags, ElementsAre(std::pair("building", "apartments"), std::pair("building:levels", "5"),
                                      std::pair("height", "22"), std::pair("roof:colour", "#aabbcc"),
                                      std::pair("roof:levels", "1"), std::pair("roof:shape", "gabled")));
  EXPECT_EQ(find_feature(input, "a2")->part_of, "a1");
  EXPECT_EQ(*find_feature(input, "a2")->tag("building:part"), "yes");
  EXPECT_FALSE(find_feature(input, "a2")->tag("building"));
  EXPECT_EQ(find_feature(input, "a3")->part_of, "");
  EXPECT_TRUE(find_feature(input, "a3")->tag("building"));
  EXPECT_EQ(findings_of(input, "part_without_building").size(), 1u);
  EXPECT_EQ(findings_of(input, "marked_as_not_built").size(), 1u);
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: b.geojson}]\n"); }), HasSubstr("b.geojson"));
}

TEST(PlaceTable, AFileWithoutKnownKeysSuggestsAVocabulary) {
  const PlaceFolder folder;
  folder.write("b.geojson",
               collection({feature_json(R"("height":22,"levels":5,"roofShape":"flat")", square_json(0))}));
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: b.geojson}]\n"); }),
              AllOf(HasSubstr("none of its 1 objects says what it is"),
                    HasSubstr("height, levels, roofShape"), HasSubstr("vocabulary: osm_buildings")));
  folder.write("h.geojson", collection({feature_json(R"("hoehe":22,"gebnr":"x")", square_json(0))}));
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: h.geojson}]\n"); }),
              AllOf(HasSubstr("gebnr, hoehe"), HasSubstr("as: building=yes"),
                    HasSubstr("keys: {height: ATTRIBUTE}")));
  const PlaceInput input =
      folder.read("maps: [{file: h.geojson, as: building=yes, keys: {height: hoehe}, id_field: gebnr}]\n");
  ASSERT_EQ(input.features.size(), 1u);
  EXPECT_EQ(input.features[0].id, "x");
  EXPECT_EQ(*input.features[0].tag("building"), "yes");
  EXPECT_EQ(*input.features[0].tag("height"), "22");
}

TEST(PlaceTable, UnitsAndHeightsAboveTheDatum) {
  const PlaceFolder folder;
  folder.write("h.geojson", collection({feature_json(R"("h":100,"b":"12 m")", square_json(0)),
                                        feature_json(R"("h":"tall")", square_json(1))}));
  const std::string map = "maps: [{file: h.geojson, as: building=yes, keys: {height: h, min_height: b}, ";
  const PlaceInput feet = folder.read(map + "height_unit: ft}]\n");
  EXPECT_EQ(*feet.features[0].tag("height"), "30.48");
  EXPECT_EQ(*feet.features[0].tag("min_height"), "12");
  ASSERT_EQ(findings_of(feet, "not_a_length").size(), 1u);
  EXPECT_EQ(*feet.features[1].tag("height"), "tall");
  folder.write("t.asc", test::ascii_grid(20, 20, 9.99, 47.99, 0.001, [](int, int) { return "90"; }));
  const PlaceInput datum =
      folder.read(map + "heights: above_datum}]\nterrain: [{file: t.asc, crs: \"EPSG:4326\"}]\n");
  EXPECT_NEAR(std::stod(*datum.features[0].tag("height")), 10.0, 1e-3);
  EXPECT_NEAR(std::stod(*datum.features[0].tag("min_height")), -78.0, 1e-3);
}

TEST(PlaceTable, GeometryOfOtherKindsAndFaultyRings) {
  const PlaceFolder folder;
  folder.write(
      "g.geojson",
      collection({feature_json(R"("building":"a")",
                               R"({"type":"MultiPolygon","coordinates":[[[[10,48],[10.001,48],[10.001,)"
                               R"(48.001],[10,48]]],[[[10.002,48],[10.003,48],[10.003,48.001],[10.002,)"
                               R"(48]]]]})"),
                  feature_json(R"("building":"b")",
                               R"({"type":"Polygon","coordinates":[[[10,48],[10.001,48],[10.001,48.001]]]})"),
                  feature_json(R"("building":"c")",
                               R"({"type":"Polygon","coordinates":[[[10,48],[10.001,48],[10,48]]]})"),
                  feature_json(R"("highway":"path")",
                               R"({"type":"MultiLineString","coordinates":[[[10,48],[10.001,48]],)"
                               R"([[10.002,48],[10.003,48]]]})"),
                  feature_json(R"("natural":"tree")",
                               R"({"type":"MultiPoint","coordinates":[[10,48],[10.001,48]]})"),
                  feature_json(
                      R"("building":"d")",
                      R"({"type":"LineString","coordinates":[[10,48],[10.001,48],[10.001,48.001],[10,48]]})"),
                  feature_json(R"("building":"e")", "null")}));
  const PlaceInput input = folder.read("maps: [{file: g.geojson}]\n");
  const auto of = [&](const std::string& value) -> const Feature* {
    for (const Feature& feature : input.features)
      for (const auto& [key, text] : feature.tags)
        if (text == value) return &feature;
    return nullptr;
  };
  EXPECT_EQ(of("a")->polygons.size(), 2u);
  EXPECT_EQ(of("b")->polygons.at(0).outer.size(), 3u);
  EXPECT_FALSE(of("c"));
  EXPECT_EQ(of("path")->lines.size(), 2u);
  EXPECT_EQ(of("d")->polygons.size(), 1u);
  EXPECT_EQ(std::ranges::count_if(input.features, [](const Feature& f) { return f.point.has_value(); }), 2);
  EXPECT_EQ(findings_of(input, "ring_not_closed").size(), 1u);
  EXPECT_EQ(findings_of(input, "ring_of_too_few_corners").size(), 1u);
  EXPECT_EQ(findings_of(input, "without_geometry").size(), 1u);
}

TEST(PlaceTable, SwappedAndProjectedCoordinates) {
  const PlaceFolder folder;
  folder.write(
      "s.geojson",
      collection({feature_json(R"("building":"a")",
                               R"({"type":"Polygon","coordinates":[[[37.8,-122.4],[37.8,-122.5],[37.9,)"
                               R"(-122.4],[37.8,-122.4]]]})")}));
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: s.geojson}]\n"); }),
              AllOf(HasSubstr("s.geojson"), HasSubstr("the latitude -122."), HasSubstr("swapped")));
  folder.write(
      "p.geojson",
      collection({feature_json(R"("building":"a")",
                               R"({"type":"Polygon","coordinates":[[[392000,5820000],[392010,5820000],)"
                               R"([392010,5820010],[392000,5820000]]]})")}));
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: p.geojson}]\n"); }),
              AllOf(HasSubstr("(392000, 5820000) has no place"), HasSubstr("is its crs right")));
  const PlaceInput input = folder.read("maps: [{file: p.geojson, crs: \"EPSG:25833\"}]\n");
  EXPECT_NEAR(area_of(input.features.at(0).polygons.at(0).outer), 50.0, 0.1);
}

/// Writes a file of a driver of OGR with two layers if it can, of squares of 20 m in EPSG:32633.
void write_table(const std::filesystem::path& file, const char* driver,
                 const std::vector<const char*>& layers, bool with_crs = true) {
  GDALAllRegister();
  std::unique_ptr<GDALDataset> dataset(
      GetGDALDriverManager()->GetDriverByName(driver)->Create(file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  ASSERT_TRUE(dataset);
  OGRSpatialReference crs;
  crs.importFromEPSG(32633);
  for (const char* name : layers) {
    OGRLayer* layer = dataset->CreateLayer(name, with_crs ? &crs : nullptr, wkbPolygon, nullptr);
    OGRFieldDefn text("building", OFTString), number("hgt", OFTReal);
    layer->CreateField(&text);
    layer->CreateField(&number);
    for (int i = 0; i < 3; ++i) {
      const std::unique_ptr<OGRFeature> feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
      feature->SetField("building", name);
      feature->SetField("hgt", 10.5 + i);
      const double x = 390'000.0 + 50.0 * i, y = 5'820'000.0;
      OGRLinearRing ring;
      for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {20.0, 0.0}, {20.0, 20.0}, {0.0, 20.0}, {0.0, 0.0}})
        ring.addPoint(x + dx, y + dy);
      OGRPolygon polygon;
      polygon.addRing(&ring);
      feature->SetGeometry(&polygon);
      ASSERT_EQ(layer->CreateFeature(feature.get()), OGRERR_NONE);
    }
  }
}

TEST(PlaceTable, GeoPackageAndShapefile) {
  const PlaceFolder folder;
  write_table(folder.path("g.gpkg"), "GPKG", {"house", "shed"});
  write_table(folder.path("s.shp"), "ESRI Shapefile", {"s"});
  EXPECT_EQ(folder.read("maps: [{file: g.gpkg}]\n").features.size(), 6u);
  const PlaceInput shed = folder.read("maps: [{file: g.gpkg, layer: shed, keys: {height: hgt}}]\n");
  ASSERT_EQ(shed.features.size(), 3u);
  EXPECT_EQ(*shed.features[1].tag("building"), "shed");
  EXPECT_EQ(*shed.features[1].tag("height"), "11.5");
  // The scale of the projection is 0.99996 there.
  EXPECT_NEAR(area_of(shed.features[1].polygons.at(0).outer), 400.0, 0.4);
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: g.gpkg, layer: barn}]\n"); }),
              AllOf(HasSubstr("house, shed"), HasSubstr("'barn'")));
  const PlaceInput shape = folder.read("maps: [{file: s.shp}]\n");
  ASSERT_EQ(shape.features.size(), 3u);
  std::filesystem::remove(folder.path("s.prj"));
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: s.shp}]\n"); }),
              AllOf(HasSubstr("s.shp"), HasSubstr("crs")));
  const PlaceInput given = folder.read("maps: [{file: s.shp, crs: \"EPSG:32633\"}]\n");
  EXPECT_EQ(given.features.at(2).polygons.at(0).outer, shape.features[2].polygons.at(0).outer);
}

TEST(PlaceTable, OneSourceOutsideIsAFinding) {
  const PlaceFolder folder;
  folder.write("a.geojson", collection({feature_json(R"("building":"a")", square_json(0))}));
  folder.write("b.geojson", collection({feature_json(R"("building":"b")", square_json(500))}));
  const PlaceInput input = folder.read(
      "area: {extent_of: a.geojson}\nmaps: [{file: a.geojson}, {file: b.geojson, licence: ODbL}]\n");
  EXPECT_EQ(input.features.size(), 1u);
  ASSERT_EQ(findings_of(input, "map_outside").size(), 1u);
  EXPECT_EQ(findings_of(input, "map_outside")[0].object, "b.geojson");
  EXPECT_THAT(input.licences, ElementsAre("b.geojson: ODbL"));
}

TEST(PlaceTable, AreasOfPolygons) {
  const PlaceFolder folder;
  folder.write("a.geojson", collection({feature_json(R"("building":"a")", square_json(0)),
                                        feature_json(R"("building":"b")", square_json(1)),
                                        feature_json(R"("building":"c")", square_json(2))}));
  folder.write(
      "area.geojson",
      collection({feature_json("", R"({"type":"Polygon","coordinates":[[[9.9999,47.999],[10.0012,47.999],)"
                                   R"([10.0012,48.001],[9.9999,48.001],[9.9999,47.999]],[[10.0009,47.9999],)"
                                   R"([10.0011,47.9999],[10.00115,48.0002],[10.0009,48.0002],[10.0009,)"
                                   R"(47.9999]]]})")}));
  const PlaceInput file = folder.read("area: {polygon_file: area.geojson}\nmaps: [{file: a.geojson}]\n");
  EXPECT_EQ(file.features.size(), 1u);  // b lies in its hole
  EXPECT_EQ(file.area.holes.size(), 1u);
  const PlaceInput corners = folder.read(
      "area: {polygon_deg: [[47.999, 9.999], [47.999, 10.0015], [48.001, 10.0015]]}\nmaps: [{file: "
      "a.geojson}]\n");
  EXPECT_EQ(corners.features.size(), 1u);
  EXPECT_EQ(*corners.features[0].tag("building"), "b");
}

TEST(PlaceTable, DamagedFilesAreErrors) {
  const PlaceFolder folder;
  for (const char* text : {"", "{", "[]", "{\"type\":\"FeatureCollection\",\"features\":[{", "\x01\x02"}) {
    folder.write("a.geojson", text);
    EXPECT_THAT(message_of([&] { folder.read("maps: [{file: a.geojson}]\n"); }), HasSubstr("a.geojson"))
        << text;
  }
}

}  // namespace
}  // namespace greatx::scene::place
