// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/suite_tick.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "apps/bench/measure.h"
#include "core/error.h"
#include "sim/experiment/experiment.h"
#include "sim/run/simulator.h"
#include "sim/scenario/parse/load_scenario.h"

namespace greatx::apps {

namespace {

constexpr const char* tick_rig = R"(greatx: 1
name: suite
seed: 21
ticks: {ticks}
tick_rate_hz: 10
environment:
  sun: {{azimuth_deg: 50, elevation_deg: 40, illuminance_lux: 95000}}
  sky_illuminance_lux: 16000
nodes:
  - name: mast
    trajectory: {{type: static, position_m: [{x}, {y}, {z}]}}
    sensors:
      - {{name: front, type: camera, rate_hz: 10, width: 320, height: 240, fov_deg: 90,
         mount: {{rotation_deg: [17, 15, 0]}}}}
      - {{name: events, type: event_camera, rate_hz: 10, camera: front, steps: 4}}
      - {{name: lidar, type: lidar, rate_hz: 10, channels: 64, elevation_min_deg: -45, elevation_max_deg: 15,
         azimuth_steps: 1024, max_range_m: 200}}
      - name: radar
        type: radar
        rate_hz: 10
        mount: {{rotation_deg: [0, 15, 0]}}
        waveform: {{carrier_hz: 77e9, bandwidth_hz: 300e6, samples: 256, sample_rate_hz: 25e6,
          adc_start_s: 1.5e-6, chirp_s: 12e-6, interval_s: 13e-6, chirps: 128}}
        transmit: {{pattern: tr38901, columns: 4, column_spacing_wl: 2}}
        receive: {{pattern: tr38901, columns: 4}}
        receiver: {{noise_figure_db: 12}}
      - {{name: antenna, type: antenna, pattern: isotropic, polarization: v}}
  - name: ue
    trajectory: {{type: waypoints, points: [
      {{t_s: 0, position_m: [{ue_x}, {ue_y}, 1.5]}},
      {{t_s: {seconds}, position_m: [{ue_x}, {ue_end}, 1.5]}}]}}
    sensors:
      - {{name: antenna, type: antenna, pattern: isotropic, polarization: v}}
)";

/// Every ray of the search costs the same in each scene; the exact search would grow with the facets in
/// sight.
constexpr const char* tick_channel = R"(channels:
  - {name: csi, tx: mast/antenna, rx: [ue/antenna], rate_hz: 10, carrier_hz: 3.5e9, bandwidth_hz: 100e6,
     subcarriers: 256, max_depth: 2, candidates: rays, rays: 65536}
)";

constexpr int64_t tick_limit = 1000;  ///< ticks that the bodies' trajectories last

std::string rig_text(const SuiteScene& scene) {
  const double seconds = 0.1 * double(tick_limit);
  // The receiver goes along the street between two rows of boxes, some cells from the mast.
  const double street =
      -0.5 * scene.side_m + scene.cell_m * (std::floor(0.5 * scene.side_m / scene.cell_m) + 1.0);
  std::string text = fmt::format(
      fmt::runtime(tick_rig), fmt::arg("ticks", tick_limit), fmt::arg("seconds", seconds),
      fmt::arg("x", scene.mast.x), fmt::arg("y", scene.mast.y), fmt::arg("z", scene.mast.z),
      fmt::arg("ue_x", street), fmt::arg("ue_y", -scene.cell_m), fmt::arg("ue_end", -0.8 * scene.cell_m));
  const std::vector<Pose> first = suite_poses(scene, 0), last = suite_poses(scene, 30);
  for (size_t body = 1; body < first.size(); ++body) {
    const dvec3 a = first[body].position, b = last[body].position;
    text += fmt::format(
        "  - name: body_{}\n    trajectory: {{type: waypoints, points: [{{t_s: 0, position_m: [{}, {}, "
        "{}]}}, "
        "{{t_s: {}, position_m: [{}, {}, {}]}}]}}\n",
        body - 1, a.x, a.y, a.z, seconds, b.x, b.y, b.z);
  }
  return text + tick_channel;
}

sim::Experiment tick_experiment(const SuiteScene& scene) {
  sim::Scenario scenario = sim::parse_scenario(rig_text(scene), "suite", ".");
  sim::World world{scene.scene, {}, {}, {}, {}};
  const size_t bodies = scene.scene.bodies.size();
  GREATX_CHECK(scenario.nodes.size() == bodies + 1, "{} nodes and {} bodies", scenario.nodes.size(), bodies);
  world.body_of_node.assign(2, 0);  // mast and receiver are no bodies
  world.node_of_body.assign(bodies, 0);
  for (uint32_t body = 1; body < bodies; ++body) {
    world.body_of_node.push_back(body);
    world.node_of_body[body] = body + 1;
  }
  world.part_of_body.assign(bodies, sim::World::no_part);
  return sim::make_experiment(std::move(scenario), std::make_shared<const sim::World>(std::move(world)));
}

}  // namespace

struct SuiteTick::State {
  State(gpu::Device& device, const SuiteScene& scene)
      : experiment(tick_experiment(scene)), simulator(device, experiment) {
    simulator.start(0);
  }
  sim::Experiment experiment;
  sim::Simulator simulator;
  Discard discard;
};

SuiteTick::SuiteTick(gpu::Device& device, const SuiteScene& scene)
    : state_(std::make_unique<State>(device, scene)) {}

SuiteTick::~SuiteTick() = default;

void SuiteTick::run() {
  const int64_t end = state_->simulator.next_tick() + ticks_of_a_run;
  while (state_->simulator.next_tick() < end)
    GREATX_CHECK(state_->simulator.step(state_->discard), "the suite has {} ticks", tick_limit);
  state_->simulator.drain(state_->discard);
}

}  // namespace greatx::apps
