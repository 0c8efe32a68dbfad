// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests errors that are raised while the next tick is in flight. The simulator is destroyed while the device
// still works, under validation, and reports nothing but the error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/sim/radio_run.h"

namespace greatx::sim {
namespace {

using ::testing::HasSubstr;

/// Describes what stands beside the radar, or in its place.
struct Beside {
  const char* name;
  const char* sensors;   ///< YAML of the node's sensors
  const char* channels;  ///< YAML after the nodes
};

const char* const camera =
    "{name: camera, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90, outputs: [rgb, depth]}";
const char* const lidar =
    "{name: lidar, type: lidar, rate_hz: 10, channels: 16, elevation_min_deg: -20, elevation_max_deg: 20, "
    "azimuth_steps: 256}";
const char* const events =
    "{name: events, type: event_camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90, steps: 2}";
const char* const antenna = "{name: antenna, type: antenna}";
const char* const channel =
    "channels: [{name: csi, tx: mast/horn, rx: [car/antenna], rate_hz: 10, carrier_hz: 3.5e9, subcarriers: "
    "16, "
    "bandwidth_hz: 20e6, max_depth: 2}]\n";
const char* const channel_by_rays =
    "channels: [{name: csi, tx: car/antenna, rx: [mast/horn], rate_hz: 10, carrier_hz: 3.5e9, subcarriers: "
    "16, "
    "bandwidth_hz: 20e6, max_depth: 2, rays: 20000}]\n";

std::vector<Beside> kinds() {
  return {{"camera", camera, ""},
          {"events", events, ""},
          {"lidar", lidar, ""},
          {"channel", antenna, channel},
          {"rays", antenna, channel_by_rays},
          {"none", "", ""}};
}

/// Returns a scenario in which a node drives towards a wall at x = 10 m and is 1 cm before it at tick 3.
/// `radar_first` says whether the radar stands before the other sensors.
std::string yaml(const Beside& beside, bool radar, bool radar_first) {
  const std::string radar_yaml =
      "{name: radar, type: radar, rate_hz: 10, waveform: {chirps: 16, samples: 64}, echoes: {tubes: 500}}";
  const std::string other = beside.sensors;
  std::string sensors = other;
  if (radar && other.empty()) sensors = radar_yaml;
  if (radar && !other.empty())
    sensors = radar_first ? radar_yaml + ",\n " + other : other + ",\n " + radar_yaml;
  return "greatx: 1\nname: wall\nseed: 5\nticks: 6\ntick_rate_hz: 10\nenvironment: {clouds: 0}\n"
         "nodes:\n"
         "  - name: mast\n    trajectory: {type: static, position_m: [2, 3, 1]}\n"
         "    sensors: [{name: horn, type: antenna}]\n"
         "  - name: car\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [0, 0, 0]}, "
         "{t_s: 0.3, position_m: [9.99, 0, 0]}, {t_s: 1, position_m: [9.99, 0, 0]}]}\n    sensors: [" +
         sensors + "]\n" + beside.channels;
}

scene::Scene scene_of_a_wall() {
  test::TinyScene tiny;
  tiny.object("wall").quad({10, 6, -3}, {10, -6, -3}, {10, -6, 3}, {10, 6, 3});
  tiny.object("ground").quad({-10, -10, -2}, {20, -10, -2}, {20, 10, -2}, {-10, 10, -2});
  scene::Scene scene = tiny.build();
  for (scene::Material& material : scene.materials)
    material.radio = testing::radio_material("concrete").radio;
  return scene;
}

/// Runs until something throws. Returns the number of packets that were written before the error.
template <typename Error>
size_t packets_until(const std::string& yaml, size_t most_packets, const char* message) {
  const Experiment experiment = testing::experiment_in(yaml, scene_of_a_wall());
  struct Full : RecordSink {
    size_t packets = 0, most = 0;
    void write(Packet) override {
      if (packets == most) throw std::runtime_error("no space is left");
      ++packets;
    }
  } sink;
  sink.most = most_packets;
  try {
    Simulator simulator(test::device(), experiment);
    simulator.start(0);
    while (simulator.step(sink)) continue;
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(message));
  }
  return sink.packets;
}

TEST(ErrorInFlight, RadarAtAWallBesideEachSensor) {
  for (const Beside& beside : kinds())
    for (const bool first : {true, false}) {
      SCOPED_TRACE(beside.name);
      EXPECT_EQ(packets_until<UserError>(yaml(beside, true, first), 100,
                                         "expected nothing within 0.02 m of its antenna, found 'wall'"),
                3u);
    }
}

TEST(ErrorInFlight, APacketThatNobodyTakesFromEachSensor) {
  for (const Beside& beside : kinds()) {
    SCOPED_TRACE(beside.name);
    const bool radar = beside.sensors[0] == '\0';
    EXPECT_EQ(packets_until<std::runtime_error>(yaml(beside, radar, true), 1, "no space is left"), 1u);
  }
}

}  // namespace
}  // namespace greatx::sim
