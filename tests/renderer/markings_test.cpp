// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks markings that are thinner than a pixel: their share of the ground, and that they do not flicker.
#include <cmath>

#include <gtest/gtest.h>

#include "renderer/surface/mark_map.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

constexpr double line_m = 0.12, road_m = 12.0, length_m = 400.0;

/// A road along x with two lines of 12 cm along it and dashes of 3 m every 9 m between them, cut out of it as
/// the generator does.
scene::Scene road() {
  TinyScene tiny;
  const uint32_t asphalt = tiny.material_as(optical_material("asphalt", 0.1f)),
                 paint = tiny.material_as(optical_material("paint", 0.7f));
  const auto strip = [&](const char* name, uint32_t material, double x0, double x1, double y0, double y1) {
    tiny.object(name, 0, material).quad({x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0});
  };
  const double h = 0.5 * road_m, w = 0.5 * line_m;
  strip("road", asphalt, 0, length_m, -h, -3 - w);
  strip("line", paint, 0, length_m, -3 - w, -3 + w);
  strip("road", asphalt, 0, length_m, -3 + w, -w);
  for (double x = 0; x < length_m; x += 9.0) {
    strip("line", paint, x, std::min(x + 3.0, length_m), -w, w);
    strip("road", asphalt, std::min(x + 3.0, length_m), std::min(x + 9.0, length_m), -w, w);
  }
  strip("road", asphalt, 0, length_m, w, 3 - w);
  strip("line", paint, 0, length_m, 3 - w, 3 + w);
  strip("road", asphalt, 0, length_m, 3 + w, h);
  scene::Scene scene = tiny.build();
  for (scene::Instance& instance : scene.instances)
    instance.semantic_class =
        instance.name.starts_with("line") ? scene::SemanticClass::lane_marking : scene::SemanticClass::road;
  return scene;
}

TEST(Markings, SharesAddUpToTheirArea) {
  const scene::Scene scene = road();
  const double painted = line_m * (2.0 * length_m + 45.0 * 3.0);  // the 45th dash ends at 399 m
  for (const uint32_t most : {4096u, 640u}) {
    const render::MarkShares map = render::mark_shares(scene, most);
    double sum = 0.0;
    for (const float share : map.shares) {
      ASSERT_GE(share, 0.0f);
      ASSERT_LE(share, 1.0f);
      sum += double(share);
    }
    EXPECT_NEAR(sum * map.texel_m * map.texel_m / painted, 1.0, 1e-4) << most;
  }
}

/// Returns the mean and the variance, over small turns of the camera, of the radiance of a patch of far road:
/// its columns span the road, its rows 60 m to 200 m.
struct Flicker {
  double mean = 0.0, deviation = 0.0, expected = 0.0;
};
Flicker flicker(bool markings) {
  render::CameraEffects effects = lambertian();
  effects.markings = markings;
  effects.static_shadows = false;
  render::CameraDesc desc = plain_camera(128);
  desc.smooth_edges = true;
  CameraRig rig(road(), plain_light(0.0, 90.0), desc, effects);
  const double level = (1e5 + 15000.0) / pi;
  Flicker result;
  std::vector<double> values;
  constexpr int turns = 24;
  for (int k = 0; k < turns; ++k) {
    // A pixel is 0.9 degrees wide. The camera turns by up to one, and nods by a tenth.
    const Pose eye = look({-20.0, 0.4, 6.0}, 0.9 * k / turns, 0.09 * ((7 * k) % turns) / turns);
    const render::CameraImages images = rig.shoot(eye);
    double sum = 0.0, expected = 0.0, weight = 0.0;
    for (uint32_t row = 0; row < desc.height; ++row)
      for (uint32_t column = 0; column < desc.width; ++column) {
        const size_t i = row * desc.width + column;
        if (images.instance[i] == 0) continue;
        const dvec3 p = eye.apply(pixel_ray(desc, column, row) * double(images.depth[i]));
        if (p.x < 60.0 || p.x > 200.0 || std::abs(p.y) > 5.0) continue;
        // Each pixel counts by the ground that it covers.
        const double area = std::pow(double(images.depth[i]), 3.0);
        sum += area * luminance_at(images, i);
        weight += area;
      }
    // Of 10 m of road, two lines and a third of one are painted.
    const double share = line_m * (2.0 + 1.0 / 3.0) / 10.0;
    expected = level * (0.1 * (1.0 - share) + 0.7 * share);
    values.push_back(sum / weight / expected);
  }
  for (const double value : values) result.mean += value / turns;
  for (const double value : values) result.deviation += (value - result.mean) * (value - result.mean) / turns;
  result.deviation = std::sqrt(result.deviation);
  result.expected = 1.0;
  return result;
}

TEST(Markings, FarOnesKeepTheirShareAndDoNotFlicker) {
  const Flicker with = flicker(true), without = flicker(false);
  std::printf("with: mean %.4f deviation %.5f; without: mean %.4f deviation %.5f (of the closed form)\n",
              with.mean, with.deviation, without.mean, without.deviation);
  EXPECT_NEAR(with.mean, 1.0, 0.03);
  EXPECT_LT(with.deviation, 0.01);
  EXPECT_LT(with.deviation, 0.4 * without.deviation);
}

TEST(Markings, NearOnesStayAsTheyAre) {
  render::CameraEffects effects = lambertian();
  const render::CameraDesc desc = plain_camera(256);
  const Pose eye = look({10.0, 0.4, 1.5}, 0.0, 60.0);
  CameraRig plain(road(), plain_light(), desc, effects);
  effects.markings = true;
  CameraRig mixed(road(), plain_light(), desc, effects);
  const render::CameraImages a = plain.shoot(eye), b = mixed.shoot(eye);
  EXPECT_EQ(a.instance, b.instance);
  EXPECT_EQ(a.depth, b.depth);
  size_t near = 0;
  for (size_t i = 0; i < a.depth.size(); ++i)
    if (a.depth[i] < 8.0f) {
      EXPECT_EQ(a.hdr[3 * i], b.hdr[3 * i]);
      ++near;
    }
  EXPECT_GT(near, a.depth.size() / 2);
}

}  // namespace
}  // namespace greatx::test
