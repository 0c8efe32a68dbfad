// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests pictures of radio maps: a pixel shows the place that it stands for.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "draw/map/background.h"
#include "draw/paths/render.h"
#include "scene/description/scene_hash.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::apps {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// A grid of 30 x 20 cells of 2 m, away from the origin.
const sim::MapGrid grid = sim::make_map_grid({500, -120}, {560, -80}, 2.0, 1);

sim::MapCells free_cells(double z) {
  sim::MapCells cells;
  cells.grid = grid;
  cells.z_m.assign(grid.cells(), z);
  cells.placement.assign(grid.cells(), sim::CellPlacement::free);
  return cells;
}

TEST(MapView, PixelsShowTheGridAndNothingElse) {
  const MapPixels pixels = map_pixels(grid, 300);
  EXPECT_EQ(pixels.width, 300u);
  EXPECT_EQ(pixels.height, 200u);
  EXPECT_EQ(pixels.at({500, -80}), dvec2(0, 0));  // north-western corner
  EXPECT_EQ(pixels.at({560, -120}), dvec2(300, 200));
  EXPECT_EQ(pixels.at(grid.center(0)), dvec2(5, 195));
  EXPECT_EQ(map_pixels(grid, 299).width, 270u);  // a cell has a whole number of pixels
  EXPECT_EQ(map_pixels(grid, 15).width, 15u);
  EXPECT_EQ(map_pixels(grid, 15).height, 10u);
}

TEST(MapView, WhatStandsInTheSceneIsShownWithinTheBound) {
  const MapPixels pixels = map_pixels(grid, 900);
  const dvec3 origin(530, -100, 3);
  for (const double shift : {0.5, 0.05}) {
    const PictureView view = top_view(pixels, origin, 1.5, -4.0, 60.0, shift);
    double most = 0.0;
    for (double x = 500; x <= 560; x += 7.5)
      for (double y = -120; y <= -80; y += 5)
        for (const double z : {-4.0, 1.5, 20.0, 60.0}) {
          const dvec3 seen = view.project(dvec3(x, y, z) - origin);
          const dvec2 off = (dvec2(seen) - pixels.at({x, y})) / 15.0;  // metres: a cell of 2 m has 30 pixels
          EXPECT_LE(glm::length(off), z == 1.5 ? 1e-8 : shift * (1.0 + 1e-9));
          most = std::max(most, glm::length(off));
          EXPECT_GT(seen.z, view.near_m);
        }
    EXPECT_GT(most, 0.5 * shift);  // the camera is no higher than needed
  }
}

/// Compares the heights of a box on the ground, as the camera sees them pixel by pixel, with the outline of
/// the box in the world.
TEST(MapBackground, ABoxStandsWhereItIs) {
  scene::Material concrete;
  concrete.name = "concrete";
  concrete.radio.emplace().layers.push_back({*scene::itu_medium("concrete"), 0.0});
  test::TinyScene tiny;
  const uint32_t material = tiny.material_as(concrete);
  tiny.object("ground", 0, material).quad({490, -130, 1}, {570, -130, 1}, {570, -70, 1}, {490, -70, 1});
  tiny.object("box", 0, material).box({510, -110, 1}, {524, -96, 26});
  scene::Scene scene = tiny.build({530, -100, 0});
  scene.hash = scene::hash_of(scene);
  sim::Scenario scenario = sim::parse_scenario(
      "greatx: 1\nname: test\nticks: 1\ntick_rate_hz: 1\nnodes:\n"
      "  - {name: bs, trajectory: {type: static, position_m: [550, -90, 9]}, sensors: [{name: a, type: "
      "antenna}]}\n"
      "  - {name: ue, trajectory: {type: static, position_m: [540, -90, 3]}, sensors: [{name: a, type: "
      "antenna}]}\n"
      "channels:\n  - {name: csi, tx: bs/a, rx: [ue/a], rate_hz: 1, subcarriers: 4, bandwidth_hz: 20e6, "
      "max_depth: 0}\neffects: {line_of_sight: on}\n",
      "test.yaml", ".");
  sim::Experiment experiment = sim::make_experiment(
      std::move(scenario), std::make_shared<const sim::World>(sim::World{scene, {0, 0}, {}, {}, {}}));
  experiment.plan = picture_plan(experiment);
  sim::ChannelSnapshot snapshot(test::device(), experiment, 0, {});
  const sim::MapCells cells = free_cells(2.5);
  const MapBackground background = map_background(cells, experiment.plan, snapshot, 300);
  ASSERT_EQ(background.z_m.size(), 300u * 200u);
  for (uint32_t y = 0; y < 200; ++y)
    for (uint32_t x = 0; x < 300; ++x) {
      const dvec2 at(500 + (x + 0.5) / 5.0, -80 - (y + 0.5) / 5.0);
      const double off = std::max({510 - at.x, at.x - 524, -110 - at.y, at.y + 96});
      if (std::abs(off) < 0.5) continue;  // the bound is a quarter of a cell
      EXPECT_NEAR(background.z_m[y * 300 + x], off < 0 ? 26.0 : 1.0, 0.01) << at.x << ", " << at.y;
    }
}

