// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/renderer/lidar_rig.h"

namespace greatx::render {
namespace {

using test::TinyScene;

using test::Sweep, test::sweep, test::wall, test::small_scan;

LidarDesc desc_of(const SpinningScan& scan) {
  LidarDesc desc;
  desc.pattern = scan_pattern(scan);
  return desc;
}
LidarDesc small_lidar() { return desc_of(small_scan()); }

double azimuth_of(const SpinningScan& scan, uint32_t step) {
  return scan.azimuth_start + step * scan.azimuth_span / scan.azimuth_steps;
}

dvec3 beam_of(const SpinningScan& scan, uint32_t step, uint32_t channel) {
  const double e = scan.elevations[channel], a = azimuth_of(scan, step);
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

TEST(Lidar, WallInClosedForm) {
  LidarDesc desc = small_lidar();
  desc.receiver.aperture_diameter_m = 0.04;
  desc.receiver.system_efficiency = 0.7;
  desc.receiver.extinction_per_m = 1e-3;
  const Sweep result = sweep(wall(10.0).build(), desc, std::vector{Pose{}});
  const LidarScan& scan = result.scan;
  ASSERT_EQ(scan.size(), 5u * 41u);  // every beam, azimuth step by step
  for (size_t i = 0; i < scan.size(); ++i) {
    const uint32_t step = static_cast<uint32_t>(i / 5), channel = static_cast<uint32_t>(i % 5);
    ASSERT_EQ(scan.shot[i], i);
    ASSERT_EQ(scan.ring[i], channel);
    const dvec3 beam = beam_of(small_scan(), step, channel);
    const double range = 10.0 / beam.x, cosine = beam.x;
    ASSERT_NEAR(scan.range_m[i], range, 1e-6 * range);
    ASSERT_NEAR(scan.points[i].x, 10.0, 2e-5);
    ASSERT_NEAR(scan.points[i].y, range * beam.y, 2e-5);
    ASSERT_NEAR(scan.points[i].z, range * beam.z, 2e-5);
    // The intensity is rho cos(theta), corrected for the range but not for the air.
    ASSERT_NEAR(scan.points[i].w, 0.8 * cosine * std::exp(-2e-3 * range), 1e-6);
    const double power = 0.8 * cosine * 0.04 * 0.04 * 0.7 / (4.0 * range * range) * std::exp(-2e-3 * range);
    ASSERT_NEAR(scan.power[i], power, 2e-6 * power);
    ASSERT_EQ(scan.instance[i], 1u);
    ASSERT_EQ(scan.material[i], 2u);  // material 0 is the default one
    ASSERT_EQ(scan.time_offset_s[i], 0.0f);
    ASSERT_EQ(scan.share[i], 1.0f);
    ASSERT_EQ(scan.return_number[i], 1);
    ASSERT_EQ(scan.return_count[i], 1);
    ASSERT_EQ(result.ranges[channel * 41 + step], scan.range_m[i]);
  }
}

TEST(Lidar, WavelengthChoosesTheReflectance) {
  LidarDesc desc = test::lidar_along({{1, 0, 0}});
  EXPECT_FLOAT_EQ(sweep(wall(10.0).build(), desc, std::vector{Pose{}}).scan.points[0].w, 0.8f);
  desc.wavelength_nm = 1550;
  EXPECT_FLOAT_EQ(sweep(wall(10.0).build(), desc, std::vector{Pose{}}).scan.points[0].w, 0.4f);
}

TEST(Lidar, OnlyHitsWithinTheRangesAreReturned) {
  LidarDesc desc = small_lidar();
  desc.max_range_m = 10.5;  // passes if the cosines of elevation and azimuth multiply to more than 10 / 10.5
  const Sweep result = sweep(wall(10.0).build(), desc, std::vector{Pose{}});
  size_t expected = 0;
  for (uint32_t step = 0; step < 41; ++step) {
    for (uint32_t channel = 0; channel < 5; ++channel) {
      const bool within = 10.0 / beam_of(small_scan(), step, channel).x < 10.5;
      expected += within;
      ASSERT_EQ(std::isinf(result.ranges[channel * 41 + step]), !within);
    }
  }
  EXPECT_EQ(result.scan.size(), expected);
  EXPECT_GT(expected, 10u);
  EXPECT_LT(expected, 205u);

  desc.max_range_m = 120.0;
  desc.min_range_m = 20.0;  // the wall is nearer: the beam begins behind it
  EXPECT_EQ(sweep(wall(10.0).build(), desc, std::vector{Pose{}}).scan.size(), 0u);
}

TEST(Lidar, EveryShotIsTakenFromThePoseAtItsOwnTime) {
  // The sensor flies towards the wall at 20 m/s and yaws at 1 rad/s during the sweep.
  SpinningScan fan = small_scan();
  fan.azimuth_steps = 400;
  fan.azimuth_start = radians(-30.0);
  fan.azimuth_span = radians(60.0);
  fan.sweep_s = 0.1;
  const LidarDesc desc = desc_of(fan);
  std::vector<Pose> poses;
  for (uint32_t step = 0; step < fan.azimuth_steps; ++step) {
    const double t = step * 0.1 / 400;
    poses.push_back({{20.0 * t, 1.0, 2.0}, orientation_from_yaw_pitch_roll(1.0 * t, 0.0, 0.0)});
  }
  const LidarScan scan = sweep(wall(50.0).build(), desc, poses).scan;
  ASSERT_EQ(scan.size(), 2000u);
  for (size_t i = 0; i < scan.size(); ++i) {
    const uint32_t step = scan.shot[i] / 5;
    const double t = step * 0.1 / 400, azimuth = azimuth_of(fan, step),
                 elevation = fan.elevations[scan.ring[i]];
    ASSERT_FLOAT_EQ(scan.time_offset_s[i], static_cast<float>(t));
    // In the world the beam points at azimuth + yaw. The point is stored in the sensor's frame at that
    // instant.
    const double range = (50.0 - 20.0 * t) / (std::cos(elevation) * std::cos(azimuth + t));
    ASSERT_NEAR(scan.range_m[i], range, 1e-6 * range);
    ASSERT_NEAR(scan.points[i].x, range * std::cos(elevation) * std::cos(azimuth), 2e-5);
    ASSERT_NEAR(scan.points[i].y, range * std::cos(elevation) * std::sin(azimuth), 2e-5);
    // Transformed by its own pose, the point lies on the wall: this undoes the distortion.
    ASSERT_NEAR(poses[step].apply(dvec3(vec3(scan.points[i]))).x, 50.0, 2e-5);
  }
}

TEST(Lidar, OwnBodyIsPassedOverAndNothingElse) {
  TinyScene tiny = wall(10.0);
  const uint32_t drone = tiny.body("drone"), other = tiny.body("other");
  tiny.object("drone", drone)
      .box({-1, -1, -1}, {1, 1, 1})
      .box({9, -1, -1}, {10, 1, 1});  // the nose touches the wall
  tiny.object("other", other).quad({0, 1, -1}, {0, -1, -1}, {0, -1, 1}, {0, 1, 1});
  const scene::Scene scene = tiny.build();
  const std::vector<Pose> bodies{Pose{}, Pose{}, Pose{{5, 0, 0}, {1, 0, 0, 0}}};
  // The beam at 0 degrees meets the other drone, the beam at 40 degrees the wall.
  LidarDesc desc = test::lidar_along({{1, 0, 0}, beam_direction(radians(40.0), 0.0)});
  desc.min_range_m = 0.0;
  const LidarScan seeing = sweep(scene, desc, std::vector{Pose{}}, bodies).scan;
  ASSERT_EQ(seeing.size(), 2u);
  EXPECT_FLOAT_EQ(seeing.range_m[0], 1.0f);
  EXPECT_EQ(seeing.instance[0], 2u);

  desc.excluded_body = drone;
  const LidarScan scan = sweep(scene, desc, std::vector{Pose{}}, bodies).scan;
  ASSERT_EQ(scan.size(), 2u);
  EXPECT_FLOAT_EQ(scan.range_m[0], 5.0f);
  EXPECT_EQ(scan.instance[0], 3u);
  EXPECT_NEAR(scan.range_m[1], 10.0 / std::cos(radians(40.0)), 1e-5);
  EXPECT_EQ(scan.instance[1], 1u);

  // The beam passes through the nose and meets the wall at its end.
  const std::vector<Pose> apart{Pose{}, Pose{}, Pose{{5, 50, 0}, {1, 0, 0, 0}}};
  const LidarScan behind = sweep(scene, desc, std::vector{Pose{}}, apart).scan;
  EXPECT_FLOAT_EQ(behind.range_m[0], 10.0f);
  EXPECT_EQ(behind.instance[0], 1u);
}

/// Returns a masked pane at x = 5 before a wall at x = 10. The left half of the pane (u below 0.5: y above 0)
/// is a hole; the other half is grey.
scene::Scene pane_before_wall() {
  TinyScene tiny = wall(10.0);
  scene::Texture texture;
  texture.name = "leaf";
  texture.width = 8;  // linear filtering: only the texels at the border mix
  texture.height = 1;
  texture.srgb = false;
  for (int i = 0; i < 4; ++i) texture.rgba.insert(texture.rgba.end(), {255, 255, 255, 0});
  for (int i = 0; i < 4; ++i) texture.rgba.insert(texture.rgba.end(), {102, 102, 102, 255});
  scene::Material material;
  material.name = "leaf";
  material.pbr.alpha_mode = scene::AlphaMode::mask;
  material.pbr.base_color_texture = static_cast<int32_t>(tiny.texture(texture));
  tiny.object("pane", 0, tiny.material_as(material)).quad({5, 4, -4}, {5, -4, -4}, {5, -4, 4}, {5, 4, 4});
  return tiny.build();
}

TEST(Lidar, HolesOfAlphaMasksLetBeamsThroughIfTheEffectIsOn) {
  // The beam at 20 degrees meets the hole, the beam at -20 degrees the leaf.
  LidarDesc desc =
      test::lidar_along({beam_direction(radians(20.0), 0.0), beam_direction(radians(-20.0), 0.0)});
  const scene::Scene scene = pane_before_wall();
  const LidarScan solid = sweep(scene, desc, std::vector{Pose{}}).scan;
  ASSERT_EQ(solid.size(), 2u);
  EXPECT_NEAR(solid.points[0].x, 5.0f, 1e-5);
  EXPECT_NEAR(solid.points[1].x, 5.0f, 1e-5);
  EXPECT_NEAR(solid.points[0].w, std::cos(radians(20.0)), 1e-5);  // the luminance of the base colour is 1

  desc.alpha_mask = true;
  const LidarScan masked = sweep(scene, desc, std::vector{Pose{}}).scan;
  ASSERT_EQ(masked.size(), 2u);
  EXPECT_NEAR(masked.points[0].x, 10.0f, 1e-5);
  EXPECT_EQ(masked.instance[0], 1u);
  EXPECT_NEAR(masked.points[1].x, 5.0f, 1e-5);
  EXPECT_EQ(masked.instance[1], 2u);
  EXPECT_NEAR(masked.points[1].w, std::cos(radians(20.0)), 1e-5);

  desc.textured_reflectance = true;
  const LidarScan textured = sweep(scene, desc, std::vector{Pose{}}).scan;
  EXPECT_NEAR(textured.points[0].w, 0.8 * std::cos(radians(20.0)),
              1e-5);  // the file states this reflectance: no modulation
  EXPECT_NEAR(textured.points[1].w, 0.4 * std::cos(radians(20.0)), 1e-3);  // 102 / 255
}

TEST(Lidar, SameSweepTwiceGivesTheSameBytes) {
  LidarDesc desc = small_lidar();
  const Sweep first = sweep(wall(10.0).build(), desc, std::vector{Pose{}});
  const Sweep second = sweep(wall(10.0).build(), desc, std::vector{Pose{}});
  EXPECT_EQ(first.ranges, second.ranges);
  EXPECT_EQ(first.scan.points, second.scan.points);
}

TEST(Lidar, UnfitDescriptionsAreRefused) {
  const scene::Scene scene = wall(10.0).build();
  scene::GpuScene gpu_scene(test::device(), scene, {});
  LidarDesc desc = small_lidar();
  desc.wavelength_nm = 532;
  EXPECT_THROW(LidarPass(gpu_scene, desc), ContractError);
  desc = small_lidar();
  desc.pattern = {};
  EXPECT_THROW(LidarPass(gpu_scene, desc), ContractError);
  SpinningScan empty = small_scan();
  empty.elevations.clear();
  EXPECT_THROW(scan_pattern(empty), ContractError);
  desc = small_lidar();
  desc.max_range_m = desc.min_range_m;
  EXPECT_THROW(LidarPass(gpu_scene, desc), ContractError);
}

TEST(HardCase, N07_LidarAtUtmCoordinatesGivesTheSameBytes) {
  const dvec3 utm(500000.0, 5411000.0, 35.0);
  const auto scene_at = [](const dvec3& offset) {
    TinyScene tiny;
    RandomStream random(1, 7);
    for (int i = 0; i < 300; ++i) {
      const auto grid = [&](double reach) {
        return std::round(random.uniform(-reach, reach) * 0x1p20) * 0x1p-20;
      };
      const dvec3 a = offset + dvec3(grid(60), grid(60), grid(15));
      tiny.triangle(a, a + dvec3(grid(9), grid(9), grid(9)), a + dvec3(grid(9), grid(9), grid(9)));
    }
    return tiny.build(offset);
  };
  SpinningScan around = small_scan();
  around.azimuth_steps = 256;
  around.azimuth_span = 2.0 * pi;
  const LidarDesc desc = desc_of(around);
  const scene::Scene here = scene_at(dvec3(0.0)), there = scene_at(utm);
  const Pose sensor{{1.25, -2.5, 3.0}, orientation_from_yaw_pitch_roll(0.3, 0.1, 0.0)};
  const Sweep near = sweep(here, desc, std::vector{here.to_local(sensor)});
  const Sweep far =
      sweep(there, desc, std::vector{there.to_local(Pose{sensor.position + utm, sensor.orientation})});
  EXPECT_GT(near.scan.size(), 100u);
  EXPECT_EQ(near.scan.points, far.scan.points);
  EXPECT_EQ(near.ranges, far.ranges);
}

TEST(HardCase, N64_LidarInAnEmptyScene) {
  const Sweep result = sweep(TinyScene().build(), small_lidar(), std::vector{Pose{}});
  EXPECT_EQ(result.scan.size(), 0u);
  for (const float range : result.ranges) EXPECT_TRUE(std::isinf(range) && range > 0.0f);
}

}  // namespace
}  // namespace greatx::render
