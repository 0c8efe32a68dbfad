// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks place.yaml: every field, its default, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/place/place_folder.h"

namespace greatx::scene::place {
namespace {

using test::message_of;
using test::PlaceFolder;
using testing::AllOf;
using testing::HasSubstr;

TEST(PlaceConfig, ReadsEveryField) {
  const PlaceFolder folder;
  for (const char* name : {"a.osm", "b.geojson", "t.tif", "s.tif", "p.png", "m.yaml"})
    folder.write(name, "x");
  const PlaceConfig place = folder.load(R"(
name: delft
origin: {latitude_deg: 52.01, longitude_deg: 4.36, height_m: 1.5}
undulation_m: 43.2
vertical_datum: NAP
area: {bounds_deg: [52.0, 4.3, 52.1, 4.4]}
maps:
  - {file: a.osm}
  - {file: b.geojson, name: footprints, layer: houses, crs: "EPSG:25833", keys: {height: hoehe},
     vocabulary: osm_buildings, as: building=yes, id_field: gid, height_unit: ft, heights: above_datum,
     licence: CC0}
terrain: [{file: t.tif, crs: "EPSG:4326", unit: us-ft, no_data: -1, valid_m: [-10, 300], licence: own}]
surface: [{file: s.tif}]
pictures: [{file: p.png, name: photo, crs: "EPSG:28992", licence: CC BY 4.0}]
buildings: {seed: 7, floor_height_m: 3.5, facades: geometry, weld_m: 0.1,
            assumed_height_m: {house: [6, 9], other: [3, 20]}}
ground: {error_m: 0.5, margin_m: 50, road_width_scale: 1.5}
vegetation: {seed: 9, woods_per_hectare: 100, row_spacing_m: 5}
materials: m.yaml
simplify_m: 0.3
)");
  EXPECT_EQ(place.name, "delft");
  EXPECT_EQ(*place.origin, (Geodetic{52.01, 4.36, 1.5}));
  EXPECT_EQ(place.undulation_m, 43.2);
  EXPECT_EQ(place.vertical_datum, "NAP");
  EXPECT_EQ(*place.area.bounds_deg, (std::array{52.0, 4.3, 52.1, 4.4}));
  ASSERT_EQ(place.maps.size(), 2u);
  EXPECT_EQ(place.maps[0].name, "a.osm");
  EXPECT_EQ(place.maps[0].vocabulary, "osm");
  EXPECT_EQ(place.maps[0].height_unit_m, 1.0);
  EXPECT_FALSE(place.maps[0].heights_above_datum);
  const MapSource& map = place.maps[1];
  EXPECT_EQ(map.name, "footprints");
  EXPECT_EQ(map.file, folder.path("b.geojson"));
  EXPECT_EQ(map.layer, "houses");
  EXPECT_EQ(map.crs, "EPSG:25833");
  EXPECT_EQ(map.keys.at("height"), "hoehe");
  EXPECT_EQ(map.vocabulary, "osm_buildings");
  EXPECT_EQ(map.as, "building=yes");
  EXPECT_EQ(map.id_field, "gid");
  EXPECT_EQ(map.height_unit_m, 0.3048);
  EXPECT_TRUE(map.heights_above_datum);
  EXPECT_EQ(map.licence, "CC0");
  ASSERT_EQ(place.terrain.size(), 1u);
  EXPECT_EQ(*place.terrain[0].unit_m, 1200.0 / 3937.0);
  EXPECT_EQ(*place.terrain[0].no_data, -1.0);
  EXPECT_EQ(*place.terrain[0].valid_m, dvec2(-10.0, 300.0));
  EXPECT_EQ(place.surface.at(0).name, "s.tif");
  EXPECT_FALSE(place.surface[0].unit_m);
  EXPECT_EQ(place.pictures.at(0).name, "photo");
  EXPECT_EQ(place.pictures[0].licence, "CC BY 4.0");
  EXPECT_EQ(place.buildings.seed, 7u);
  EXPECT_EQ(place.buildings.floor_height_m, 3.5);
  EXPECT_EQ(place.buildings.facades, FacadeDetail::geometry);
  EXPECT_EQ(place.buildings.weld_m, 0.1);
  EXPECT_EQ(place.buildings.assumed_height_m.at("house"), dvec2(6.0, 9.0));
  EXPECT_EQ(place.buildings.assumed_height_m.at(""), dvec2(3.0, 20.0));
  EXPECT_EQ(place.ground.error_m, 0.5);
  EXPECT_EQ(place.ground.margin_m, 50.0);
  EXPECT_EQ(place.ground.road_width_scale, 1.5);
  EXPECT_EQ(place.vegetation.seed, 9u);
  EXPECT_EQ(place.vegetation.woods_per_hectare, 100.0);
  EXPECT_EQ(place.vegetation.row_spacing_m, 5.0);
  EXPECT_EQ(place.materials, folder.path("m.yaml"));
  EXPECT_EQ(place.simplify_m, 0.3);
}

TEST(PlaceConfig, ReadsAPolygonAndDropsItsRepeatedCorner) {
  const PlaceFolder folder;
  folder.write("a.osm", "x");
  const PlaceConfig place =
      folder.load("area: {polygon_deg: [[1, 2], [1, 3], [2, 3], [1, 2]]}\nmaps: [{file: a.osm}]\n");
  EXPECT_EQ(place.name, "place");
  ASSERT_EQ(place.area.polygon.size(), 3u);
  EXPECT_EQ(place.area.polygon[2], (Geodetic{2.0, 3.0, 0.0}));
}

struct Faulty {
  const char* yaml;
  const char* where;
  const char* expected;
};

TEST(PlaceConfig, RefusesFaultsByFileLineAndField) {
  const PlaceFolder folder;
  folder.write("a.osm", "x");
  const std::string map = "maps: [{file: a.osm}]\n";
  for (const Faulty& faulty : {
           Faulty{"colour: red\n", "place.yaml:2", "colour"},
           Faulty{"maps: [{file: a.osm, hight: 3}]\n", "place.yaml:2", "hight"},
           Faulty{"maps: [{file: none.osm}]\n", "place.yaml:2", "an existing file"},
           Faulty{"maps: [{file: a.osm, vocabulary: osmm}]\n", "maps[0].vocabulary", "osm_buildings"},
           Faulty{"maps: [{file: a.osm, as: building}]\n", "maps[0].as", "building=yes"},
           Faulty{"maps: [{file: a.osm}, {file: a.osm}]\n", "maps[1]", "every source's name once"},
           Faulty{"maps: [{file: a.osm, height_unit: feet}]\n", "maps[0].height_unit", "us-ft"},
           Faulty{"terrain: [{file: a.osm, valid_m: [3, 1]}]\n", "terrain[0].valid_m", "lowest < highest"},
           Faulty{"area: {bounds_deg: [2, 1, 1, 2]}\n", "area.bounds_deg", "south < north"},
           Faulty{"area: {bounds_deg: [1, 1, 2, 181]}\n", "area.bounds_deg[3]", "180"},
           Faulty{"area: {bounds_deg: [1, 1, 2]}\n", "area.bounds_deg", "south, west, north, east"},
           Faulty{"area: {polygon_deg: [[1, 1], [2, 2]]}\n", "area.polygon_deg", "3 or more"},
           Faulty{"area: {bounds_deg: [1, 1, 2, 2], extent_of: x}\n", "area", "extent_of"},
           Faulty{"area: {extent_of: x}\nmaps: [{file: a.osm}]\n", "area.extent_of", "the sources are a.osm"},
           Faulty{"name: x\n", "place.yaml", "at least one source"},
           Faulty{"terrain: [{file: a.osm}]\n", "place.yaml", "no map gives an extent"},
           Faulty{"buildings: {floor_height_m: 0}\nmaps: [{file: a.osm}]\n", "buildings.floor_height_m",
                  "from 1 to 20"},
           Faulty{"buildings: {assumed_height_m: {house: [9, 6]}}\nmaps: [{file: a.osm}]\n",
                  "buildings.assumed_height_m.house", "lowest <= highest"},
           Faulty{"ground: {error_m: 0}\nmaps: [{file: a.osm}]\n", "ground.error_m", "0.001"},
           Faulty{"origin: {latitude_deg: 1, longitude_deg: 2}\nmaps: [{file: a.osm}]\n", "origin",
                  "height_m"},
           Faulty{"undulation_m: 300\nmaps: [{file: a.osm}]\n", "undulation_m", "200"},
       })
    EXPECT_THAT(message_of([&] { folder.load(faulty.yaml); }),
                AllOf(HasSubstr("place.yaml"), HasSubstr(faulty.where), HasSubstr(faulty.expected)))
        << faulty.yaml;
  folder.write("old.yaml", map);
  EXPECT_THAT(message_of([&] { load_place_config(folder.path("old.yaml")); }), HasSubstr("greatx_place"));
  folder.write("new.yaml", "greatx_place: 2\n" + map);
  EXPECT_THAT(message_of([&] { load_place_config(folder.path("new.yaml")); }), HasSubstr("greatx_place"));
}

}  // namespace
}  // namespace greatx::scene::place
