// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares whole data sets that the two tracers make of the same scenario (shaders/lib/trace.glsl). The bound
// that docs/performance.md states is tested here.
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/tradeoff/error/error_sum.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;

/// A drone with all sensors, another one, and a car, in a city: rays meet the static world and three bodies,
/// one of which carries them, and pass panes of glass.
constexpr const char* everything = R"(greatx: 1
name: tracers
seed: 5
ticks: 4
tick_rate_hz: 10
scene: {generate: {kind: city, seed: 3, size_m: 100}}
environment: {clouds: 0}
nodes:
  - name: mast
    trajectory: {type: static, position_m: [3, 4, 30]}
    sensors: [{name: panel, type: antenna, polarization: vh, rows: 2, columns: 2}]
  - name: car
    trajectory: {type: waypoints, points: [
      {t_s: 0, position_m: [-30, 2, 0]}, {t_s: 1, position_m: [10, 2, 0]}]}
    model: {generate: {kind: car}}
  - name: other
    trajectory: {type: waypoints, points: [
      {t_s: 0, position_m: [-10, -10, 35]}, {t_s: 1, position_m: [0, 0, 35]}]}
    model: {generate: {kind: quadrotor, variant: large}}
  - name: uav
    trajectory: {type: waypoints, points: [
      {t_s: 0, position_m: [-20, -15, 40]}, {t_s: 1, position_m: [10, 5, 45]}]}
    model: {generate: {kind: quadrotor, variant: large}}
    sensors:
      - {name: camera, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90,
         outputs: [rgb, depth, ids], mount: {rotation_deg: [0, 40, 0]}}
      - {name: lidar, type: lidar, rate_hz: 10, channels: 32, elevation_min_deg: -60, elevation_max_deg: 10,
         azimuth_steps: 256, sweep_s: 0.1}
      - {name: antenna, type: antenna, mount: {position_m: [0, 0, -0.5]}}
channels:
  - {name: beams, tx: mast/panel, rx: [uav/antenna], rate_hz: 10, subcarriers: 16, bandwidth_hz: 20e6,
     max_depth: 2}
  - {name: rays, tx: mast/panel, rx: [uav/antenna], rate_hz: 10, subcarriers: 16, bandwidth_hz: 20e6,
     max_depth: 2, search: every_tick, rays: 20000}
)";

/// Returns the figures of error of a sensor over a whole run, by their names.
std::map<std::string, double> errors_of(const std::string& sensor, const KeptRun& reference,
                                        const KeptRun& run) {
  const SensorSpec& spec = reference.spec(sensor);
  const std::unique_ptr<ErrorSum> sum = make_error_sum(spec.kind);
  for (size_t i = 0; i < run.packets.size(); ++i)
    for (size_t r = 0; r < run.packets[i].records.size(); ++r)
      if (run.sensors[run.packets[i].records[r].sensor].name == sensor)
        sum->add(spec, reference.packets[i].records[r], run.spec(sensor), run.packets[i].records[r]);
  std::map<std::string, double> errors;
  for (const ErrorFigure& figure : sum->figures()) errors[figure.name] = figure.value;
  return errors;
}

TEST(Tracer, BothMakeTheSameDataButForRoundings) {
  if (!test::device().info().has_ray_query()) GTEST_SKIP() << "the driver traces no rays";
  const KeptRun driver = keep_run(everything, 0, 0, gpu::Tracer::driver),
                tree = keep_run(everything, 0, 0, gpu::Tracer::tree);
  ASSERT_EQ(driver.packets.size(), tree.packets.size());
  EXPECT_THAT(driver.note("tracer"), ::testing::StartsWith("driver"));
  EXPECT_THAT(tree.note("tracer"), ::testing::StartsWith("tree"));
  // Pictures and poses have no rays.
  for (size_t i = 0; i < driver.packets.size(); ++i)
    for (const char* sensor : {"uav/camera", "poses"})
      for (const ArraySpec& array : driver.spec(sensor).arrays)
        EXPECT_TRUE(driver.array(i, sensor, array.name).bytes == tree.array(i, sensor, array.name).bytes)
            << i << ' ' << sensor << '.' << array.name;
  // The host decides in fp64 about rays near edges, so the paths are the same. The lengths inside foliage are
  // fractions of segments in fp32.
  for (const char* channel : {"beams", "rays"}) {
    EXPECT_GT(driver.counter(std::string(channel) + ".paths"), 4u);
    for (const char* exact : {"id", "delay", "departure", "interaction", "path_count"})
      for (size_t i = 0; i < driver.packets.size(); ++i)
        EXPECT_TRUE(driver.array(i, channel, exact).bytes == tree.array(i, channel, exact).bytes)
            << i << ' ' << channel << '.' << exact;
    EXPECT_LE(errors_of(channel, driver, tree).at("nmse"), -120.0);
  }
  // Beams that pass an edge within a rounding error may meet either side of it.
  const std::map<std::string, double> lidar = errors_of("uav/lidar", driver, tree);
  EXPECT_GT(driver.joined<float>("uav/lidar", "range").size(), 4u * 3000u);
  EXPECT_LE(lidar.at("missed"), 0.1);
  EXPECT_LE(lidar.at("range_p95"), 1e-4);
  EXPECT_LE(lidar.at("intensity"), 1e-4);
}

}  // namespace
}  // namespace greatx::sim
