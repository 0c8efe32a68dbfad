// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the delays of echoes during a frame.
#include <gtest/gtest.h>

#include "rf/radar/echoes/echo_tracks.h"
#include "tests/rf/radar_echo_scenes.h"

namespace greatx::rf {
namespace {

using test::TinyScene;
using namespace rf::testing;

constexpr double slot_s = 50e-6;
constexpr uint32_t slots = 200;  // 10 ms

/// Returns a plate of 10 cm that faces -x, in a body of its own.
TinyScene plate_on_a_body() {
  TinyScene tiny;
  const uint32_t body = tiny.body("plate");
  tiny.object("plate", body).quad({0, 0.05, -0.05}, {0, -0.05, -0.05}, {0, -0.05, 0.05}, {0, 0.05, 0.05});
  return tiny;
}

EchoMotion frame() {
  EchoMotion motion;
  motion.transmitter = motion.receiver = [](double) { return Pose{}; };
  for (uint32_t slot = 0; slot < slots; ++slot) motion.slot_start_s.push_back(slot * slot_s);
  motion.slot_s = slot_s;
  return motion;
}

EchoList trace(EchoScene& scene, const EchoOptions& options, const EchoMotion& motion) {
  EchoFinder finder(scene.gpu, scene.surfaces(), EchoEnd{}, std::nullopt, options);
  return testing::trace_echoes(finder, scene.gpu, scene.scene.bodies.size(), motion);
}

double delay_at(const DelayTrack& track, double t) {
  const double u = t - track.mid_s;
  const auto& c = track.coefficients;
  return c[0] + u * (c[1] + u * (c[2] + u * c[3]));
}

EchoOptions narrow() {
  EchoOptions options;
  options.field_of_view = {-0.02, 0.02, -0.02, 0.02};
  options.tubes = 100;
  return options;
}

TEST(RadarEchoMotion, CubicFollowsAnAcceleratingTargetToAThousandthOfAWavelength) {
  EchoScene scene(plate_on_a_body());
  EchoMotion motion = frame();
  const auto x = [](double t) { return 20.0 - 30.0 * t + 0.5 * 40.0 * t * t; };
  motion.body = [&](uint32_t, double t) { return Pose{{x(t), 0, 0}, dquat(1, 0, 0, 0)}; };
  const EchoList list = trace(scene, narrow(), motion);
  ASSERT_FALSE(list.echoes.empty());
  EXPECT_EQ(list.slots, slots);
  EXPECT_TRUE(list.tables.empty());
  for (const Echo& echo : list.echoes) {
    EXPECT_EQ(echo.instance, 1u);
    const double off = glm::length(dvec2(echo.point.y, echo.point.z));
    for (double t = 0.0; t <= slots * slot_s; t += 7 * slot_s)
      EXPECT_NEAR(delay_at(echo.delay, t) * speed_of_light, 2.0 * std::hypot(x(t), off),
                  1e-3 * radar_wavelength_m);
  }
}

TEST(RadarEchoMotion, RadarThatMovesApproachesAtItsSpeedTimesTheCosine) {
  EchoScene scene(plate_on_a_body());
  EchoMotion motion = frame();
  motion.body = [](uint32_t, double) { return Pose{{20, 0, 0}, dquat(1, 0, 0, 0)}; };
  motion.transmitter = motion.receiver = [](double t) {
    return Pose{{12.0 * t, 5.0 * t, 0}, dquat(1, 0, 0, 0)};
  };
  for (const Echo& echo : trace(scene, narrow(), motion).echoes)
    EXPECT_NEAR(echo.delay.coefficients[1] * speed_of_light, -24.0, 0.1);
}

/// A blade with 200 turns per second turns twice during a frame. A table describes its delay because no cubic
/// does.
TEST(RadarEchoMotion, RotorGetsATable) {
  EchoScene scene(plate_on_a_body());
  EchoMotion motion = frame();
  const auto turn = [](double t) { return orientation_from_yaw_pitch_roll(2.0 * pi * 200.0 * t, 0.0, 0.0); };
  motion.body = [&](uint32_t, double t) { return Pose{{20, 0, 0}, turn(t)}; };
  EchoOptions options = narrow();
  options.merge_share = 0.0;
  const EchoList list = trace(scene, options, motion);
  ASSERT_FALSE(list.echoes.empty());
  size_t tables = 0;
  for (const Echo& echo : list.echoes) {
    if (echo.delay.table < 0) continue;
    ++tables;
    const dvec3 on_blade = echo.point - dvec3(20, 0, 0);  // traced at t = 0
    for (uint32_t slot = 0; slot < slots; slot += 13) {
      const auto distance = [&](double t) { return glm::length(dvec3(20, 0, 0) + turn(t) * on_blade); };
      const auto& [delay, rate] = list.tables[size_t(echo.delay.table) * slots + slot];
      EXPECT_NEAR(delay * speed_of_light, 2.0 * distance(slot * slot_s), 1e-9);
      const double expected = (distance(slot * slot_s + 1e-7) - distance(slot * slot_s - 1e-7)) / 1e-7;
      EXPECT_NEAR(rate * speed_of_light, expected, 0.2);
    }
  }
  EXPECT_GT(tables, 0u);
  EXPECT_EQ(list.tables.size(), tables * slots);
}

/// The two halves of a turning plate move in opposite directions. Merging keeps echoes with different rates
/// apart.
TEST(RadarEchoMotion, MergingKeepsDopplerApart) {
  EchoScene scene(plate_on_a_body());
  EchoMotion motion = frame();
  motion.body = [](uint32_t, double t) {
    return Pose{{20, 0, 0}, orientation_from_yaw_pitch_roll(30.0 * t, 0.0, 0.0)};
  };
  EchoOptions options = narrow();
  options.tubes = 10000;
  options.bandwidth_hz = 1e6;  // one cell of delay
  double least = 1e9, most = -1e9;
  const EchoList list = trace(scene, options, motion);
  for (const Echo& echo : list.echoes) {
    const double rate = echo.delay.coefficients[1] * speed_of_light;
    least = std::min(least, rate), most = std::max(most, rate);
  }
  EXPECT_GT(list.echoes.size(), 10u);
  EXPECT_NEAR(most - least, 2.0 * 30.0 * 0.1, 1.0);  // from edge to edge: 2 omega a
}

}  // namespace
}  // namespace greatx::rf
