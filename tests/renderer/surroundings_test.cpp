// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds bounced light and mirror images against closed forms and the path-traced reference.
#include "shaders/shared/surroundings.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <random>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include "renderer/light/light_gathering.h"
#include "renderer/light/surroundings_words.h"
#include "renderer/reference/reference_picture.h"
#include "tests/renderer/camera_rig.h"
#include "tests/renderer/columns.h"

namespace greatx::test {
namespace {

/// A street of 20 m along y between walls, white or of one colour, on a square of 128 m.
scene::Scene street(double wall_height, float wall_albedo, float ground_albedo, float roughness = 1.0f) {
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(optical_material("ground", ground_albedo)))
      .quad({-64, -64, 0}, {64, -64, 0}, {64, 64, 0}, {-64, 64, 0});
  const uint32_t wall = tiny.material_as(optical_material("wall", wall_albedo));
  const uint32_t smooth = tiny.material_as(optical_material("smooth", wall_albedo, 1.0f, roughness));
  tiny.object("west", 0, roughness < 1.0f ? smooth : wall).box({-40, -60, 0}, {-10, 60, wall_height});
  tiny.object("east", 0, wall).box({10, -60, 0}, {40, 60, wall_height});
  return tiny.build();
}

render::SurroundingLight sun_on_east() {
  render::SurroundingLight light;
  // Low in the west: it lights the east wall, whose normal is -x.
  light.key_direction = render::Lighting::direction(radians(180.0), radians(45.0));
  light.key_lux = dvec3(100000.0);
  return light;
}

TEST(Surroundings, ColumnsHaveTopsColoursWallsAndShadows) {
  const Columns columns(street(8.0, 0.6f, 0.3f), sun_on_east());
  EXPECT_NEAR(columns.at(0, 0).top, 0.0, 1e-4);
  EXPECT_FALSE(columns.at(0, 0).stands());
  EXPECT_NEAR(columns.at(0, 0).top_albedo.x, 0.3, 1e-6);
  const render::SurroundingCell wall = columns.at(10.0, 0);
  EXPECT_TRUE(wall.stands());
  EXPECT_NEAR(wall.top, 8.0, 1e-4);
  EXPECT_NEAR(wall.bottom, 0.0, 1e-4);
  EXPECT_NEAR(wall.wall_normal.x, -1.0, 1e-6);
  EXPECT_NEAR(wall.wall_albedo.y, 0.6, 1e-6);
  // At 45 degrees the shadow of 8 m ends 8 m from the west wall, within a cell.
  EXPECT_NEAR(columns.at(-5, 0).shadow, 3.0, 0.8);
  EXPECT_LT(columns.at(5, 0).shadow, 0.0);
}

TEST(Surroundings, TheUndersideOfTheGroundIsNotTheGround) {
  TinyScene tiny;
  tiny.object("soil", 0, tiny.material_as(optical_material("soil", 0.1f)))
      .quad({-32, -32, -1}, {-32, 32, -1}, {32, 32, -1}, {32, -32, -1});
  tiny.object("road", 0, tiny.material_as(optical_material("road", 0.4f)))
      .quad({-32, -32, 0}, {32, -32, 0}, {32, 32, 0}, {-32, 32, 0});
  const Columns columns(tiny.build());
  const render::SurroundingCell& cell = columns.at(0.0, 0.0);
  EXPECT_NEAR(cell.ground + columns.field.floor, 0.0, 1e-4);
  EXPECT_NEAR(cell.ground_albedo.x, 0.4, 1e-6);
}

TEST(Surroundings, GroundThatLooksDownAloneIsStillTheGround) {
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(optical_material("ground", 0.4f)))
      .quad({-32, -32, 2}, {-32, 32, 2}, {32, 32, 2}, {32, -32, 2});
  tiny.object("pit", 0).quad({31, 31, 0}, {32, 31, 0}, {32, 32, 0}, {31, 32, 0});
  const Columns columns(tiny.build());
  const render::SurroundingCell& cell = columns.at(0.0, 0.0);
  EXPECT_NEAR(cell.ground + columns.field.floor, 2.0, 1e-4);
  EXPECT_NEAR(cell.ground_albedo.x, 0.4, 1e-6);
}

