// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks beams with divergence, glass, and targets that move during a sweep.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "renderer/lidar/pane.h"
#include "renderer/lidar/scan/footprint.h"
#include "tests/renderer/lidar_rig.h"

namespace greatx::render {
namespace {

using test::lidar_along, test::Sweep, test::sweep, test::TinyScene, test::wall;
using testing::ElementsAre;
using testing::FloatNear;
using testing::Pointwise;

LidarDesc spreading(double divergence, uint32_t rings) {
  LidarDesc desc = lidar_along({{1, 0, 0}});
  desc.divergence = divergence;
  desc.rings = rings;
  desc.returns.mode = ReturnMode::all;
  return desc;
}

// ---------------------------------------------------------------------------------------------- divergence

TEST(LidarBeam, OnAWallAcrossItIsOneReturnOfTheWholeBeam) {
  const LidarDesc desc = spreading(0.004, 4);
  const LidarScan scan = sweep(wall(50.0).build(), desc, std::vector{Pose{}}).scan;
  ASSERT_EQ(scan.size(), 1u);
  // A ray at the angle a off the axis meets the wall at 50 / cos a; the mean of a^2 is w^2 / 2.
  const double mean_square = 0.5 * 0.002 * 0.002;
  EXPECT_NEAR(scan.range_m[0], 50.0 * (1.0 + 0.5 * mean_square), 1e-5);
  EXPECT_NEAR(scan.points[0].w, 0.8, 1e-5);
  EXPECT_NEAR(scan.share[0], 1.0, 1e-6);
  EXPECT_EQ(scan.return_count[0], 1);
}

TEST(LidarBeam, FootprintOnASlopeHasTheBeamsWidth) {
  // The normal of a plane through (50, 0, 0) is 80 degrees off the beam. A ray that rises by the tangent t
  // meets the plane at x = 50 / (1 - t tan(80)). To first order the spread of ranges is 50 tan(80) w / 2. A
  // range resolution finer than the spacing of the rays shows this spread.
  TinyScene tiny;
  const double slope = std::tan(radians(80.0));
  tiny.object("slope", 0, tiny.material("paint", 0.8f))
      .quad({50 - 10 * slope, 100, -10}, {50 - 10 * slope, -100, -10}, {50 + 10 * slope, -100, 10},
            {50 + 10 * slope, 100, 10});
  LidarDesc desc = spreading(0.002, 8);
  desc.returns.resolution_m = 1e-6;
  desc.returns.most = 1000;
  const LidarScan scan = sweep(tiny.build(), desc, std::vector{Pose{}}).scan;
  double share = 0.0, mean = 0.0, square = 0.0;
  for (size_t i = 0; i < scan.size(); ++i) {
    share += scan.share[i];
    mean += scan.share[i] * (scan.range_m[i] - 50.0);
    square += scan.share[i] * std::pow(scan.range_m[i] - 50.0, 2);
  }
  EXPECT_GT(scan.size(), 50u);
  EXPECT_NEAR(share, 1.0, 1e-5);
  const double first_order = 50.0 * slope * 0.5 * 0.001;
  EXPECT_NEAR(std::sqrt(square), first_order, 1e-3 * first_order);
  EXPECT_NEAR(mean, 50.0 * (slope * slope + 0.5) * 0.25 * 1e-6, 2e-4);  // mean of 50 (t^2 tan^2 + a^2/2)
  // A receiver that cannot separate the echoes finds one return.
  desc.returns.resolution_m = 0.3;
  EXPECT_EQ(sweep(tiny.build(), desc, std::vector{Pose{}}).scan.size(), 1u);
}

/// Returns a plate at 20 m that ends at y = edge, before a wall at 30 m. Both are white.
scene::Scene step_scene(double edge) {
  TinyScene tiny = wall(30.0, 1.0f);
  tiny.object("plate", 0, 1)
      .quad({20, edge, -100}, {20, edge - 100, -100}, {20, edge - 100, 100}, {20, edge, 100});
  return tiny.build();
}

TEST(HardCase, N61_LidarBeamSplitOverTwoDepthsGivesTwoReturnsWhoseEnergySumsToOne) {
  const double divergence = 0.004, w = 20.0 * 0.002;
  for (const double edge : {-0.03, -0.01, 0.004, 0.02}) {
    const LidarScan scan = sweep(step_scene(edge), spreading(divergence, 8), std::vector{Pose{}}).scan;
    ASSERT_EQ(scan.size(), 2u) << edge;
    EXPECT_NEAR(scan.range_m[0], 20.0, 1e-3);
    EXPECT_NEAR(scan.range_m[1], 30.0, 1e-3);
    EXPECT_THAT(scan.return_number, ElementsAre(1, 2));
    EXPECT_THAT(scan.return_count, ElementsAre(2, 2));
    EXPECT_THAT(scan.instance, ElementsAre(2, 1));
    EXPECT_NEAR(scan.share[0] + scan.share[1], 1.0, 1e-6);
    EXPECT_NEAR(scan.points[0].w + scan.points[1].w, 1.0, 1e-5);  // white, seen along the normal
    // The share is the part of a Gaussian Phi(2 edge / w). 217 rays approximate it to some per cent.
    EXPECT_NEAR(scan.share[0], normal_cdf(2.0 * edge / w), 0.04) << edge;
    // The power of each return is its share of the power that the whole beam would give from there.
    const Receiver receiver;
    EXPECT_NEAR(scan.power[0], received_power(receiver, 20.0, scan.share[0]), 1e-4 * scan.power[0]);
    EXPECT_NEAR(scan.power[1], received_power(receiver, 30.0, scan.share[1]), 1e-4 * scan.power[1]);
  }
}

TEST(LidarBeam, SubRaysSpreadToAllSidesWhereverTheBeamLooks) {
  // The sensor is in a closed room. The mean direction of the rays is the axis of the beam.
  TinyScene tiny;
  tiny.object("room", 0, tiny.material("paint", 0.8f)).box({-10, -10, -10}, {10, 10, 10});
  for (const dvec3& axis :
       {dvec3(0, 0, 1), dvec3(0, 0, -1), dvec3(0, 1, 0), glm::normalize(dvec3(-1, 2, 3))}) {
    LidarDesc desc = lidar_along({axis});
    desc.divergence = 0.01;
    desc.rings = 3;
    desc.returns.mode = ReturnMode::all;
    const LidarScan scan = sweep(tiny.build(), desc, std::vector{Pose{}}).scan;
    ASSERT_EQ(scan.size(), 1u);
    EXPECT_NEAR(scan.share[0], 1.0, 1e-6);
    EXPECT_NEAR(glm::length(glm::normalize(dvec3(vec3(scan.points[0]))) - axis), 0.0, 1e-6);
  }
}

// --------------------------------------------------------------------------------------------------- glass

scene::Material glass(float transmission = 1.0f, float dirt = 0.0f) {
  scene::Material material;
  material.name = "glass";
  material.pbr.transmission = transmission;
  material.reflectance_905nm = dirt;
  return material;
}

/// Returns a pane across x = 5 before a wall at 10 m.
scene::Scene window(const scene::Material& material) {
  TinyScene tiny = wall(10.0);
  tiny.object("pane", 0, tiny.material_as(material))
      .quad({5, 40, -40}, {5, -40, -40}, {5, -40, 40}, {5, 40, 40});
  return tiny.build();
}

double reflectance(double cosine) {
  return shared::pane_reflectance(static_cast<float>(cosine), static_cast<float>(glass_index(905)), 1.0f);
}

TEST(LidarGlass, WhatIsBehindAPaneIsWeakenedTwice) {
  const dvec3 oblique = beam_direction(radians(40.0), radians(10.0));
  LidarDesc desc = lidar_along({{1, 0, 0}, oblique});
  desc.glass = true;
  const LidarScan scan = sweep(window(glass(0.9f)), desc, std::vector{Pose{}}).scan;
  ASSERT_EQ(scan.size(), 2u);  // a clean pane returns nothing to a beam of zero width
  for (size_t i = 0; i < 2; ++i) {
    const double cosine = i == 0 ? 1.0 : oblique.x, through = (1.0 - reflectance(cosine)) * 0.9;
    EXPECT_NEAR(scan.points[i].x, 10.0, 1e-5);
    EXPECT_EQ(scan.instance[i], 1u);
    EXPECT_NEAR(scan.points[i].w, 0.8 * cosine * through * through, 1e-5);
    EXPECT_NEAR(scan.share[i], through, 1e-6);
  }
  // With the effect off, a pane is an ordinary wall.
  desc.glass = false;
  EXPECT_NEAR(sweep(window(glass()), desc, std::vector{Pose{}}).scan.points[0].x, 5.0, 1e-6);
}

TEST(LidarGlass, DirtGivesAReturnAndEnergyIsKept) {
  const dvec3 oblique = beam_direction(radians(30.0), 0.0);
  LidarDesc desc = lidar_along({oblique});
  desc.glass = true;
  desc.returns.mode = ReturnMode::all;
  const LidarScan scan = sweep(window(glass(1.0f, 0.1f)), desc, std::vector{Pose{}}).scan;
  ASSERT_EQ(scan.size(), 2u);
  const double rest = 1.0 - reflectance(oblique.x);
  EXPECT_NEAR(scan.points[0].x, 5.0, 1e-5);
  EXPECT_NEAR(scan.points[0].w, rest * 0.1 * oblique.x, 1e-6);
  EXPECT_NEAR(scan.points[1].w, 0.8 * oblique.x * std::pow(rest * 0.9, 2), 1e-5);
  EXPECT_NEAR(scan.share[0] + scan.share[1], 1.0, 1e-6);
}

TEST(LidarGlass, APaneGlaresWhereItMirrorsTheBeamBack) {
  const double half = 0.0015;
  for (const double off : {0.0, 0.0008, 0.0015, 0.003}) {
    LidarDesc desc = lidar_along({beam_direction(off, 0.0)});
    desc.glass = true;
    desc.divergence = 2.0 * half;
    desc.returns.mode = ReturnMode::all;
    const LidarScan scan = sweep(window(glass()), desc, std::vector{Pose{}}).scan;
    ASSERT_EQ(scan.size(), 2u) << off;
    // The mirror image of the receiver is 10 m away: 2 P R / (pi w^2) exp(-2 theta^2 / half^2), relative to P
    // rho / (pi 5^2).
    const double w = 10.0 * half;
    const double expected =
        reflectance(1.0) * 2.0 / (w * w) * std::exp(-2.0 * std::pow(off / half, 2)) * 25.0;
    EXPECT_NEAR(scan.points[0].w, expected, 2e-3 * expected) << off;
    EXPECT_EQ(scan.instance[0], 2u);
  }
  LidarDesc desc = lidar_along({beam_direction(radians(3.0), 0.0)});
  desc.glass = true;
  desc.divergence = 2.0 * half;
  desc.returns.mode = ReturnMode::all;
  EXPECT_EQ(sweep(window(glass()), desc, std::vector{Pose{}}).scan.size(), 1u);
}

TEST(LidarGlass, ManyPanesOneBehindTheOther) {
  const auto stack = [](int panes) {
    TinyScene tiny = wall(30.0);
    const uint32_t material = tiny.material_as(glass());
    tiny.object("panes", 0, material);
    for (int i = 0; i < panes; ++i) {
      const double x = 2.0 + i;
      tiny.quad({x, 40, -40}, {x, -40, -40}, {x, -40, 40}, {x, 40, 40});
    }
    return tiny.build();
  };
  LidarDesc desc = lidar_along({{1, 0, 0}});
  desc.glass = true;
  const LidarScan scan = sweep(stack(12), desc, std::vector{Pose{}}).scan;
  ASSERT_EQ(scan.size(), 1u);
  EXPECT_NEAR(scan.points[0].w, 0.8 * std::pow(1.0 - reflectance(1.0), 24), 1e-5);
  EXPECT_EQ(sweep(stack(static_cast<int>(shared::lidar_most_panes)), desc, std::vector{Pose{}}).scan.size(),
            1u);
  EXPECT_EQ(
      sweep(stack(static_cast<int>(shared::lidar_most_panes) + 1), desc, std::vector{Pose{}}).scan.size(),
      0u);
  // Twelve dirty panes give four returns, and one from the wall behind all of them.
  TinyScene dirty = wall(30.0);
  dirty.object("panes", 0, dirty.material_as(glass(1.0f, 0.02f)));
  for (int i = 0; i < 12; ++i)
    dirty.quad({2.0 + i, 40, -40}, {2.0 + i, -40, -40}, {2.0 + i, -40, 40}, {2.0 + i, 40, 40});
  desc.returns.mode = ReturnMode::all;
  const LidarScan many = sweep(dirty.build(), desc, std::vector{Pose{}}).scan;
  // A GPU may contract multiplications and additions: two units in the last place of 30 m.
  EXPECT_THAT(many.range_m, Pointwise(FloatNear(4e-6f), {2.0f, 3.0f, 4.0f, 5.0f, 30.0f}));
}

// ------------------------------------------------------------------------------------------ moving targets

/// Describes a fan of 200 shots over 0.1 s towards a plate that approaches at 30 m/s, slides and turns.
struct MovingPlate {
  uint32_t shots = 200;
  Pose plate_at(double t) const {
    return {{40.0 - 30.0 * t, 5.0 * t, 0.5}, orientation_from_yaw_pitch_roll(0.2 + 0.8 * t, 0.1, 0.3 * t)};
  }
  Pose sensor_at(double t) const {
    return {{10.0 * t, -1.0, 0.2}, orientation_from_yaw_pitch_roll(0.05 - 0.5 * t, 0.0, 0.0)};
  }
  SpinningScan fan() const {
    SpinningScan scan;
    scan.elevations = {radians(-4.0), 0.0, radians(3.0)};
    scan.azimuth_steps = shots;
    scan.azimuth_start = radians(-12.0);
    scan.azimuth_span = radians(24.0);
    scan.sweep_s = 0.1;
    return scan;
  }
  /// Returns the range of a beam at its own time in closed form. The plate is the plane x = 0 of its frame.
  double range(const dvec3& beam, double t) const {
    const Pose plate_from_sensor = plate_at(t).inverse() * sensor_at(t);
    return -plate_from_sensor.position.x / plate_from_sensor.rotate(beam).x;
  }
};

TEST(LidarMotion, MovingTargetsStandWhereTheyAreAtTheShotsTime) {
  const MovingPlate moving;
  TinyScene tiny = wall(90.0);
  const uint32_t plate = tiny.body("plate");
  tiny.object("plate", plate, 1).quad({0, 5, -5}, {0, -5, -5}, {0, -5, 5}, {0, 5, 5});
  const uint32_t post = tiny.body("post");  // at rest, in front of a part of the plate
  tiny.object("post", post, 1).box({15, -0.05, -9}, {15.1, 0.05, 9});
  const scene::Scene scene = tiny.build();

  LidarDesc desc;
  desc.pattern = scan_pattern(moving.fan());
  desc.target_motion = true;
  std::vector<Pose> sensor;
  LidarTargets targets{true,
                       {{plate, {}, moving.plate_at(0.05).position, 20.0}, {post, {}, {15.05, 0, 0}, 10.0}}};
  const std::vector<Pose> bodies{Pose{}, moving.plate_at(0.0), Pose{}};
  for (const double t : desc.pattern.times_s) {
    sensor.push_back(moving.sensor_at(t));
    targets.bodies[0].motions.push_back(bodies[1] * moving.plate_at(t).inverse());
  }
  const LidarScan scan = sweep(scene, desc, sensor, bodies, targets).scan;
  ASSERT_EQ(scan.size(), desc.pattern.size());  // the wall is behind the whole fan
  size_t on_plate = 0, on_post = 0;
  double greatest = 0.0;
  for (size_t i = 0; i < scan.size(); ++i) {
    const double t = desc.pattern.times_s[desc.pattern.instants[scan.shot[i]]];
    const dvec3& beam = desc.pattern.directions[scan.shot[i]];
    on_post += scan.instance[i] == 3;
    if (scan.instance[i] != 2) continue;
    ++on_plate;
    ASSERT_NEAR(scan.range_m[i], moving.range(beam, t), 3e-5);
    const dvec3 normal = moving.plate_at(t).rotate({1, 0, 0}), world = moving.sensor_at(t).rotate(beam);
    ASSERT_NEAR(scan.points[i].w, 0.8 * std::abs(glm::dot(normal, world)), 1e-5);
    // Transformed back by both poses, the point lies on the plate.
    const dvec3 local =
        moving.plate_at(t).inverse().apply(moving.sensor_at(t).apply(dvec3(vec3(scan.points[i]))));
    ASSERT_NEAR(local.x, 0.0, 3e-5);
    ASSERT_LE(std::max(std::abs(local.y), std::abs(local.z)), 5.0 + 1e-4);
    greatest = std::max(greatest, std::abs(moving.range(beam, t) - moving.range(beam, 0.0)));
  }
  EXPECT_GT(on_plate, 200u);
  EXPECT_GT(on_post, 5u);
  EXPECT_GT(greatest, 2.0);  // error of the poses at the tick

  // With the effect off, the plate stands at its pose of the tick.
  desc.target_motion = false;
  size_t checked = 0;
  const LidarScan tick = sweep(scene, desc, sensor, bodies).scan;
  for (size_t i = 0; i < tick.size(); ++i) {
    if (tick.instance[i] != 2) continue;
    const double t = desc.pattern.times_s[desc.pattern.instants[tick.shot[i]]];
    const Pose plate_from_sensor = moving.plate_at(0.0).inverse() * moving.sensor_at(t);
    const dvec3 beam = plate_from_sensor.rotate(desc.pattern.directions[tick.shot[i]]);
    ASSERT_NEAR(tick.range_m[i], -plate_from_sensor.position.x / beam.x, 3e-5);
    ++checked;
  }
  EXPECT_GT(checked, 200u);
}

TEST(LidarMotion, BodiesApartThatStandStillAreTheSameAsTogether) {
  TinyScene tiny = wall(30.0);
  std::vector<Pose> bodies{Pose{}};
  LidarTargets targets{true, {}};
  RandomStream random(5, 5);
  for (int i = 0; i < 12; ++i) {
    const uint32_t body = tiny.body("box " + std::to_string(i));
    tiny.object("box", body, 1).box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    bodies.push_back({{random.uniform(5, 25), random.uniform(-8, 8), random.uniform(-4, 4)},
                      orientation_from_yaw_pitch_roll(random.uniform(0, 6), random.uniform(-1, 1), 0)});
    targets.bodies.push_back({body, {}, bodies.back().position, 0.9});
  }
  SpinningScan fan = test::small_scan();
  fan.azimuth_steps = 300;
  LidarDesc desc;
  desc.pattern = scan_pattern(fan);
  const Sweep together = sweep(tiny.build(), desc, std::vector{Pose{}}, bodies);
  desc.target_motion = true;
  const Sweep apart = sweep(tiny.build(), desc, std::vector{Pose{}}, bodies, targets);
  EXPECT_EQ(together.scan.points, apart.scan.points);
  EXPECT_EQ(together.scan.instance, apart.scan.instance);
  EXPECT_GT(std::count_if(together.scan.instance.begin(), together.scan.instance.end(),
                          [](uint32_t i) { return i > 1; }),
            100);
  // The sweep leaves out a body that is not listed.
  targets.bodies.clear();
  for (const uint32_t instance :
       sweep(tiny.build(), desc, std::vector{Pose{}}, bodies, targets).scan.instance)
    ASSERT_EQ(instance, 1u);
}

TEST(LidarMotion, AMovingPaneLetsThroughWhereItIs) {
  TinyScene tiny = wall(20.0);
  const uint32_t pane = tiny.body("pane");
  tiny.object("pane", pane, tiny.material_as(glass(1.0f, 0.1f)))
      .quad({0, 4, -4}, {0, -4, -4}, {0, -4, 4}, {0, 4, 4});
  LidarDesc desc = lidar_along({{1, 0, 0}, {1, 0, 0}});
  desc.pattern.instants = {0, 1};
  desc.pattern.times_s = {0.0, 0.1};
  desc.glass = desc.target_motion = true;
  desc.returns.mode = ReturnMode::all;
  const std::vector<Pose> bodies{Pose{}, Pose{{5, 0, 0}, {1, 0, 0, 0}}};
  const LidarTargets targets{true, {{pane, {Pose{}, Pose{{-3, 0, 0}, {1, 0, 0, 0}}}, {6.5, 0, 0}, 8.0}}};
  const LidarScan scan = sweep(tiny.build(), desc, std::vector{Pose{}}, bodies, targets).scan;
  EXPECT_THAT(scan.range_m, ElementsAre(5.0f, 20.0f, 8.0f, 20.0f));
  EXPECT_FLOAT_EQ(scan.points[1].w, scan.points[3].w);
}

}  // namespace
}  // namespace greatx::render