TEST(MapScale, LeavesOutTheEndsOnlyWhereTheyWouldTakeTheColours) {
  std::vector<double> values;
  for (int i = 0; i <= 1000; ++i) values.push_back(-100.0 + 0.05 * i);
  const MapScale even = map_scale(values);
  EXPECT_EQ(even.scale.low, -100.0);
  EXPECT_EQ(even.scale.high, -50.0);
  EXPECT_FALSE(even.clipped_low || even.clipped_high);
  values.insert(values.end(), {-240.0, -inf, inf, std::nan("")});
  const MapScale low = map_scale(values);
  EXPECT_TRUE(low.clipped_low);
  EXPECT_FALSE(low.clipped_high);
  EXPECT_NEAR(low.scale.low, -99.5, 0.2);
  EXPECT_EQ(low.scale.high, -50.0);
  EXPECT_LT(map_scale(std::vector<double>{3.0, 3.0}).scale.low,
            map_scale(std::vector<double>{3.0}).scale.high);
  EXPECT_LT(map_scale({}).scale.low, map_scale({}).scale.high);
}

/// Returns the colour of a pixel of the map area. draw_map() puts the area's top left corner at (104, 66).
io::Color pixel_of(const Array& image, const dvec2& pixel) {
  const auto x = static_cast<int64_t>(pixel.x) + 104, y = static_cast<int64_t>(pixel.y) + 66;
  const uint8_t* c = &image.as<uint8_t>()[static_cast<size_t>(3 * (y * image.shape[1] + x))];
  return {c[0], c[1], c[2]};
}
bool same(io::Color a, io::Color b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

TEST(DrawMap, ACellHasItsColourWhereItIs) {
  sim::MapCells cells = free_cells(1.5);
  cells.placement[7] = sim::CellPlacement::solid;
  MapStage stage;
  stage.cells = &cells;
  stage.background.pixels = map_pixels(grid, 300);
  stage.background.rgb.assign(300 * 200 * 3, 200);
  stage.background.z_m.assign(300 * 200, 0.0f);
  MapLayer layer;
  layer.unit = "dB";
  for (size_t cell = 0; cell < grid.cells(); ++cell) layer.values.push_back(static_cast<double>(cell));
  layer.values[7] = layer.values[40] = std::nan("");
  const Array image = draw_map(stage, layer);
  const MapScale scale = map_scale(layer.values);
  for (size_t cell = 0; cell < grid.cells(); ++cell) {
    const io::Color color = pixel_of(image, stage.background.pixels.at(grid.center(cell)));
    if (cell == 7 || cell == 40) continue;
    EXPECT_TRUE(same(color, io::viridis(scale.scale.at(layer.values[cell])))) << cell;
  }
  const io::Color inside = pixel_of(image, stage.background.pixels.at(grid.center(7))),
                  dark = pixel_of(image, stage.background.pixels.at(grid.center(40)));
  EXPECT_GT(inside.g, 60);  // the colour of the scene itself
  EXPECT_FALSE(same(inside, dark));
  // A step in the height of the scene is outlined, also between cells of equal colour.
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 100; ++x) stage.background.z_m[static_cast<size_t>(300 * y + x)] = 9.0f;
  const Array outlined = draw_map(stage, layer);
  EXPECT_FALSE(same(pixel_of(outlined, {99, 55}), pixel_of(image, {99, 55})));
  EXPECT_TRUE(same(pixel_of(outlined, {97, 55}), pixel_of(image, {97, 55})));
}

}  // namespace
}  // namespace greatx::apps