TEST(Surroundings, AHouseWithoutAFloorStandsOnItsUnderside) {
  TinyScene tiny;
  tiny.quad({-32, -32, 0}, {0, -32, 0}, {0, 32, 0}, {-32, 32, 0});
  tiny.object("house").box({4, -8, 0}, {20, 8, 9});
  const Columns columns(tiny.build());
  const render::SurroundingCell& cell = columns.at(12.0, 0.0);
  EXPECT_TRUE(cell.stands());
  EXPECT_NEAR(cell.ground + columns.field.floor, 0.0, 1e-4);
}

TEST(Surroundings, WhatHangsInTheAirLeavesTheGroundFree) {
  TinyScene tiny;
  tiny.quad({-32, -32, 0}, {32, -32, 0}, {32, 32, 0}, {-32, 32, 0});
  tiny.object("crown").box({-3, -3, 4}, {3, 3, 9});
  const Columns columns(tiny.build());
  const render::SurroundingCell& cell = columns.at(0.0, 0.0);
  EXPECT_NEAR(cell.ground, 0.0, 1e-4);
  EXPECT_NEAR(cell.bottom, 4.0, 1e-4);
  EXPECT_NEAR(cell.top, 9.0, 1e-4);
}

TEST(Surroundings, BouncedLightOfALitWallIsThatOfItsFormFactor) {
  const double height = 12.0;
  const Columns columns(street(height, 0.5f, 0.0f), sun_on_east());
  // The wall's lit part sends albedo E cos(45) / pi. Its lower part lies in the shadow of the west wall,
  // which is 20 m away: nothing below -8 m, so all of it is lit.
  const double radiance = 0.5 * 100000.0 * std::cos(radians(45.0)) / pi;
  const render::BouncedLight light = render::LightGathering(columns.surroundings).at({0.0, 0.0}, 0.0);
  // An infinite wall seen from level ground: (1 - cos a) / 2; from a facing wall: sin(a) / 2.
  const double angle = std::atan(height / 10.0);
  EXPECT_NEAR(light.over_pi({0, 0, 1}).x / radiance, 0.5 * (1.0 - std::cos(angle)), 0.05);
  EXPECT_NEAR(light.over_pi({1, 0, 0}).x / radiance, 0.5 * std::sin(angle), 0.05);
  EXPECT_NEAR(light.over_pi({-1, 0, 0}).x / radiance, 0.0, 0.05);
}

TEST(Surroundings, OpenGroundSendsItsLightDownwardsOnly) {
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(optical_material("ground", 0.4f)))
      .quad({-128, -128, 0}, {128, -128, 0}, {128, 128, 0}, {-128, 128, 0});
  render::SurroundingLight light;
  light.key_lux = dvec3(50000.0);
  light.beyond = dvec3(0.4 * 50000.0 / pi);
  const Columns columns(tiny.build(), light);
  const render::BouncedLight bounced = render::LightGathering(columns.surroundings).at({0, 0}, 1.5);
  const double radiance = 0.4 * 50000.0 / pi;
  EXPECT_NEAR(bounced.over_pi({0, 0, -1}).x / radiance, 1.0, 0.02);
  EXPECT_NEAR(bounced.over_pi({1, 0, 0}).x / radiance, 0.5, 0.02);
  EXPECT_NEAR(bounced.over_pi({0, 0, 1}).x / radiance, 0.0, 0.02);
}

