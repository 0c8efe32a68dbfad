// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The tables of sensor kinds must agree: parser, makers and panels.
#include "sim/sensors/registry/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "draw/sheet/panels.h"
#include "sim/plan/plan_options.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/sensor_kinds.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::sim {
namespace {

const std::string all_kinds = R"(greatx: 1
name: kinds
ticks: 2
tick_rate_hz: 10
scene: {generate: {kind: room}}
environment: {place: {latitude_deg: 52, longitude_deg: 4.4}, time: 2026-06-21T12:00:00Z}
nodes:
  - name: a
    trajectory: {type: static, position_m: [1, 1, 1.5]}
    sensors:
      - {name: radar, type: radar, rate_hz: 10}
      - {name: camera, type: camera, rate_hz: 10, width: 16, height: 12, fov_deg: 70}
      - {name: antenna, type: antenna}
  - name: b
    trajectory: {type: static, position_m: [2, 1, 1.5]}
    sensors:
      - {name: lidar, type: lidar, rate_hz: 5, channels: 2, elevation_min_deg: -5, )"
                              R"(elevation_max_deg: 5, azimuth_steps: 16}
      - {name: eye, type: camera, rate_hz: 10, width: 16, height: 12, fov_deg: 70}
      - {name: dvs, type: event_camera, rate_hz: 10, camera: eye}
      - {name: antenna, type: antenna}
      - {name: imu, type: imu, rate_hz: 10}
      - {name: gnss, type: gnss, rate_hz: 5}
      - {name: air, type: barometer, rate_hz: 10}
      - {name: compass, type: magnetometer, rate_hz: 10}
channels:
  - {name: csi, tx: a/antenna, rx: b/antenna, rate_hz: 5}
)";

TEST(Registry, EverySensorIsMadeInTheScenariosOrderByTheMakerOfItsKind) {
  const Experiment experiment = make_experiment(parse_scenario(all_kinds, "kinds.yaml", "."));
  RadioAhead radio(test::device(), experiment);
  scene::GpuScene gpu_scene(test::device(), experiment.world->scene, gpu_scene_options(experiment.plan));
  SharedPasses passes(radio.begin_radars(gpu_scene), experiment);
  const std::vector<RunSensor> sensors = make_sensors({gpu_scene, passes, experiment, radio});
  std::vector<std::string> made;
  for (const RunSensor& run : sensors) {
    const SensorSpec& spec = run.sensor->spec();
    made.push_back(spec.name + " " + spec.kind);
    EXPECT_EQ(run.rate_hz.has_value(), spec.kind != "pose") << spec.name;
    EXPECT_EQ(run.rate_hz ? run.rate_hz->str() : "", spec.rate) << spec.name;
    EXPECT_EQ(run.where.line > 0, spec.kind != "pose") << spec.name;
    EXPECT_EQ(run.sensor->draws_pictures(), spec.kind.ends_with("camera")) << spec.name;
    EXPECT_TRUE(io::has_panels(spec.kind)) << spec.kind;
  }
  EXPECT_THAT(made, ::testing::ElementsAre("poses pose", "a/radar radar", "a/camera camera", "b/lidar lidar",
                                           "b/eye camera", "b/dvs event_camera", "b/imu imu", "b/gnss gnss",
                                           "b/air barometer", "b/compass magnetometer", "csi csi"));
}

TEST(SensorKinds, EveryKindThatFiresHasPanels) {
  for (const SensorKind& kind : sensor_kinds) EXPECT_EQ(io::has_panels(kind.type), kind.fires) << kind.type;
  EXPECT_FALSE(io::has_panels("theremin"));
}

TEST(SensorKinds, ASentenceHasTheRightArticle) {
  std::vector<std::string> words;
  for (const SensorKind& kind : sensor_kinds) words.push_back(with_article(kind));
  EXPECT_THAT(words, ::testing::ElementsAre("a camera", "an event camera", "a LiDAR", "a radar", "an antenna",
                                            "an inertial sensor", "a GNSS receiver", "a barometer",
                                            "a magnetometer"));
}

}  // namespace
}  // namespace greatx::sim
