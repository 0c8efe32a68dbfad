// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests event cameras in whole runs: instants between ticks, memory, resuming, and other sensors beside them.
#include "sim/sensors/event/event_sensor.h"

#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;

const std::string head =
    "greatx: 1\nname: test\nseed: 5\nticks: 201\ntick_rate_hz: 1000\n"
    "scene: {generate: {kind: canyon, seed: 3, size_m: 60}, optical_only: true}\n"
    "environment: {clouds: 0}\nnodes:\n";

/// Returns a node with a van in the view. It drives through the view if `moves`.
std::string van(bool moves) {
  return "  - name: van\n    trajectory: " +
         std::string(
             moves ? "{type: waypoints, points: [{t_s: 0, position_m: [2, -6, 0]}, {t_s: 0.2, position_m: "
                     "[2, -4, 0]}]}"
                   : "{type: static, position_m: [2, -6, 0]}") +
         "\n    model: {generate: {kind: car, variant: van}}\n";
}

/// Returns a node that looks along the street and turns by `turn_deg` within 0.2 s.
std::string eye(double turn_deg, const std::string& sensors) {
  return fmt::format(
      "  - name: eye\n    trajectory: {{type: waypoints, interpolation: linear, points: [{{t_s: 0, "
      "position_m: [2, -16, "
      "1.6], rotation_deg: [90, 0, 0]}}, {{t_s: 0.2, position_m: [2, -16, 1.6], rotation_deg: [{}, 0, "
      "0]}}]}}\n    "
      "sensors:\n{}",
      90.0 + turn_deg, sensors);
}
std::string dvs(const std::string& more, const std::string& rate = "10") {
  return "      - {name: dvs, type: event_camera, rate_hz: " + rate + ", width: 62, height: 46, fov_deg: 70" +
         more + "}\n";
}
const std::string noisy =
    ", threshold: {on: 0.15, off: 0.2, sigma: 0.03}, noise: {leak_rate_hz: 2, shot_rate_hz: 10}, "
    "refractory_s: 0.0005, "
    "cutoff_hz: 300, outputs: [events, instance, differences]";

void expect_same_events(const KeptRun& a, const KeptRun& b) {
  EXPECT_EQ(a.joined<int64_t>("eye/dvs", "t"), b.joined<int64_t>("eye/dvs", "t"));
  EXPECT_EQ(a.joined<uint16_t>("eye/dvs", "x"), b.joined<uint16_t>("eye/dvs", "x"));
  EXPECT_EQ(a.joined<uint16_t>("eye/dvs", "y"), b.joined<uint16_t>("eye/dvs", "y"));
  EXPECT_EQ(a.joined<uint8_t>("eye/dvs", "p"), b.joined<uint8_t>("eye/dvs", "p"));
}

TEST(EventSensor, StreamLiesBetweenItsTicksInOneSubmissionATick) {
  const KeptRun r = keep_run(head + van(true) + eye(10.0, dvs("")));
  EXPECT_EQ(r.counters.submits, 3u);  // at 0, 100 and 200 ms
  const std::vector<Array> t = r.arrays("eye/dvs", "t"), pictures = r.arrays("eye/dvs", "pictures");
  ASSERT_EQ(t.size(), 3u);
  EXPECT_EQ(t[0].element_count(), 0);
  for (int64_t k = 1; k < 3; ++k) {
    const auto times = t[size_t(k)].as<int64_t>();
    ASSERT_GT(times.size(), 500u);
    EXPECT_GT(times.front(), (k - 1) * 100'000'000);
    EXPECT_LE(times.back(), k * 100'000'000);
    EXPECT_TRUE(std::ranges::is_sorted(times));
    EXPECT_EQ(pictures[size_t(k)].as<uint32_t>()[0], 4u);
  }
  for (const uint16_t x : r.joined<uint16_t>("eye/dvs", "x")) ASSERT_LT(x, 62);
  for (const uint16_t y : r.joined<uint16_t>("eye/dvs", "y")) ASSERT_LT(y, 46);
  EXPECT_EQ(r.statistics.counters.at("eye/dvs.event_overflow"), 0u);
  EXPECT_EQ(r.statistics.counters.at("eye/dvs.event_pictures"), 8u);
}