/// No ray of an octant meets a standing cell within the cells that are said to be free.
TEST(Surroundings, LeapsPassNothingThatStands) {
  TinyScene tiny;
  tiny.quad({-64, -64, 0}, {64, -64, 0}, {64, 64, 0}, {-64, 64, 0});
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int k = 0; k < 30; ++k) {
    const dvec3 at(120.0 * uniform(random) - 60.0, 120.0 * uniform(random) - 60.0, 0.0);
    tiny.box(at, at + dvec3(1.0 + 5.0 * uniform(random), 1.0 + 5.0 * uniform(random), 8.0));
  }
  const Columns columns(tiny.build());
  size_t free_cells = 0;
  for (uint32_t octant = 0; octant < 8; ++octant) {
    const std::vector<uint16_t> free = columns.surroundings.free_cells(octant);
    for (int k = 0; k < 2000; ++k) {
      // A slope of the octant, from anywhere in a cell.
      const bool along_y = (octant & shared::surroundings_along_y) != 0;
      dvec2 direction(1.0, uniform(random));
      if (along_y) direction = {direction.y, direction.x};
      if (octant & shared::surroundings_negative_x) direction.x = -direction.x;
      if (octant & shared::surroundings_negative_y) direction.y = -direction.y;
      const dvec2 from(uniform(random) * columns.field.width, uniform(random) * columns.field.height);
      const size_t cell = size_t(from.y) * columns.field.width + size_t(from.x);
      if (free[cell] == 0) continue;
      for (double t = 0.0; t <= free[cell] - 1.0; t += 0.05) {
        const dvec2 at = from + direction * t;
        if (at.x < 0.0 || at.y < 0.0 || at.x >= columns.field.width || at.y >= columns.field.height) break;
        ASSERT_FALSE(columns.surroundings.cell(uint32_t(at.x), uint32_t(at.y)).stands())
            << "octant " << octant << " from " << from.x << ", " << from.y << " after " << t;
        ++free_cells;
      }
    }
  }
  EXPECT_GT(free_cells, 100000u);
}

/// The bytes in which shaders read bounced light are within the steps that docs/global_light.md states.
TEST(Surroundings, StoredBouncedLightIsThatGathered) {
  render::SurroundingLight light = sun_on_east();
  light.key_lux = {100000.0, 80000.0, 50000.0};
  light.beyond = {3000.0, 4000.0, 5000.0};
  const Columns columns(street(12.0, 0.6f, 0.3f), light);
  const std::vector<uint32_t> words = render::surroundings_words(columns.surroundings, true);
  shared::SurroundingsHeader header;
  std::memcpy(&header, words.data(), sizeof header);
  const uint32_t column = header.place_columns / 2, row = header.place_rows / 2;
  const uint32_t* place = &words[2 * (header.first_place + shared::surroundings_place_pairs *
                                                               (row * header.place_columns + column))];
  // Each value is the median over the place and its neighbours.
  const render::LightGathering gathering(columns.surroundings);
  std::vector<render::BouncedLight> lows, highs;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const dvec2 middle = columns.field.corner + (dvec2(double(column) + x, double(row) + y) + 0.5) *
                                                      columns.field.cell_m *
                                                      double(shared::surroundings_place_cells);
      lows.push_back(gathering.at(middle, shared::surroundings_low));
      lows.back().facing[4] = gathering.on_ground(middle, 0.0);
      highs.push_back(gathering.at(middle, shared::surroundings_high));
    }
  const auto median = [&](std::vector<render::BouncedLight>& all) {
    render::BouncedLight light;
    for (size_t k = 0; k < light.facing.size(); ++k) {
      std::ranges::nth_element(all, all.begin() + 4, {}, [&](const render::BouncedLight& other) {
        return render::luminance(other.facing[k]);
      });
      light.facing[k] = all[4].facing[k];
    }
    return light;
  };
  const render::BouncedLight low = median(lows), high = median(highs);
  const auto luminance = [](const dvec3& rgb) { return glm::dot(rgb, dvec3(0.2126, 0.7152, 0.0722)); };
  const auto expect_light = [&](const render::BouncedLight& gathered, const uint32_t* stored) {
    const double c = glm::unpackHalf2x16(stored[0]).x;
    EXPECT_NEAR(c / luminance(gathered.constant()), 1.0, 1e-3);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(2.0 * glm::unpackSnorm4x8(stored[1])[axis], luminance(gathered.along(axis)) / c, 0.0082);
    // The step of a byte's square is 4 (2 b + 1) / 255^2.
    const double root = double(stored[1] >> 24) / 255.0, up = luminance(gathered.facing[4]) / c;
    EXPECT_NEAR(4.0 * root * root, up, 0.0162 * std::sqrt(up) + 2e-5);
  };
  ASSERT_GT(luminance(low.constant()), 100.0);
  expect_light(low, place);
  expect_light(high, place + 2);
  const dvec3 sum = low.constant() + high.constant();
  const vec4 root = 2.0f * glm::unpackUnorm4x8(place[0]);
  EXPECT_NEAR(root.z * root.z, sum.r / luminance(sum), 0.01);
  EXPECT_NEAR(root.w * root.w, sum.b / luminance(sum), 0.01);
  EXPECT_NEAR(glm::unpackHalf2x16(place[2]).y, 0.0, 1e-3);
}

