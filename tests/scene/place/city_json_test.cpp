// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks CityJSON: versions, transforms, kinds of geometry, levels of detail, parts, and faults.
#include "scene/place/source/city_json.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/scene/place/place_folder.h"

namespace greatx::scene::place {
namespace {

using test::area_of;
using test::find_feature;
using test::findings_of;
using test::message_of;
using test::PlaceFolder;
using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::ordered_json;

/// A box of 10 x 8 x 6 m from (84600, 447400, 2) in EPSG:7415, as a solid with its semantics.
class City {
 public:
  explicit City(const std::string& version = "2.0") {
    json_ = {{"type", "CityJSON"},
             {"version", version},
             {"metadata", {{"referenceSystem", "https://www.opengis.net/def/crs/EPSG/0/7415"}}},
             {"transform", {{"scale", {0.001, 0.001, 0.001}}, {"translate", {84600.0, 447400.0, 2.0}}}},
             {"CityObjects", Json::object()},
             {"vertices", Json::array()}};
  }
  Json& json() { return json_; }

  /// Adds the eight corners of a box, in millimetres of the transform; returns the first index.
  size_t box(int x, int y, int z, int width, int depth, int height) {
    const size_t first = json_["vertices"].size();
    for (const int up : {0, height})
      for (const auto& [dx, dy] : {std::pair{0, 0}, {width, 0}, {width, depth}, {0, depth}})
        json_["vertices"].push_back({x + dx, y + dy, z + up});
    return first;
  }
  static Json shell(size_t f) {
    return Json::array({Json::array({Json::array({f, f + 3, f + 2, f + 1})}),
                        Json::array({Json::array({f + 4, f + 5, f + 6, f + 7})}),
                        Json::array({Json::array({f, f + 1, f + 5, f + 4})}),
                        Json::array({Json::array({f + 1, f + 2, f + 6, f + 5})}),
                        Json::array({Json::array({f + 2, f + 3, f + 7, f + 6})}),
                        Json::array({Json::array({f + 3, f, f + 4, f + 7})})});
  }
  /// Surfaces of one ring each.
  static Json surfaces(const char* lod, const std::vector<std::vector<size_t>>& rings) {
    Json boundaries = Json::array();
    for (const auto& ring : rings) boundaries.push_back(Json::array({Json(ring)}));
    return {{"type", "MultiSurface"}, {"lod", lod}, {"boundaries", boundaries}};
  }
  static Json solid(const Json& lod, size_t f) {
    return {
        {"type", "Solid"},
        {"lod", lod},
        {"boundaries", Json::array({shell(f)})},
        {"semantics",
         {{"surfaces", {{{"type", "GroundSurface"}}, {{"type", "RoofSurface"}}, {{"type", "WallSurface"}}}},
          {"values", Json::array({Json::array({0, 1, 2, 2, 2, nullptr})})}}}};
  }
  Json& add(const std::string& id, const std::string& type, const std::vector<Json>& geometry,
            const Json& attributes = Json::object()) {
    json_["CityObjects"][id] = {{"type", type}, {"attributes", attributes}, {"geometry", geometry}};
    return json_["CityObjects"][id];
  }
  PlaceInput read(const std::string& more = "", const std::string& options = "") const {
    const PlaceFolder folder;
    folder.write("c.city.json", json_.dump());
    return folder.read(
        "origin: {latitude_deg: 52.0106, longitude_deg: 4.3621, height_m: 0}\nmaps: [{file: c.city.json" +
        options + "}]\n" + more);
  }

