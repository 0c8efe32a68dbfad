// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares positions with those of PROJ's own pipelines: +proj=cart and +proj=topocentric.
#include <array>
#include <cmath>
#include <memory>
#include <proj.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/place/place_folder.h"

namespace greatx::scene::place {
namespace {

using test::ascii_grid;
using test::find_feature;
using test::PlaceFolder;

/// Converts by PROJ alone.
class Proj {
 public:
  explicit Proj(const std::string& definition)
      : context_(proj_context_create()), pipeline_(proj_create(context_, definition.c_str())) {
    if (pipeline_ == nullptr) throw std::runtime_error("PROJ: " + definition);
  }
  ~Proj() {
    proj_destroy(pipeline_);
    proj_context_destroy(context_);
  }
  Proj(const Proj&) = delete;
  Proj& operator=(const Proj&) = delete;
  dvec3 operator()(const dvec3& from) const {
    const PJ_COORD to = proj_trans(pipeline_, PJ_FWD, proj_coord(from.x, from.y, from.z, 0.0));
    return {to.xyz.x, to.xyz.y, to.xyz.z};
  }

 private:
  PJ_CONTEXT* context_;
  PJ* pipeline_;
};

/// (longitude, latitude) in degrees and ellipsoidal height -> east, north, up.
Proj topocentric(const Geodetic& origin) {
  return Proj(fmt::format(
      "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart "
      "+ellps=WGS84 +step +proj=topocentric +ellps=WGS84 +lon_0={:.12f} +lat_0={:.12f} +h_0={:.6f}",
      origin.longitude_deg, origin.latitude_deg, origin.height_m));
}

std::string square(double longitude, double latitude) {
  return fmt::format(
      R"({{"type":"FeatureCollection","features":[{{"type":"Feature","properties":{{"building":"yes"}},
"geometry":{{"type":"Polygon","coordinates":[[[{0},{1}],[{2},{1}],[{2},{3}],[{0},{3}],[{0},{1}]]]}}}}]}})",
      longitude, latitude, longitude + 1e-4, latitude + 1e-4);
}

struct Site {
  double latitude, longitude;
};

/// Positions of a map at 10 km from the origin, on terrain 500 m and more above it.
TEST(PlacePosition, HardCaseAgreesWithProjAtTenKilometres) {
  for (const Site& site : {Site{48.0, 11.0}, Site{-33.9, 151.2}, Site{64.1, -21.9}, Site{-16.5, 179.95},
                           Site{0.01, -78.5}, Site{78.2, 15.6}}) {
    const double east = 10'000.0 / (111'320.0 * std::cos(site.latitude * 3.14159265358979 / 180.0));
    const PlaceFolder folder;
    const double longitude = site.longitude + east > 180.0 ? site.longitude - east : site.longitude + east;
    folder.write("house.geojson", square(longitude, site.latitude + 0.01));
    // A plane that rises 150 m per 0.05 degrees of latitude, 500 m at the house.
    const auto plane = [&](double latitude) { return 500.0 + (latitude - site.latitude - 0.01) * 3000.0; };
    const double cell = 0.02, bottom = site.latitude - 10.0 * cell;
    folder.write("t.asc", ascii_grid(12, 20, longitude - 6.0 * cell, bottom, cell, [&](int, int row) {
                   return fmt::format("{:.6f}", plane(bottom + (19 - row + 0.5) * cell));
                 }));
    const PlaceInput input = folder.read(fmt::format(
        "origin: {{latitude_deg: {}, longitude_deg: {}, height_m: 20}}\nundulation_m: 47.5\nmaps: [{{file: "
        "house.geojson}}]\nterrain: [{{file: t.asc, crs: \"EPSG:4326\"}}]\n",
        site.latitude, site.longitude));
    EXPECT_EQ(input.reference.origin, (Geodetic{site.latitude, site.longitude, 67.5}));
    const Proj proj = topocentric(input.reference.origin);
    ASSERT_EQ(input.features.size(), 1u);
    const Ring& ring = input.features[0].polygons.at(0).outer;
    const std::array<dvec2, 4> corners{{{0, 0}, {1e-4, 0}, {1e-4, 1e-4}, {0, 1e-4}}};
    ASSERT_EQ(ring.size(), 4u);
    for (size_t i = 0; i < 4; ++i) {
      const dvec2 degrees = dvec2(longitude, site.latitude + 0.01) + corners[i];
      const dvec3 expected = proj({degrees.x, degrees.y, plane(degrees.y) + 47.5});
      EXPECT_GT(glm::length(expected), 9'900.0);
      EXPECT_NEAR(ring[i].x, expected.x, 0.01) << site.latitude;
      EXPECT_NEAR(ring[i].y, expected.y, 0.01) << site.latitude;
      // Terrain's own height there; between samples a bilinear cell leaves the plane by the Earth's curve.
      EXPECT_NEAR(input.terrain.at(ring[i]).value(), expected.z, 0.15);
    }
    // Samples are exact, up to the single precision in which GDAL reads ASCII grids.
    size_t checked = 0;
    for (const HeightGrid& grid : input.terrain.grids())
      for (const dvec3& sample : grid.samples) {
        const Geodetic place = LocalFrame(input.reference).datum_place(sample);
        EXPECT_NEAR(place.height_m, plane(place.latitude_deg), 5e-5);
        ++checked;
      }
    EXPECT_GE(checked, 16u);
  }
}

