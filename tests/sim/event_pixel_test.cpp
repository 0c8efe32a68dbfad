// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests event cameras whose pixels look at instants that are reconstructed from rendered pictures, against
// many rendered pictures.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/sensors/event/event_sensor.h"
#include "sim/sensors/event/pixel_paths.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;

const std::string street =
    "greatx: 1\nname: test\nseed: 5\nticks: 201\ntick_rate_hz: 1000\n"
    "scene: {generate: {kind: canyon, seed: 3, size_m: 60}, optical_only: true}\n"
    "environment: {clouds: 0}\nnodes:\n";
const std::string by_pixel = ", steps: {by: pixel, max_px: 0.5}";
const std::string every_effect =
    ", threshold: {on: 0.15, off: 0.2, sigma: 0.03}, noise: {leak_rate_hz: 2, shot_rate_hz: 10}, "
    "refractory_s: 0.0005, cutoff_hz: 300, outputs: [events, instance, differences]";

/// Returns a van beside the street that drives by `way_m` within 0.2 s, and an eye that goes `ahead_m` and
/// turns by `turn_deg`.
std::string nodes(double way_m, double ahead_m, double turn_deg, const std::string& sensors) {
  return fmt::format(
      "  - name: van\n    trajectory: {{type: waypoints, points: [{{t_s: 0, position_m: [2, -6, 0]}}, "
      "{{t_s: 0.2, position_m: [2, {}, 0]}}]}}\n    model: {{generate: {{kind: car, variant: van}}}}\n"
      "  - name: eye\n    trajectory: {{type: waypoints, interpolation: linear, points: [{{t_s: 0, "
      "position_m: [2, -16, 1.6], rotation_deg: [90, 0, 0]}}, {{t_s: 0.2, position_m: [2, {}, 1.6], "
      "rotation_deg: [{}, 0, 0]}}]}}\n    sensors:\n{}",
      -6.0 + way_m, -16.0 + ahead_m, 90.0 + turn_deg, sensors);
}
std::string sensor(const std::string& more, const std::string& rate = "10") {
  return "      - {name: dvs, type: event_camera, rate_hz: " + rate +
         ", width: 124, height: 92, fov_deg: 70, max_events_per_pixel: 50" + more + "}\n";
}

/// Holds the voxel grid of a run: 15 bins over its first 100 ms.
struct Grid {
  explicit Grid(const KeptRun& run) : voxels(15u * 124u * 92u, 0.0) {
    const auto t = run.joined<int64_t>("eye/dvs", "t");
    const auto x = run.joined<uint16_t>("eye/dvs", "x"), y = run.joined<uint16_t>("eye/dvs", "y");
    const auto p = run.joined<uint8_t>("eye/dvs", "p");
    for (size_t i = 0; i < t.size() && t[i] <= 100'000'000; ++i) {
      const double bin = 14e-8 * double(t[i]);
      const size_t first = std::min(size_t(bin), size_t{13}), pixel = y[i] * size_t{124} + x[i];
      const double part = bin - double(first), sign = p[i] != 0 ? 1.0 : -1.0;
      voxels[first * 124 * 92 + pixel] += sign * (1.0 - part);
      voxels[(first + 1) * 124 * 92 + pixel] += sign * part;
      ++events;
    }
  }
  /// Returns the relative L1 distance of another grid from this one.
  double error_of(const Grid& other) const {
    double difference = 0.0, sum = 0.0;
    for (size_t i = 0; i < voxels.size(); ++i) {
      difference += std::abs(voxels[i] - other.voxels[i]);
      sum += std::abs(voxels[i]);
    }
    return difference / sum;
  }
  std::vector<double> voxels;
  size_t events = 0;
};

TEST(EventPixel, NothingMovesNothingFires) {
  const KeptRun run = keep_run(street + nodes(0.0, 0.0, 0.0, sensor(by_pixel)));
  EXPECT_TRUE(run.joined<int64_t>("eye/dvs", "t").empty());
}

TEST(EventPixel, OnePictureComesCloserToManyThanSeveralRenderedOnes) {
  // docs/events.md states the error in a city. Here 64 pictures stand for the truth. While the eye turns, the
  // error is below that of eight pictures, and while it goes ahead, below that of two.
  for (const auto& [ahead_m, turn_deg, pictures] : {std::tuple{0.0, 10.0, 8}, {3.0, 0.0, 2}}) {
    const auto grid_of = [&](const std::string& steps) {
      return Grid(keep_run(street + nodes(2.0, ahead_m, turn_deg, sensor(steps))));
    };
    const Grid truth = grid_of(", steps: 64"), pixels = grid_of(by_pixel),
               rendered = grid_of(fmt::format(", steps: {}", pictures));
    EXPECT_GT(truth.events, 10000u);
    EXPECT_LT(truth.error_of(pixels), truth.error_of(rendered)) << turn_deg;
    EXPECT_LT(truth.error_of(pixels), 0.87) << turn_deg;
    EXPECT_NEAR(double(pixels.events), double(truth.events), 0.25 * double(truth.events)) << turn_deg;
  }
}

TEST(EventPixel, MorePicturesComeCloser) {
  const auto grid_of = [](const std::string& steps) {
    return Grid(keep_run(street + nodes(2.0, 3.0, 0.0, sensor(steps))));
  };
  const Grid truth = grid_of(", steps: 64");
  EXPECT_LT(truth.error_of(grid_of(", steps: {by: pixel, pictures: 8}")), truth.error_of(grid_of(by_pixel)));
}