/// Returns the errors of a picture of the street, in the shade, against a reference of one bounce.
render::ReferenceError error_of(const scene::Scene& scene, const render::CameraEffects& effects,
                                const Pose& eye, bool shade_alone) {
  render::Lighting lighting = plain_light(180.0, 45.0);
  render::CameraDesc desc = plain_camera(24);
  desc.outputs = {};
  desc.outputs.hdr = true;
  const render::CameraImages images = CameraRig(scene, lighting, desc, effects).shoot(eye);
  render::ReferenceOptions options;
  options.samples = 64;
  options.paths.bounces = 1;
  const std::vector<Pose> poses(scene.bodies.size());
  const render::ReferencePicture reference =
      render::trace_reference(scene, poses, lighting, effects, desc, eye, options);
  std::vector<uint8_t> counted(reference.coverage.size());
  for (size_t i = 0; i < counted.size(); ++i)
    counted[i] = reference.coverage[i] >= 1.0f && (!shade_alone || reference.key_share[i] < 0.01f);
  return render::compare_with(reference, images.hdr, counted, 1e5);
}

TEST(Surroundings, BouncedLightBringsTheShadeOfAStreetNearerToTheReference) {
  const scene::Scene scene = street(12.0, 0.6f, 0.3f);
  render::CameraEffects effects = lambertian();
  effects.ambient_occlusion = true;
  const Pose eye = look({4.0, 0, 2.0}, 160.0, -10.0);  // to the west wall, which lies in the shade
  const render::ReferenceError without = error_of(scene, effects, eye, true);
  effects.bounced_light = true;
  const render::ReferenceError with = error_of(scene, effects, eye, true);
  ASSERT_GT(with.pixels, 100u);
  EXPECT_LT(with.rmse, 0.35);  // docs/global_light.md
  EXPECT_LT(with.rmse, without.rmse);
  EXPECT_LT(std::abs(with.bias), 0.15);
  std::cout << fmt::format("bounced light: rmse {:.3f}, bias {:+.3f} without; {:.3f}, {:+.3f} with\n",
                           without.rmse, without.bias, with.rmse, with.bias);
}

TEST(Surroundings, GlassMirrorsTheOtherSideOfTheStreet) {
  const scene::Scene scene = street(12.0, 0.6f, 0.3f, 0.1f);
  render::CameraEffects effects;
  effects.ambient_occlusion = effects.bounced_light = true;
  const Pose eye = look({4.0, 0, 2.0}, 160.0, -5.0);
  const render::ReferenceError without = error_of(scene, effects, eye, false);
  effects.glass = true;
  const render::ReferenceError with = error_of(scene, effects, eye, false);
  EXPECT_GT(without.rmse, 0.4);
  EXPECT_LT(with.rmse, 0.65 * without.rmse);  // docs/global_light.md
  std::cout << fmt::format("glass: rmse {:.3f} without, {:.3f} with\n", without.rmse, with.rmse);
}

}  // namespace
}  // namespace greatx::test