TEST(EventSensor, NothingMovesNothingFires) {
  const KeptRun r = keep_run(head + van(false) + eye(0.0, dvs(", outputs: [events, differences]")));
  EXPECT_TRUE(r.joined<int64_t>("eye/dvs", "t").empty());
  for (const Array& d : r.arrays("eye/dvs", "difference"))
    EXPECT_TRUE(std::ranges::all_of(d.as<int8_t>(), [](int8_t v) { return v == 0; }));
  for (const Array& d : r.arrays("eye/dvs", "difference_picture"))
    EXPECT_TRUE(std::ranges::all_of(d.as<uint8_t>(), [](uint8_t v) { return v == 128; }));
}

TEST(EventSensor, SubStepsAreThePicturesOfShorterIntervals) {
  // Camera, mesh and shadow stand where they do at each instant, for four steps of 25 ms in one tick as for
  // four ticks.
  const KeptRun steps = keep_run(head + van(true) + eye(10.0, dvs(", steps: 4", "10")));
  const KeptRun ticks = keep_run(head + van(true) + eye(10.0, dvs(", steps: 1", "40")));
  EXPECT_GT(steps.joined<int64_t>("eye/dvs", "t").size(), 1000u);
  expect_same_events(steps, ticks);
}

TEST(EventSensor, WhatMovesFiresUnderItsOwnName) {
  const KeptRun r = keep_run(head + van(true) + eye(0.0, dvs(", outputs: [events, instance]")));
  std::map<uint32_t, size_t> of_instance;
  for (const uint32_t i : r.joined<uint32_t>("eye/dvs", "instance")) ++of_instance[i];
  const Scenario scenario = parse_scenario(head + van(true) + eye(0.0, dvs("")), "test.yaml", ".");
  const World world = load_world(scenario);
  size_t of_van = 0, all = 0;
  for (const auto& [instance, count] : of_instance) {
    all += count;
    if (instance > 0 && world.scene.instances[instance - 1].body != 0) of_van += count;
  }
  // The other events come from the van's shadow and from ground and walls that it uncovers.
  EXPECT_GT(of_van, 100u);
  EXPECT_GT(double(of_van), 0.3 * double(all));
}

TEST(EventSensor, ResumedRunHasTheBytesOfAWholeOne) {
  for (const std::string& more : {noisy, std::string(", steps: {by: brightness, max_change: 1, most: 8}")}) {
    const std::string yaml = head + van(true) + eye(10.0, dvs(more, "40"));
    const KeptRun whole = keep_run(yaml), rest = keep_run(yaml, 0, 90);
    ASSERT_EQ(whole.packets.size(), 9u);
    ASSERT_EQ(rest.packets.size(), 5u);
    for (size_t k = 0; k < rest.packets.size(); ++k)
      test::expect_same_bytes(whole.sensors, whole.packets[k + 4], rest.packets[k]);
  }
}

TEST(EventSensor, OtherSensorsChangeNothingAndAreNotChanged) {
  const std::string camera =
      "      - {name: front, type: camera, rate_hz: 40, width: 40, height: 30, fov_deg: 70}\n";
  const KeptRun alone = keep_run(head + van(true) + eye(10.0, dvs(noisy, "20")));
  const KeptRun beside = keep_run(head + van(true) + eye(10.0, dvs(noisy, "20") + camera));
  const KeptRun camera_alone = keep_run(head + van(true) + eye(10.0, camera));
  expect_same_events(alone, beside);
  const std::vector<Array> with = beside.arrays("eye/front", "rgb"),
                           without = camera_alone.arrays("eye/front", "rgb");
  ASSERT_EQ(with.size(), without.size());
  for (size_t i = 0; i < with.size(); ++i) EXPECT_TRUE(with[i].bytes == without[i].bytes) << i;
}