 private:
  Json json_;
};

/// Returns the volume within faces, m3, by the divergence theorem with fans.
double volume_of(const std::vector<SolidFace>& faces) {
  double volume = 0.0;
  for (const SolidFace& face : faces) {
    const auto& ring = face.rings[0];
    for (size_t i = 2; i < ring.size(); ++i)
      volume += glm::dot(ring[0], glm::cross(ring[i - 1], ring[i])) / 6.0;
  }
  return volume;
}

TEST(PlaceCityJson, SolidsWithSemanticsInEveryVersion) {
  for (const char* version : {"1.0", "1.0.3", "1.1", "2.0", "2.0.1"}) {
    City city(version);
    const size_t f = city.box(0, 0, 0, 10'000, 8'000, 6'000);
    city.add("b", "Building", {City::solid(version[0] == '1' ? Json(2) : Json("2.2"), f)},
             {{"measuredHeight", 6.0}, {"storeysAboveGround", 2}});
    const PlaceInput input = city.read();
    ASSERT_EQ(input.features.size(), 1u);
    const Feature& house = input.features[0];
    EXPECT_EQ(house.id, "b");
    EXPECT_EQ(*house.tag("building"), "yes");
    EXPECT_EQ(*house.tag("building:levels"), "2");
    EXPECT_NEAR(std::stod(*house.tag("height")), 6.0, 1e-9);
    ASSERT_EQ(house.faces.size(), 6u);
    EXPECT_TRUE(house.polygons.empty());
    using Kind = SolidFace::Kind;
    const std::array kinds{Kind::ground, Kind::roof, Kind::wall, Kind::wall, Kind::wall, Kind::unknown};
    for (size_t i = 0; i < 6; ++i) EXPECT_EQ(house.faces[i].kind, kinds[i]);
    // The grid's scale is 0.99991 to 1.0001 in the Netherlands.
    EXPECT_NEAR(volume_of(house.faces), 480.0, 0.2);
    EXPECT_NEAR(house.faces[0].rings[0][0].z, 2.0, 1e-3);
    EXPECT_NEAR(house.faces[1].rings[0][0].z, 8.0, 1e-3);
    EXPECT_TRUE(input.findings.empty());
  }
}

TEST(PlaceCityJson, WithAndWithoutTransformAreTheSame) {
  City packed;
  packed.add("b", "Building", {City::solid("1", packed.box(1234, 5678, -321, 10'001, 8'002, 6'003))});
  City plain;
  plain.json() = packed.json();
  plain.json().erase("transform");
  for (Json& vertex : plain.json()["vertices"])
    vertex = {84600.0 + 0.001 * vertex[0].get<int>(), 447400.0 + 0.001 * vertex[1].get<int>(),
              2.0 + 0.001 * vertex[2].get<int>()};
  const PlaceInput a = packed.read(), b = plain.read();
  for (size_t i = 0; i < 6; ++i)
    for (size_t k = 0; k < 4; ++k)
      EXPECT_LT(
          glm::distance(a.features.at(0).faces.at(i).rings[0][k], b.features.at(0).faces.at(i).rings[0][k]),
          1e-6);
}

TEST(PlaceCityJson, TheHighestLevelOfDetailBelowThree) {
  City city;
  const size_t low = city.box(0, 0, 0, 10'000, 8'000, 3'000), high = city.box(0, 0, 0, 10'000, 8'000, 6'000),
               windows = city.box(0, 0, 0, 10'000, 8'000, 9'000);
  city.add("b", "Building",
           {City::solid("1.2", low), City::solid("2.2", high), City::solid("1.3", low),
            City::solid("3.0", windows)});
  city.add("c", "Building", {City::solid("3.2", windows)});
  const PlaceInput input = city.read();
  ASSERT_EQ(input.features.size(), 1u);
  EXPECT_NEAR(volume_of(input.features[0].faces), 480.0, 0.2);
  ASSERT_EQ(findings_of(input, "level_of_detail").size(), 1u);
  EXPECT_EQ(findings_of(input, "level_of_detail")[0].object, "c.city.json: c");
}

TEST(PlaceCityJson, EveryKindOfGeometry) {
  City city;
  const size_t f = city.box(0, 0, 0, 10'000, 8'000, 6'000), g = city.box(20'000, 0, 0, 10'000, 8'000, 6'000);
  city.add("multi_surface", "Building",
           {{{"type", "MultiSurface"}, {"lod", "2"}, {"boundaries", City::shell(f)}}});
  city.add("composite_surface", "Building",
           {{{"type", "CompositeSurface"}, {"lod", "2"}, {"boundaries", City::shell(f)}}});
  city.add("multi_solid", "Building",
           {{{"type", "MultiSolid"},
             {"lod", "2"},
             {"boundaries", Json::array({Json::array({City::shell(f)}), Json::array({City::shell(g)})})}}});
  city.add("composite_solid", "Building",
           {{{"type", "CompositeSolid"},
             {"lod", "2"},
             {"boundaries", Json::array({Json::array({City::shell(f)}), Json::array({City::shell(g)})})}}});
  city.add(
      "lines", "Building",
      {{{"type", "MultiLineString"}, {"lod", "2"}, {"boundaries", Json::array({Json::array({f, f + 1})})}}});
  const PlaceInput input = city.read();
  EXPECT_EQ(find_feature(input, "multi_surface")->faces.size(), 6u);
  EXPECT_EQ(find_feature(input, "composite_surface")->faces.size(), 6u);
  EXPECT_EQ(find_feature(input, "multi_solid")->faces.size(), 12u);
  EXPECT_NEAR(volume_of(find_feature(input, "composite_solid")->faces), 960.0, 0.4);
  EXPECT_EQ(findings_of(input, "geometry_of_unknown_kind").size(), 1u);
}

TEST(PlaceCityJson, PartsAndTheirParents) {
  City city;
  const size_t f = city.box(0, 0, 0, 10'000, 8'000, 6'000);
  city.add("empty", "Building", {})["children"] = {"p1"};
  city.add("p1", "BuildingPart", {City::solid("2", f)})["parents"] = {"empty"};
  city.add("whole", "Building", {City::surfaces("0", {{f, f + 1, f + 2, f + 3}})})["children"] = {"p2"};
  city.add("p2", "BuildingPart", {City::solid("2", f)})["parents"] = {"whole"};
  const PlaceInput input = city.read();
  ASSERT_EQ(input.features.size(), 3u);
  EXPECT_EQ(find_feature(input, "p1")->part_of, "");
  EXPECT_TRUE(find_feature(input, "p1")->tag("building"));
  EXPECT_FALSE(find_feature(input, "p1")->tag("building:part"));
  EXPECT_EQ(find_feature(input, "p2")->part_of, "whole");
  EXPECT_TRUE(find_feature(input, "p2")->tag("building:part"));
  EXPECT_FALSE(find_feature(input, "p2")->tag("building"));
  // The footprint of level 0 is an area.
  EXPECT_NEAR(area_of(find_feature(input, "whole")->polygons.at(0).outer), 80.0, 0.1);
}

TEST(PlaceCityJson, AreasAreTheUnionOfTheirSurfacesInPlan) {
  City city;
  const size_t f = city.box(0, 0, 0, 10'000, 8'000, 6'000);
  // The floor as two triangles, and a wall.
  const Json road = City::surfaces("1", {{f, f + 1, f + 2}, {f, f + 2, f + 3}, {f, f + 1, f + 5, f + 4}});
  city.add("r", "Road", {road}, {{"function", "fietspad"}, {"surfacematerial", "gesloten verharding"}});
  city.add("r0", "Road", {road});
  city.add("l", "LandUse", {road}, {{"bgt_fysiekvoorkomen", "open verharding"}});
  city.add("w", "WaterBody", {road});
  city.add("p", "PlantCover", {road}, {{"averageHeight", 5.0}});
  city.add("g", "GenericCityObject", {road});
  city.add("v", "Road", {City::surfaces("1", {{f, f + 1, f + 5, f + 4}})});
  const PlaceInput input = city.read();
  const auto tag = [&](const char* id, const char* key) { return *find_feature(input, id)->tag(key); };
  EXPECT_EQ(tag("r", "highway"), "cycleway");
  EXPECT_EQ(tag("r", "surface"), "asphalt");
  EXPECT_EQ(tag("r", "area"), "yes");
  EXPECT_EQ(tag("r0", "highway"), "road");
  EXPECT_EQ(tag("l", "surface"), "paving_stones");
  EXPECT_EQ(tag("w", "natural"), "water");
  EXPECT_EQ(tag("p", "natural"), "wood");
  ASSERT_EQ(find_feature(input, "r")->polygons.size(), 1u);
  EXPECT_EQ(find_feature(input, "r")->polygons[0].outer.size(), 4u);
  EXPECT_NEAR(area_of(find_feature(input, "r")->polygons[0].outer), 80.0, 0.1);
  EXPECT_EQ(findings_of(input, "city_object_of_other_kind").size(), 1u);
  EXPECT_EQ(findings_of(input, "without_area").size(), 1u);
}

TEST(PlaceCityJson, TreesArePoints) {
  City city;
  const size_t f = city.box(0, 0, 0, 2'000, 2'000, 6'000);
  city.add("solid", "SolitaryVegetationObject", {City::solid("1", f)});
  city.add("template", "SolitaryVegetationObject",
           {{{"type", "GeometryInstance"},
             {"template", 0},
             {"boundaries", Json::array({f + 2})},
             {"transformationMatrix", Json::array()}}},
           {{"height", 7}});
  const PlaceInput input = city.read();
  EXPECT_EQ(find_feature(input, "solid")->tag("height") != nullptr, true);
  ASSERT_TRUE(find_feature(input, "template")->point);
  EXPECT_NEAR(glm::distance(*find_feature(input, "solid")->point, *find_feature(input, "template")->point),
              std::sqrt(2.0), 0.01);
}

TEST(PlaceCityJson, MeasuredHeightCountsOnlyWhereTheSolidAgrees) {
  City city;
  const size_t f = city.box(0, 0, 0, 10'000, 8'000, 6'000);
  city.add("agrees", "Building", {City::solid("1", f)}, {{"measuredHeight", 6.05}});
  city.add("roof_z", "Building", {City::solid("1", f)}, {{"measuredHeight", 8.0}});
  city.add("flat", "Building", {City::surfaces("0", {{f, f + 1, f + 2, f + 3}})}, {{"measuredHeight", 8.0}});
  const PlaceInput input = city.read();
  EXPECT_NEAR(std::stod(*find_feature(input, "roof_z")->tag("height")), 6.0, 1e-9);
  const auto disagree = findings_of(input, "measured_height_disagrees");
  ASSERT_EQ(disagree.size(), 1u);
  EXPECT_EQ(disagree[0].object, "c.city.json: roof_z");
  EXPECT_THAT(disagree[0].detail, HasSubstr("z of the roof"));
  EXPECT_EQ(findings_of(input, "measured_height_not_used").size(), 1u);
  EXPECT_FALSE(find_feature(input, "flat")->tag("height"));
  const PlaceInput given = city.read("", ", keys: {height: measuredHeight}, heights: above_datum");
  EXPECT_NEAR(std::stod(*find_feature(given, "flat")->tag("height")), 8.0, 1e-9);
  EXPECT_TRUE(findings_of(given, "measured_height_not_used").empty());
}

TEST(PlaceCityJson, FormsOfTheReferenceSystem) {
  EXPECT_EQ(crs_of_reference("https://www.opengis.net/def/crs/EPSG/0/7415"), "EPSG:7415");
  EXPECT_EQ(crs_of_reference("http://www.opengis.net/def/crs/EPSG/0/28992"), "EPSG:28992");
  EXPECT_EQ(crs_of_reference("urn:ogc:def:crs:EPSG::7415"), "EPSG:7415");
  EXPECT_EQ(crs_of_reference("EPSG:7415"), "EPSG:7415");
  City city;
  city.add("b", "Building", {City::solid("1", city.box(0, 0, 0, 1000, 1000, 1000))});
  const PlaceInput url = city.read();
  city.json()["metadata"]["referenceSystem"] = "urn:ogc:def:crs:EPSG::7415";
  const PlaceInput urn = city.read();
  EXPECT_EQ(url.features.at(0).faces.at(0).rings, urn.features.at(0).faces.at(0).rings);
  city.json().erase("metadata");
  EXPECT_THAT(message_of([&] { city.read(); }),
              AllOf(HasSubstr("c.city.json"), HasSubstr("no coordinate system")));
  const PlaceInput given = city.read("", ", crs: \"EPSG:28992\"");
  EXPECT_LT(glm::distance(given.features.at(0).faces.at(0).rings[0][0], url.features[0].faces[0].rings[0][0]),
            1e-3);
  city.json()["metadata"]["referenceSystem"] = "EPSG:1";
  EXPECT_THAT(message_of([&] { city.read(); }), HasSubstr("EPSG:1"));
}

TEST(PlaceCityJson, ZInFeet) {
  City city;
  city.json()["transform"]["translate"] = {980000.0, 195000.0, 100.0};
  city.json()["metadata"]["referenceSystem"] = "EPSG:2263";  // New York Long Island, US survey feet
  city.add("b", "Building", {City::solid("1", city.box(0, 0, 0, 10'000, 10'000, 10'000))});
  const PlaceFolder folder;
  folder.write("c.json", city.json().dump());
  const PlaceInput input = folder.read("maps: [{file: c.json, height_unit: us-ft}]\n");
  // 10 x 10 x 10 feet, 100 feet above the datum.
  EXPECT_NEAR(volume_of(input.features.at(0).faces), std::pow(3.048006, 3), 0.01);
  EXPECT_NEAR(input.features[0].faces[0].rings[0][0].z, 30.48, 0.01);
  EXPECT_NEAR(std::stod(*input.features[0].tag("height")), 3.048, 1e-3);
}

TEST(PlaceCityJson, FaultsAreErrorsThatNameThePlace) {
  const auto refuses = [](const std::function<void(Json&)>& change, const std::string& expected) {
    City city;
    city.add("b", "Building", {City::solid("1", city.box(0, 0, 0, 1000, 1000, 1000))});
    change(city.json());
    EXPECT_THAT(message_of([&] { city.read(); }), AllOf(HasSubstr("c.city.json"), HasSubstr(expected)));
  };
  refuses([](Json& j) { j["version"] = "3.0"; }, "version: expected CityJSON 1.0, 1.1 or 2.0");
  refuses([](Json& j) { j.erase("vertices"); }, "vertices");
  refuses([](Json& j) { j["vertices"][3] = {1, 2}; }, "vertices[3]: expected three numbers");
  refuses([](Json& j) { j["transform"]["scale"] = "x"; }, "transform.scale");
  refuses([](Json& j) { j["CityObjects"]["b"]["geometry"][0]["boundaries"][0][0][0][0] = 99; },
          "CityObjects.b.geometry.boundaries[0][0]: expected indices below 8, found 99");
  refuses([](Json& j) { j["CityObjects"]["b"]["geometry"][0]["boundaries"][0][0][0][0] = -1; }, "found -1");
  refuses([](Json& j) { j["CityObjects"]["b"]["geometry"][0]["boundaries"] = 7; }, "expected a list");
  refuses([](Json& j) { j["CityObjects"] = 7; }, "CityObjects");
  refuses([](Json& j) { j["CityObjects"]["b"].erase("type"); }, "CityObjects.b.type");
  refuses([](Json& j) { j["CityObjects"]["b"]["geometry"] = Json::array(); }, "none of its 1 city objects");
  const PlaceFolder folder;
  folder.write("c.json", R"({"type":"CityJSON","version":"2.0",)");
  EXPECT_THAT(message_of([&] { folder.read("maps: [{file: c.json}]\n"); }), HasSubstr("c.json"));
  City thin;
  const size_t f = thin.box(0, 0, 0, 1000, 1000, 1000);
  thin.add("b", "Building", {City::solid("1", f)});
  thin.json()["CityObjects"]["b"]["geometry"][0]["boundaries"][0][0][0] = {f, f, f + 1};
  EXPECT_EQ(findings_of(thin.read(), "ring_of_too_few_corners").size(), 1u);
  EXPECT_EQ(thin.read().features.at(0).faces.size(), 5u);
}

TEST(PlaceCityJson, IsFoundByItsType) {
  EXPECT_TRUE(is_city_json(R"({"a":1, "type" : "CityJSON"})"));
  EXPECT_FALSE(is_city_json(R"({"name":"CityJSON"})"));
  EXPECT_FALSE(is_city_json(R"({"type":"FeatureCollection"})"));
}

}  // namespace
}  // namespace greatx::scene::place
