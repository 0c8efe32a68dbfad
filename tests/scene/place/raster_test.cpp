// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks terrain and surfaces: formats, voids, tiles, units, and what does not fit.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/place/place_folder.h"
#include "tests/scene/place/raster_writer.h"

namespace greatx::scene::place {
namespace {

using test::ascii_grid;
using test::findings_of;
using test::message_of;
using test::PlaceFolder;
using test::TiffOptions;
using test::write_raster;
using testing::AllOf;
using testing::HasSubstr;

/// A slope: 10 m plus 2 m per 0.001 degrees east and 3 m per 0.001 degrees north of (10, 48).
double slope(double longitude, double latitude) {
  return 10.0 + 2000.0 * (longitude - 10.0) + 3000.0 * (latitude - 48.0);
}

/// Expects the slope's heights at points of the area, bilinear in cells of 0.001 degrees (a plane is exact).
void expect_slope(const PlaceInput& input, double tolerance = 0.01) {
  const LocalFrame frame(input.reference);
  for (const dvec2 step :
       {dvec2(-200, -150), dvec2(0, 0), dvec2(190, 160), dvec2(30, -170), dvec2(0.5, 0.5)}) {
    const auto z = input.terrain.at(step);
    ASSERT_TRUE(z) << step.x;
    const Geodetic place = frame.datum_place({step, *z});
    EXPECT_NEAR(place.height_m, slope(place.longitude_deg, place.latitude_deg), tolerance)
        << step.x << " " << step.y;
  }
}

const std::string terrain_area = "area: {bounds_deg: [48.002, 10.002, 48.008, 10.008]}\n";

TEST(PlaceTerrain, EveryFormatGivesTheSameHeights) {
  const PlaceFolder folder;
  const auto centre_value = [](int, int column, int row) {
    return slope(10.0 + (column + 0.5) * 0.001, 48.01 - (row + 0.5) * 0.001);
  };
  write_raster(folder.path("t.tif"), "GTiff", 1, 10, 10, 10.0, 48.01, 0.001, {}, centre_value);
  TiffOptions point;
  point.pixel_is_point = true;
  write_raster(folder.path("p.tif"), "GTiff", 1, 10, 10, 10.0, 48.01, 0.001, point, centre_value);
  folder.write("t.asc", ascii_grid(10, 10, 10.0, 48.0, 0.001, [&](int column, int row) {
                 return fmt::format("{:.6f}", centre_value(0, column, row));
               }));
  for (const char* file : {"{file: t.tif}", "{file: p.tif}", "{file: t.asc, crs: \"EPSG:4326\"}"}) {
    const PlaceInput input = folder.read(terrain_area + "terrain: [" + file + "]\n");
    ASSERT_EQ(input.terrain.grids().size(), 1u);
    expect_slope(input, 0.001);
    EXPECT_TRUE(input.findings.empty()) << input.findings[0].topic << ": " << input.findings[0].detail;
  }
}

TEST(PlaceTerrain, HgtFilesHaveSamplesOnTheirEdges) {
  const PlaceFolder folder;
  // SRTM3: 1201 x 1201 samples of 16 bits, most significant byte first, rows from the north.
  std::string bytes;
  for (int row = 0; row < 1201; ++row)
    for (int column = 0; column < 1201; ++column) {
      const int height = (row == 600 && column == 600) ? -32768 : static_cast<int>(100 + column);
      bytes += static_cast<char>(height >> 8 & 0xff);
      bytes += static_cast<char>(height & 0xff);
    }
  folder.write("S34E151.hgt", bytes);
  const PlaceInput input =
      folder.read("area: {bounds_deg: [-33.51, 151.49, -33.49, 151.51]}\nterrain: [{file: S34E151.hgt}]\n");
  const LocalFrame frame(input.reference);
  size_t edge = 0;
  for (const dvec3& sample : input.terrain.grids().at(0).samples) {
    const Geodetic place = frame.datum_place(sample);
    const double column = (place.longitude_deg - 151.0) * 1200.0, row = (-33.0 - place.latitude_deg) * 1200.0;
    EXPECT_NEAR(column, std::round(column), 1e-4);
    EXPECT_NEAR(row, std::round(row), 1e-4);
    edge += std::abs(place.height_m - (100.0 + std::round(column))) < 1e-3;
  }
  // One sample has no data, and gets a height between those of its neighbours.
  EXPECT_EQ(edge, input.terrain.grids()[0].samples.size() - 1);
  const dvec3 filled_at = frame.local_of_datum({-33.5, 151.5, 700.0});
  EXPECT_NEAR(input.terrain.at(dvec2(filled_at)).value(), filled_at.z, 1.0);
  EXPECT_LT(edge, 40u * 40u);  // only the area and its margin are read
  const auto filled = findings_of(input, "terrain_void_filled");
  ASSERT_EQ(filled.size(), 1u);
  EXPECT_THAT(filled[0].detail, AllOf(HasSubstr("1 of "), HasSubstr("at most 1 samples away")));
}

TEST(PlaceTerrain, TilesSideBySideHaveNoGap) {
  const PlaceFolder folder;
  const auto tile = [&](const char* name, double left, int columns, bool no_data_column) {
    TiffOptions options;
    options.no_data = -32768.0;
    write_raster(folder.path(name), "GTiff", 1, columns, 10, left, 48.01, 0.001, options,
                 [&](int, int column, int row) {
                   if (no_data_column && column == columns - 1) return -32768.0;
                   return slope(left + (column + 0.5) * 0.001, 48.01 - (row + 0.5) * 0.001);
                 });
  };
  tile("west.tif", 10.0, 5, false);
  tile("east.tif", 10.005, 5, false);
  PlaceInput input = folder.read(terrain_area + "terrain: [{file: west.tif}, {file: east.tif}]\n");
  EXPECT_EQ(input.terrain.grids().size(), 1u);
  EXPECT_EQ(input.terrain.grids()[0].source, "west.tif + east.tif");
  expect_slope(input, 0.001);
  EXPECT_TRUE(input.findings.empty());
  // They overlap in one column, which has no data in the first one.
  tile("west.tif", 10.0, 6, true);
  input = folder.read(terrain_area + "terrain: [{file: west.tif}, {file: east.tif}]\n");
  expect_slope(input, 0.001);
  EXPECT_TRUE(input.findings.empty());
  // Tiles whose pixels do not lie on one lattice stay apart, and meet within half a pixel.
  write_raster(folder.path("east.tif"), "GTiff", 1, 9, 20, 10.0045, 48.01, 0.0006, {},
               [](int, int column, int row) {
                 return slope(10.0045 + (column + 0.5) * 0.0006, 48.01 - (row + 0.5) * 0.0006);
               });
  input = folder.read(terrain_area + "terrain: [{file: west.tif}, {file: east.tif}]\n");
  EXPECT_EQ(input.terrain.grids().size(), 2u);
  expect_slope(input, 1.01);  // half a cell of the slope, 0.0005 degrees
}

TEST(PlaceTerrain, TilesOnBothSidesOfTheAntimeridianMeet) {
  const PlaceFolder folder;
  const auto height = [](double longitude) { return 100.0 + 1000.0 * (longitude - 180.0); };
  write_raster(folder.path("west.tif"), "GTiff", 1, 10, 10, 179.99, -16.5, 0.001, {},
               [&](int, int column, int) { return height(179.99 + (column + 0.5) * 0.001); });
  write_raster(folder.path("east.tif"), "GTiff", 1, 10, 10, -180.0, -16.5, 0.001, {},
               [&](int, int column, int) { return height(180.0 + (column + 0.5) * 0.001); });
  const PlaceInput input = folder.read(
      "area: {bounds_deg: [-16.508, 179.995, -16.502, -179.995]}\nterrain: [{file: west.tif}, {file: "
      "east.tif}]\n");
  EXPECT_EQ(std::abs(input.reference.origin.longitude_deg), 180.0);
  EXPECT_EQ(input.terrain.grids().size(), 1u);
  EXPECT_TRUE(input.findings.empty());
  const LocalFrame frame(input.reference);
  for (const double x : {-400.0, -50.0, -1.0, 0.0, 1.0, 50.0, 400.0}) {
    const double z = input.terrain.at({x, 0.0}).value();
    const Geodetic place = frame.datum_place({x, 0.0, z});
    const double longitude = place.longitude_deg < 0.0 ? place.longitude_deg + 360.0 : place.longitude_deg;
    EXPECT_NEAR(place.height_m, height(longitude), 0.001) << x;
  }
}

TEST(PlaceTerrain, VoidsAndOutliersAreCountedAndFilled) {
  const PlaceFolder folder;
  TiffOptions options;
  options.no_data = -9999.0;
  write_raster(folder.path("t.tif"), "GTiff", 1, 10, 10, 10.0, 48.01, 0.001, options,
               [](int, int column, int row) {
                 if (column == 5 && row == 5) return -9999.0;
                 if (column == 3 && row == 4) return 2000.0;
                 if (column == 4 && row == 6) return -77.0;
                 return 50.0;
               });
  const PlaceInput input =
      folder.read(terrain_area + "terrain: [{file: t.tif, name: dgm, valid_m: [-20, 500], no_data: -77}]\n");
  ASSERT_EQ(findings_of(input, "heights_not_valid").size(), 1u);
  EXPECT_THAT(findings_of(input, "heights_not_valid")[0].detail,
              AllOf(HasSubstr("1 of 100"), HasSubstr("2000 m")));
  ASSERT_EQ(findings_of(input, "terrain_void_filled").size(), 1u);
  EXPECT_THAT(findings_of(input, "terrain_void_filled")[0].detail, HasSubstr("3 of 36 samples within"));
  EXPECT_EQ(findings_of(input, "terrain_void_filled")[0].object, "dgm");
  const LocalFrame frame(input.reference);
  for (const dvec3& sample : input.terrain.grids()[0].samples)
    EXPECT_NEAR(frame.datum_place(sample).height_m, 50.0, 1e-3);
}

TEST(PlaceTerrain, SpikesAreNamedAndKept) {
  const PlaceFolder folder;
  // Cells of 74 x 111 m: a slope of 45 degrees is none, a tower of 300 m is one.
  write_raster(
      folder.path("t.tif"), "GTiff", 1, 10, 10, 10.0, 48.01, 0.001, {},
      [](int, int column, int row) { return 100.0 * column + (column == 5 && row == 5 ? 300.0 : 0.0); });
  const PlaceInput input = folder.read(terrain_area + "terrain: [{file: t.tif}]\n");
  ASSERT_EQ(findings_of(input, "terrain_spike").size(), 1u);
  EXPECT_THAT(findings_of(input, "terrain_spike")[0].detail,
              AllOf(HasSubstr("1 samples"), HasSubstr("m at most")));
  EXPECT_EQ(input.findings.size(), 1u);
}

TEST(PlaceTerrain, ACoordinateSystemFarFromItsAreaIsDoubtful) {
  const PlaceFolder folder;
  // Easting and northing of Berlin in the wrong order.
  folder.write("s.asc", ascii_grid(20, 20, 5'820'000, 392'000, 10, [](int, int) { return "5"; }));
  folder.write("g.asc", ascii_grid(20, 20, 392'000, 5'820'000, 10, [](int, int) { return "5"; }));
  const auto count = [&](const char* file) {
    const PlaceInput input = folder.read(
        fmt::format("area: {{extent_of: {0}}}\nterrain: [{{file: {0}, crs: \"EPSG:25833\"}}]\n", file));
    return findings_of(input, "crs_outside_its_area").size();
  };
  EXPECT_EQ(count("g.asc"), 0u);
  EXPECT_EQ(count("s.asc"), 1u);
}

TEST(PlaceTerrain, AnOriginInAVoidTakesTheNearestSample) {
  const PlaceFolder folder;
  folder.write(
      "t.asc", ascii_grid(9, 9, 10.0, 48.0, 0.001, [](int column, int row) {
        return std::abs(column - 4) < 2 && std::abs(row - 4) < 2 ? "-9999" : column < 4 ? "70" : "80";
      }));
  const PlaceInput input = folder.read(
      "area: {bounds_deg: [48.0, 10.0, 48.009, 10.009]}\nterrain: [{file: t.asc, crs: \"EPSG:4326\"}]\n");
  ASSERT_EQ(findings_of(input, "origin_height").size(), 1u);
  // Two columns are 149 m away, one of 70 and one of 80 m.
  EXPECT_THAT(findings_of(input, "origin_height")[0].detail, HasSubstr("149."));
  EXPECT_TRUE(input.reference.origin.height_m == 70.0 || input.reference.origin.height_m == 80.0);
}

TEST(PlaceTerrain, UnitsOfTheFileAndOfTheSource) {
  const PlaceFolder folder;
  TiffOptions options;
  const auto write = [&](const char* name, const std::string& unit) {
    options.unit = unit;
    write_raster(folder.path(name), "GTiff", 1, 10, 10, 10.0, 48.01, 0.001, options,
                 [](int, int, int) { return 100.0; });
  };
  write("none.tif", "");
  write("ft.tif", "ft");
  write("odd.tif", "fathom");
  const auto height = [&](const std::string& terrain) {
    const PlaceInput input = folder.read(terrain_area + "terrain: [" + terrain + "]\n");
    return LocalFrame(input.reference).datum_place({0.0, 0.0, input.terrain.at({0.0, 0.0}).value()}).height_m;
  };
  EXPECT_NEAR(height("{file: none.tif}"), 100.0, 1e-3);
  EXPECT_NEAR(height("{file: none.tif, unit: ft}"), 30.48, 1e-3);
  EXPECT_NEAR(height("{file: ft.tif}"), 30.48, 1e-3);
  EXPECT_NEAR(height("{file: ft.tif, unit: ft}"), 30.48, 1e-3);
  EXPECT_THAT(message_of([&] { height("{file: ft.tif, unit: m}"); }),
              AllOf(HasSubstr("ft.tif: unit"), HasSubstr("0.3048")));
  EXPECT_THAT(message_of([&] { height("{file: odd.tif}"); }), HasSubstr("fathom"));
  EXPECT_NEAR(height("{file: odd.tif, unit: m}"), 100.0, 1e-3);
}

TEST(PlaceTerrain, WhatDoesNotFitIsNamed) {
  const PlaceFolder folder;
  const auto flat = [](int, int, int) { return 5.0; };
  write_raster(folder.path("half.tif"), "GTiff", 1, 5, 10, 10.0, 48.01, 0.001, {}, flat);
  write_raster(folder.path("far.tif"), "GTiff", 1, 5, 10, 20.0, 48.01, 0.001, {}, flat);
  const PlaceInput input = folder.read(terrain_area + "terrain: [{file: half.tif}, {file: far.tif}]\n");
  ASSERT_EQ(findings_of(input, "terrain_does_not_cover").size(), 1u);
  EXPECT_THAT(findings_of(input, "terrain_does_not_cover")[0].detail, HasSubstr("50.0 %"));
  EXPECT_EQ(findings_of(input, "terrain_outside").size(), 1u);
  EXPECT_THAT(message_of([&] { folder.read(terrain_area + "terrain: [{file: far.tif}]\n"); }),
              HasSubstr("no file has a height"));
  folder.write("n.asc", ascii_grid(5, 5, 10.0, 48.0, 0.002, [](int, int) { return "1"; }));
  EXPECT_THAT(message_of([&] { folder.read(terrain_area + "terrain: [{file: n.asc}]\n"); }),
              AllOf(HasSubstr("n.asc"), HasSubstr("no coordinate system"), HasSubstr("crs")));
  EXPECT_THAT(
      message_of([&] { folder.read(terrain_area + "terrain: [{file: n.asc, crs: EPSG:99999999}]\n"); }),
      HasSubstr("EPSG:99999999"));
  TiffOptions plain;
  plain.type = GDT_Byte;
  write_raster(folder.path("rgb.tif"), "GTiff", 3, 10, 10, 10.0, 48.01, 0.001, plain, flat);
  EXPECT_THAT(message_of([&] { folder.read(terrain_area + "terrain: [{file: rgb.tif}]\n"); }),
              HasSubstr("found 3 bands"));
  folder.write("x.tif", "no raster");
  EXPECT_THAT(message_of([&] { folder.read(terrain_area + "terrain: [{file: x.tif}]\n"); }),
              HasSubstr("expected a raster"));
  // Latitude first: the file lies at 10 N, 48 E.
  write_raster(folder.path("swapped.tif"), "GTiff", 1, 5, 10, 48.0, 10.01, 0.001, {}, flat);
  EXPECT_THAT(message_of([&] { folder.read(terrain_area + "terrain: [{file: swapped.tif}]\n"); }),
              AllOf(HasSubstr("no file has a height"), HasSubstr("swapped.tif covers latitude 10.00000"),
                    HasSubstr("seem to be swapped")));
}

TEST(PlaceTerrain, SurfacesKeepTheirVoids) {
  const PlaceFolder folder;
  TiffOptions options;
  options.no_data = 0.0;
  write_raster(folder.path("t.tif"), "GTiff", 1, 10, 10, 10.0, 48.01, 0.001, {},
               [](int, int, int) { return 50.0; });
  write_raster(folder.path("s.tif"), "GTiff", 1, 10, 10, 10.0, 48.01, 0.001, options,
               [](int, int column, int row) { return column == 5 && row == 5 ? 0.0 : 60.0; });
  const PlaceInput input = folder.read(terrain_area + "terrain: [{file: t.tif}]\nsurface: [{file: s.tif}]\n");
  EXPECT_EQ(findings_of(input, "surface_void").size(), 1u);
  size_t voids = 0;
  for (const dvec3& sample : input.surface.grids().at(0).samples) voids += std::isnan(sample.z);
  EXPECT_EQ(voids, 1u);
  EXPECT_NEAR(input.surface.at({-100.0, 100.0}).value() - input.terrain.at({-100.0, 100.0}).value(), 10.0,
              1e-3);
}

}  // namespace
}  // namespace greatx::scene::place