TEST(EventPixel, PixelsOfACameraFireAsTheirOwnAndResumedRunsHaveTheBytesOfWholeOnes) {
  const std::string front =
      "      - {name: front, type: camera, rate_hz: 20, width: 124, height: 92, fov_deg: 70}\n";
  for (const std::string& more : {by_pixel, every_effect + ", steps: {by: pixel, max_px: 1, pictures: 2}"}) {
    const std::string shared =
        "      - {name: dvs, type: event_camera, camera: front, rate_hz: 20, "
        "max_events_per_pixel: 50" +
        more + "}\n";
    const std::string yaml = street + nodes(2.0, 0.0, 10.0, front + shared);
    const KeptRun own = keep_run(street + nodes(2.0, 0.0, 10.0, front + sensor(more, "20"))),
                  with = keep_run(yaml), rest = keep_run(yaml, 0, 90);
    EXPECT_GT(with.joined<int64_t>("eye/dvs", "t").size(), 1000u);
    EXPECT_EQ(own.joined<int64_t>("eye/dvs", "t"), with.joined<int64_t>("eye/dvs", "t"));
    EXPECT_EQ(own.joined<uint16_t>("eye/dvs", "x"), with.joined<uint16_t>("eye/dvs", "x"));
    ASSERT_EQ(with.packets.size(), 5u);
    ASSERT_EQ(rest.packets.size(), 3u);
    for (size_t k = 2; k < with.packets.size(); ++k)
      test::expect_same_bytes(with.sensors, with.packets[k], rest.packets[k - 2]);
  }
}

TEST(EventPixel, EventsBeyondTheRoomAreTheSameEveryTime) {
  const std::string yaml =
      street + nodes(2.0, 0.0, 20.0,
                     "      - {name: dvs, type: event_camera, rate_hz: 10, width: 124, height: 92, fov_deg: "
                     "70, threshold: 0.02, max_events_per_pixel: 1, steps: {by: pixel, pictures: 2}}\n");
  const KeptRun first = keep_run(yaml), second = keep_run(yaml);
  EXPECT_GT(first.statistics.counters.at("eye/dvs.event_overflow"), 0u);
  EXPECT_EQ(first.arrays("eye/dvs", "t")[1].element_count(), 124 * 92);
  for (size_t k = 0; k < first.packets.size(); ++k)
    test::expect_same_bytes(first.sensors, first.packets[k], second.packets[k]);
  const std::vector<Array> times = first.arrays("eye/dvs", "t");
  EXPECT_TRUE(std::ranges::is_sorted(times[1].as<int64_t>()));
}

TEST(EventPixel, ALensThatDistortsIsRefused) {
  const auto message_of = [](const std::string& more) -> std::string {
    try {
      parse_scenario(street + nodes(0.0, 0.0, 0.0, sensor(more)), "test.yaml", ".");
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message_of(by_pixel), "");
  EXPECT_EQ(message_of(by_pixel + ", distortion: {k1: -0.1}"),
            "test.yaml:15: nodes[1].sensors[0].steps.by: expected 'flow', 'brightness' or a number behind a "
            "lens that distorts, found 'pixel'");
}

/// Returns the paths of a camera that flies ahead and shakes by `shake_rad` at `shake_hz` for 100 ms.
render::PixelPaths paths_of(double shake_rad, double shake_hz, const PinholeConfig& camera) {
  const auto moment_at = [&](double part) {
    const double angle = 0.1 * part + shake_rad * std::sin(2.0 * pi * shake_hz * 0.1 * part);
    EventMoment moment;
    moment.camera = {{1.6 * part, 0.0, 20.0}, orientation_from_yaw_pitch_roll(angle, 0.4, 0.0)};
    moment.bodies = {Pose{}, Pose{{10.0, 2.0 * part, 0.0}, orientation_from_yaw_pitch_roll(part, 0, 0)}};
    return moment;
  };
  render::PixelPaths paths;
  find_pixel_paths(camera, 32, 1.0, moment_at, paths);
  return paths;
}

TEST(EventPixel, PathsLeadFromAnInstantToThePictures) {
  PinholeConfig camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 320.0;
  camera.cx = 320.0;
  camera.cy = 240.0;
  EXPECT_FALSE(paths_of(0.0, 0.0, camera).exact_world);
  EXPECT_TRUE(paths_of(0.01, 50.0, camera).exact_world);
  const render::PixelPaths paths = paths_of(0.0, 0.0, camera);
  ASSERT_EQ(paths.of_bodies.size(), 2u * 33u * 2u);
  // A point of the body, seen at instant 8 of 32 and in the second picture.
  const dvec3 on_body{5.0, 1.0, 3.0};
  const auto project = [&](double part) {
    const Pose eye{{1.6 * part, 0.0, 20.0}, orientation_from_yaw_pitch_roll(0.1 * part, 0.4, 0.0)};
    const Pose body{{10.0, 2.0 * part, 0.0}, orientation_from_yaw_pitch_roll(part, 0, 0)};
    const dvec3 p = eye.inverse().apply(body.apply(on_body));
    return dvec3(camera.cx - camera.fx * p.y / p.x, camera.cy - camera.fy * p.z / p.x, p.x);
  };
  const dvec3 now = project(0.25), then = project(1.0);
  const shared::PixelPath& path = paths.of_bodies[2u * 33u + 8u * 2u + 1u];
  const dvec3 found =
      dvec3(path.o) + now.z * (dvec3(path.r0) + now.x * dvec3(path.rx) + now.y * dvec3(path.ry));
  EXPECT_NEAR(found.x / found.z, then.x, 1e-3);
  EXPECT_NEAR(found.y / found.z, then.y, 1e-3);
  EXPECT_NEAR(found.z, then.z, 1e-4);
}

}  // namespace
}  // namespace greatx::sim