/// Coordinates of a projected system go through PROJ's transformation between the datums.
TEST(PlacePosition, ProjectedSystemsGoThroughProj) {
  const PlaceFolder folder;
  folder.write("house.geojson",
               R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"building":"yes"},
"geometry":{"type":"Polygon","coordinates":
[[[84616.468,447422.999],[84640,447422.999],[84640,447450],[84616.468,447422.999]]]}}]})");
  const PlaceInput input = folder.read(
      "origin: {latitude_deg: 52.0, longitude_deg: 4.37, height_m: 0}\nundulation_m: 43\nmaps: [{file: "
      "house.geojson, "
      "crs: \"EPSG:28992\"}]\n");
  PJ_CONTEXT* context = proj_context_create();
  PJ* raw = proj_create_crs_to_crs(context, "EPSG:28992", "EPSG:4326", nullptr);
  ASSERT_TRUE(raw);
  PJ* to_degrees = proj_normalize_for_visualization(context, raw);
  const PJ_COORD degrees = proj_trans(to_degrees, PJ_FWD, proj_coord(84616.468, 447422.999, 0.0, 0.0));
  const dvec3 expected = topocentric({52.0, 4.37, 43.0})({degrees.xy.x, degrees.xy.y, 43.0});
  EXPECT_NEAR(input.features.at(0).polygons.at(0).outer.at(0).x, expected.x, 0.001);
  EXPECT_NEAR(input.features.at(0).polygons.at(0).outer.at(0).y, expected.y, 0.001);
  // The corner is at 52.0107 N, 4.3620 E: no axis is swapped.
  EXPECT_NEAR(expected.x, -549.0, 5.0);
  EXPECT_NEAR(expected.y, 1190.0, 10.0);
  proj_destroy(to_degrees);
  proj_destroy(raw);
  proj_context_destroy(context);
}

/// OSGB36 has a conversion by a grid, which the package proj-data brings, and worse ones without.
TEST(PlacePosition, AMissingGridIsAFinding) {
  const PlaceFolder folder;
  folder.write("t.asc", ascii_grid(20, 20, 530'000, 180'000, 50, [](int, int) { return "5"; }));
  const PlaceInput input =
      folder.read("area: {extent_of: t.asc}\nterrain: [{file: t.asc, crs: \"EPSG:27700\"}]\n");
  PJ_CONTEXT* context = proj_context_create();
  const bool installed = proj_grid_info("OSTN15_NTv2_OSGBtoETRS.gsb").n_lon > 0 ||
                         proj_grid_info("uk_os_OSTN15_NTv2_OSGBtoETRS.tif").n_lon > 0;
  proj_context_destroy(context);
  EXPECT_EQ(test::findings_of(input, "datum_grid_missing").size(), installed ? 0u : 1u);
  folder.write("u.asc", ascii_grid(20, 20, 530'000, 5'500'000, 50, [](int, int) { return "5"; }));
  const PlaceInput exact =
      folder.read("area: {extent_of: u.asc}\nterrain: [{file: u.asc, crs: \"EPSG:25832\"}]\n");
  EXPECT_TRUE(test::findings_of(exact, "datum_grid_missing").empty());
}

TEST(PlacePosition, TheOriginIsTheMiddleOfTheAreaAtItsGround) {
  const PlaceFolder folder;
  folder.write("t.asc", ascii_grid(20, 20, 10.0, 48.0, 0.001, [](int, int) { return "512.34"; }));
  const PlaceInput input = folder.read(
      "undulation_m: 47\nvertical_datum: DHHN\narea: {bounds_deg: [48.005, 10.005, 48.0123456, "
      "10.0123456]}\nterrain: "
      "[{file: t.asc, crs: \"EPSG:4326\"}]\n");
  EXPECT_EQ(input.reference.origin.latitude_deg, 48.00867);
  EXPECT_EQ(input.reference.origin.longitude_deg, 10.00867);
  EXPECT_NEAR(input.reference.origin.height_m, 512.3 + 47.0, 1e-9);
  EXPECT_EQ(input.reference.vertical_datum, "DHHN");
  EXPECT_NEAR(input.terrain.at({0.0, 0.0}).value(), 0.04, 1e-3);
  EXPECT_EQ(input.area.outer.size(), 8u);  // edges longer than 500 m have a corner within
}

}  // namespace
}  // namespace greatx::scene::place
