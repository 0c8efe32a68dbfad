// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks what the input of a place offers: heights between samples, values of tags, and the area.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "scene/place/input/area_test.h"
#include "scene/place/input/osm_values.h"
#include "tests/scene/place/place_folder.h"

namespace greatx::scene::place {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A grid whose columns and rows are turned, sheared and slightly curved, as those of a file in degrees are.
dvec2 curved(double column, double row) {
  return {3.0 + 2.0 * column + 0.7 * row + 1e-3 * column * row + 2e-4 * column * column,
          -5.0 - 0.5 * column - 2.5 * row + 5e-4 * row * row};
}

HeightGrid grid_of(uint32_t columns, uint32_t rows, const std::function<double(uint32_t, uint32_t)>& z) {
  HeightGrid grid{columns, rows, {}, "grid"};
  for (uint32_t row = 0; row < rows; ++row)
    for (uint32_t column = 0; column < columns; ++column)
      grid.samples.emplace_back(curved(column, row), z(column, row));
  return grid;
}

/// Bilinear between the corners of a cell, the definition of HeightField::at.
dvec3 bilinear(const HeightGrid& grid, double column, double row) {
  const auto c = static_cast<uint32_t>(column), r = static_cast<uint32_t>(row);
  const auto sample = [&](uint32_t x, uint32_t y) { return grid.samples[size_t{y} * grid.columns + x]; };
  const double u = column - c, v = row - r;
  return (1 - u) * (1 - v) * sample(c, r) + u * (1 - v) * sample(c + 1, r) + (1 - u) * v * sample(c, r + 1) +
         u * v * sample(c + 1, r + 1);
}

TEST(HeightField, IsBilinearInCurvedCells) {
  const HeightGrid grid =
      grid_of(40, 30, [](uint32_t c, uint32_t r) { return std::sin(0.7 * c) + 0.1 * r * r; });
  HeightField field;
  field.add(grid);
  const auto fraction = [](uint32_t i, uint32_t k) {
    return std::fmod(0.61803398875 * (i + 1) * (k + 3), 1.0);
  };
  for (uint32_t i = 0; i < 2000; ++i) {
    const dvec3 point = bilinear(grid, 38.999 * fraction(i, 0), 28.999 * fraction(i, 1));
    const auto height = field.at(dvec2(point));
    ASSERT_TRUE(height) << i;
    EXPECT_NEAR(*height, point.z, 1e-9);
  }
  for (const dvec3& sample : grid.samples) {
    const auto height = field.at(dvec2(sample));
    ASSERT_TRUE(height);
    EXPECT_NEAR(*height, sample.z, 1e-9);
  }
}

TEST(HeightField, EndsHalfACellBeyondItsSamples) {
  HeightField field;
  field.add(grid_of(10, 10, [](uint32_t c, uint32_t) { return double(c); }));
  EXPECT_NEAR(field.at(curved(9.4, 3.0)).value(), 9.0, 1e-9);
  EXPECT_FALSE(field.at(curved(9.6, 3.0)));
  EXPECT_FALSE(field.at(curved(3.0, -0.6)));
  EXPECT_FALSE(field.at({1e6, 0.0}));
  EXPECT_FALSE(HeightField().at({0.0, 0.0}));
}

TEST(HeightField, CornersWithoutDataCountByHalfTheWeight) {
  HeightField field;
  field.add(grid_of(3, 2, [](uint32_t c, uint32_t) { return c == 2 ? nan : 10.0 + c; }));
  const HeightGrid& grid = field.grids()[0];
  EXPECT_NEAR(field.at(dvec2(0.7 * grid.samples[1] + 0.3 * grid.samples[2])).value(), 11.0, 1e-9);
  EXPECT_FALSE(field.at(dvec2(0.3 * grid.samples[1] + 0.7 * grid.samples[2])));
}

TEST(HeightField, TheEarlierGridCountsUnlessItHasNoData) {
  HeightField field;
  field.add(grid_of(5, 5, [](uint32_t c, uint32_t) { return c < 3 ? 1.0 : nan; }));
  field.add(grid_of(9, 5, [](uint32_t, uint32_t) { return 2.0; }));
  EXPECT_EQ(field.at(curved(1.0, 1.0)), 1.0);
  EXPECT_EQ(field.at(curved(4.0, 1.0)), 2.0);
  EXPECT_EQ(field.at(curved(7.0, 1.0)), 2.0);
}

TEST(HeightField, RefusesGridsWithoutArea) {
  HeightField field;
  EXPECT_THROW(field.add({1, 2, {{}, {}}, "a"}), ContractError);
  EXPECT_THROW(field.add({2, 2, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, "a"}), ContractError);
  EXPECT_THROW(field.add({2, 2, {{0, 0, 0}}, "a"}), ContractError);
}

TEST(OsmValues, LengthsInAllUnits) {
  const std::pair<const char*, double> good[] = {
      {"12.5", 12.5},     {"12 m", 12.0},     {"12m", 12.0},       {" 12,5 ", 12.5},   {"40 ft", 12.192},
      {"40'", 12.192},    {"40ft", 12.192},   {"5'6\"", 1.6764},   {"5' 6\"", 1.6764}, {"66\"", 1.6764},
      {"1.2 km", 1200.0}, {"-3", -3.0},       {"-5'6\"", -1.6764}, {"250 cm", 2.5},    {"3 in", 0.0762},
      {"10 yd", 9.144},   {"12 Meter", 12.0}, {"0", 0.0},          {"1e1", 10.0}};
  for (const auto& [text, metres] : good) {
    const auto length = parse_length_m(text);
    ASSERT_TRUE(length) << text;
    EXPECT_NEAR(*length, metres, 1e-12) << text;
  }
  for (const char* text : {"", "high", "12 floors", "12;14", "5'6", "~12", "12-14", "'", "\"", "nan", "inf",
                           "1,2,3", "5'-6\"", "0x10"})
    EXPECT_FALSE(parse_length_m(text)) << text;
  EXPECT_NEAR(parse_length_m("10", 0.3048).value(), 3.048, 1e-12);
  EXPECT_NEAR(parse_length_m("10 m", 0.3048).value(), 10.0, 1e-12);
}

TEST(OsmValues, Levels) {
  EXPECT_EQ(parse_levels("3"), 3.0);
  EXPECT_EQ(parse_levels("2.5"), 2.5);
  EXPECT_EQ(parse_levels("-1"), -1.0);
  for (const char* text : {"", "two", "1;2", "0-3", "3 floors"}) EXPECT_FALSE(parse_levels(text)) << text;
}

TEST(OsmValues, Directions) {
  const std::pair<const char*, double> good[] = {
      {"137", 137.0},      {"-90", 270.0}, {"360", 0.0},   {"137.5°", 137.5}, {"N", 0.0},
      {"NNE", 22.5},       {"sw", 225.0},  {"north", 0.0}, {"WNW", 292.5},    {"south-west", 225.0},
      {"NorthEast", 45.0}, {"E", 90.0},    {"east", 90.0}, {"nnw", 337.5}};
  for (const auto& [text, degrees] : good) EXPECT_EQ(parse_direction_deg(text), degrees) << text;
  for (const char* text : {"", "up", "NN", "forward", "N;S"}) EXPECT_FALSE(parse_direction_deg(text)) << text;
}

TEST(OsmValues, Colours) {
  using Rgb = std::array<unsigned char, 3>;
  EXPECT_EQ(parse_colour("#a0b0c0"), (Rgb{0xa0, 0xb0, 0xc0}));
  EXPECT_EQ(parse_colour("#AbC"), (Rgb{0xaa, 0xbb, 0xcc}));
  EXPECT_EQ(parse_colour("red"), (Rgb{255, 0, 0}));
  EXPECT_EQ(parse_colour("Light_Grey"), (Rgb{0xd3, 0xd3, 0xd3}));
  EXPECT_EQ(parse_colour("light grey"), (Rgb{0xd3, 0xd3, 0xd3}));
  EXPECT_EQ(parse_colour("yellowgreen"), (Rgb{0x9a, 0xcd, 0x32}));
  EXPECT_EQ(parse_colour("aliceblue"), (Rgb{0xf0, 0xf8, 0xff}));
  for (const char* text : {"", "#12", "#12345", "#gggggg", "reddish", "#+12345"})
    EXPECT_FALSE(parse_colour(text)) << text;
}

TEST(OsmValues, ListsAndNumbers) {
  EXPECT_EQ(list_values("a; b;;c "), (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_TRUE(list_values("").empty());
  EXPECT_TRUE(means_yes("yes") && means_yes("1") && !means_yes("no"));
  EXPECT_EQ(number_text(22.0), "22");
  EXPECT_EQ(number_text(0.1), "0.1");
}

TEST(AreaTest, KeepsWhatHasAPartInTheArea) {
  const AreaTest area({{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{4, 4}, {6, 4}, {6, 6}, {4, 6}}}});
  EXPECT_TRUE(area.contains({1, 1}));
  EXPECT_FALSE(area.contains({5, 5}));
  EXPECT_FALSE(area.contains({11, 5}));
  const auto line = [&](std::vector<dvec2> points, bool closed) { return area.meets_line(points, closed); };
  EXPECT_TRUE(line({{-5, 5}, {15, 5}}, false));  // no corner inside
  EXPECT_FALSE(line({{-5, 11}, {15, 11}}, false));
  EXPECT_FALSE(line({{4.5, 4.5}, {5.5, 5.5}}, false));  // in the hole alone
  EXPECT_FALSE(line({{-5, 5}, {-5, 20}, {5, 20}}, false));
  EXPECT_TRUE(line({{-5, 3}, {-5, 20}, {15, 20}}, true));  // its last side crosses a corner
  EXPECT_TRUE(area.meets(Polygon{{{-50, -50}, {50, -50}, {50, 50}, {-50, 50}}, {}}));  // around the area
  EXPECT_FALSE(area.meets(Polygon{{{-50, -50}, {50, -50}, {50, 50}, {-50, 50}},
                                  {{{-20, -20}, {20, -20}, {20, 20}, {-20, 20}}}}));  // its hole is around
  Feature solid;
  solid.faces.push_back({SolidFace::Kind::wall, {{{-1, 5, 0}, {1, 5, 0}, {1, 5, 9}, {-1, 5, 9}}}});
  EXPECT_TRUE(area.meets(solid));
  solid.faces[0].rings[0] = {{-3, 5, 0}, {-1, 5, 0}, {-1, 5, 9}};
  EXPECT_FALSE(area.meets(solid));
}

}  // namespace
}  // namespace greatx::scene::place