TEST(EventSensor, PixelsOfACameraFireAsTheirOwn) {
  // The same view is once rendered for events alone and once taken from the camera at its samples.
  const std::string front =
      "      - {name: front, type: camera, rate_hz: 20, width: 62, height: 46, fov_deg: 70}\n";
  for (const std::string& more : {std::string(", steps: 1"), noisy + ", steps: {by: flow, most: 8}"}) {
    const std::string shared =
        "      - {name: dvs, type: event_camera, camera: front, rate_hz: 20" + more + "}\n";
    const std::string yaml = head + van(true) + eye(10.0, front + shared);
    const KeptRun own = keep_run(head + van(true) + eye(10.0, front + dvs(more, "20"))),
                  with = keep_run(yaml), rest = keep_run(yaml, 0, 90);
    EXPECT_GT(with.joined<int64_t>("eye/dvs", "t").size(), 1000u);
    expect_same_events(own, with);
    ASSERT_EQ(with.packets.size(), 5u);
    ASSERT_EQ(rest.packets.size(), 3u);
    for (size_t k = 0; k < with.packets.size(); ++k) {
      EXPECT_TRUE(with.arrays("eye/front", "rgb")[k].bytes == own.arrays("eye/front", "rgb")[k].bytes) << k;
      if (k >= 2) test::expect_same_bytes(with.sensors, with.packets[k], rest.packets[k - 2]);
    }
  }
}

TEST(EventSensor, SequencesDifferInNoiseAlone) {
  const std::string shot = dvs(", noise: {shot_rate_hz: 20}", "40");
  const std::string yaml = head + van(false) + eye(0.0, shot);
  const std::vector<int64_t> first = keep_run(yaml).joined<int64_t>("eye/dvs", "t");
  EXPECT_GT(first.size(), 100u);
  EXPECT_EQ(first, keep_run(yaml).joined<int64_t>("eye/dvs", "t"));
  EXPECT_NE(first, keep_run(yaml, 1).joined<int64_t>("eye/dvs", "t"));
}

TEST(EventSensor, FlowStepsFollowTheTurning) {
  // 62 pixels see 70 degrees, so fx = 44.3. At the picture's rim the flow is fx w (1 + tan^2 35 deg). It is
  // larger in the corners.
  const auto pictures = [](double turn_deg) {
    const KeptRun r =
        keep_run(head + van(false) + eye(turn_deg, dvs(", steps: {by: flow, max_px: 0.5, most: 32}", "10")));
    EXPECT_EQ(r.statistics.counters.at("eye/dvs.event_pictures_too_coarse"), 0u) << turn_deg;
    return r.arrays("eye/dvs", "pictures")[1].as<uint32_t>()[0];
  };
  EXPECT_EQ(pictures(0.0), 1u);
  const double fx = 31.0 / std::tan(radians(35.0));
  for (const double turn : {5.0, 10.0, 20.0}) {
    const double x = 30.5 / fx, y = 22.5 / fx, rate = radians(turn) / 0.2;
    // Flow of a turn about the vertical: (1 + x^2, x y).
    const double px = 0.1 * fx * rate * std::hypot(1 + x * x, x * y);
    const double step = std::floor(0.5 / px * 32);  // whole instants of the grid
    EXPECT_EQ(pictures(turn), std::ceil(32 / step)) << turn << ": " << px;
  }
}

TEST(EventSensor, OverflowIsReported) {
  const KeptRun r = keep_run(head + van(true) + eye(60.0, dvs(", threshold: 0.01, max_events_per_pixel: 1")));
  const uint64_t dropped = r.statistics.counters.at("eye/dvs.event_overflow");
  EXPECT_GT(dropped, 0u);
  uint64_t sum = 0;
  for (const uint64_t d : r.joined<uint64_t>("eye/dvs", "dropped")) sum += d;
  EXPECT_EQ(sum, dropped);
  EXPECT_EQ(r.arrays("eye/dvs", "t")[1].element_count(), 62 * 46);
  ASSERT_EQ(r.statistics.warnings.size(), 1u);
  EXPECT_THAT(r.statistics.warnings[0],
              ::testing::StartsWith(fmt::format("eye/dvs: {} events were left out", dropped)));
  EXPECT_THAT(r.statistics.warnings[0], ::testing::HasSubstr("max_events_per_pixel"));
}

}  // namespace
}  // namespace greatx::sim
