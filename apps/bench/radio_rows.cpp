// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/radio_rows.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "apps/bench/recall_scene.h"
#include "core/units.h"
#include "rf/channel/frequency_response.h"
#include "rf/search/beam_search.h"
#include "sim/channel/blocks.h"
#include "sim/channel/channel_snapshot.h"
#include "sim/channel/link_ends.h"
#include "sim/plan/antennas.h"
#include "sim/plan/array_plan.h"
#include "sim/plan/plan_options.h"
#include "sim/run/simulator.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/world/moment.h"

namespace greatx::apps {

namespace {

/// Times to reach on etoile (assets/examples/etoile_walls.yaml) on two cores, ms. With diffraction and
/// scattering, it is the time that Sionna RT 2.2.0 needs for a position in that scene.
constexpr double first_cir_target_ms = 1000.0, search_target_ms = 10'000.0, tick_target_ms = 2.5,
                 many_target_ms = 3000.0, sionna_effects_ms = 430.0;

uint64_t counter(const sim::RunStatistics& statistics, const std::string& ending) {
  uint64_t sum = 0;
  for (const auto& [name, count] : statistics.counters)
    if (name.ends_with("." + ending)) sum += count;
  return sum;
}

/// Measures the whole tick as in a run, where the host works on one tick while the GPU works on another.
nlohmann::json pipelined(gpu::Device& device, const sim::Experiment& experiment,
                         const RadioBenchOptions& options) {
  sim::Simulator simulator(device, experiment);
  simulator.start(0);
  Discard discard;
  std::vector<double> ticks;
  const Until until(options);
  for (int64_t i = 0; !until.enough(ticks.size()); ++i) {
    const Clock::time_point tick = Clock::now();
    if (!simulator.step(discard)) break;
    if (i >= options.warm_up) ticks.push_back(milliseconds_since(tick));
  }
  const sim::RunStatistics statistics = simulator.statistics();
  const auto per = [](uint64_t count, int64_t of) {
    return static_cast<double>(count) / static_cast<double>(std::max<int64_t>(1, of));
  };
  return {{"tick_ms", distribution(std::move(ticks))},
          {"candidates", counter(statistics, "candidates")},
          {"geometric_paths", per(counter(statistics, "geometric_paths"), statistics.ticks)},
          {"path_overflow", counter(statistics, "path_overflow")},
          {"paths", per(counter(statistics, "paths"), statistics.packets)}};
}

/// Measures the same ticks stage by stage. Each stage waits for the one before.
nlohmann::json staged(gpu::Device& device, const sim::Experiment& experiment,
                      const RadioBenchOptions& options) {
  const sim::Scenario& scenario = experiment.scenario;
  const sim::World& world = *experiment.world;
  const sim::ChannelConfig& config = scenario.channels[0];
  scene::GpuScene gpu_scene(device, world.scene, sim::gpu_scene_options(experiment.plan));
  gpu::TickRing ring(device, sim::slots_in_flight, 4u << 20, 4u << 20);
  rf::CrossingPass crossings(gpu_scene, rf::facet_kinds(world.scene, sim::radio_effects(experiment)));
  sim::ChannelPaths channel(gpu_scene, crossings, experiment, 0);
  const rf::AntennaArray transmitter =
      sim::antenna_array(scenario, config.transmitters[0], config.carrier_hz);
  std::vector<rf::AntennaArray> receivers;
  for (const std::string& name : config.receivers)
    receivers.push_back(sim::antenna_array(scenario, name, config.carrier_hz));
  const sim::Courses courses = sim::make_courses(scenario, world, 0);
  const rf::ChannelGrid grid = sim::channel_grid(config, experiment.plan);
  std::vector<double> stages[4];
  const Until until(options);
  for (int64_t tick = 0; tick < scenario.ticks && !until.enough(stages[0].size()); ++tick) {
    const sim::Moment moment =
        sim::moment_at(world, courses, sim::Clock(scenario.tick_rate_hz), tick, tick - 1);
    if (tick == 0) channel.start(moment.context);
    gpu::TickSlot& slot = ring.begin();
    gpu_scene.record_update(slot, moment.bodies);
    Clock::time_point times[5] = {Clock::now()};
    channel.record(slot, moment.context);
    times[1] = Clock::now();
    ring.submit(slot);
    ring.wait(slot);
    times[2] = Clock::now();
    const sim::ChannelPaths::Result result = channel.collect(slot);
    times[3] = Clock::now();
    for (size_t r = 0; r < result.links.size(); ++r) {
      const sim::LinkEnds ends =
          sim::link_ends(scenario, config, transmitter, result.transmitter, receivers[r],
                         result.links[r].receiver, sim::half_band_hz(config));
      rf::frequency_response(result.links[r].paths, ends.transmitter, ends.receiver, grid);
    }
    times[4] = Clock::now();
    for (int i = 0; i < 4 && tick >= options.warm_up; ++i)
      stages[i].push_back(std::chrono::duration<double, std::milli>(times[i + 1] - times[i]).count());
  }
  return {{"geometry_ms", distribution(std::move(stages[0]))},
          {"crossings_ms", distribution(std::move(stages[1]))},
          {"fields_ms", distribution(std::move(stages[2]))},
          {"response_ms", distribution(std::move(stages[3]))}};
}

}  // namespace

sim::Scenario radio_only(const ScenarioOptions& options, const TickRow& row) {
  sim::Scenario scenario = load_scenario(options);
  for (sim::NodeConfig& node : scenario.nodes)
    std::erase_if(node.sensors, [](const sim::SensorConfig& sensor) {
      return !std::holds_alternative<sim::AntennaConfig>(sensor.config);
    });
  if (scenario.channels.empty())
    throw_user_error("{}: channels: expected one at least for bench --radio, found none", scenario.name);
  scenario.channels.resize(1);
  const auto on = [](bool is_on) { return is_on ? sim::Switch::on : sim::Switch::off; };
  scenario.effects["diffraction"] = on(row.diffraction);
  scenario.effects["scattering"] = on(row.scattering);
  return scenario;
}

void set_target(nlohmann::json& row, double target, double measured) {
  row["target"] = target;
  row["ratio"] = measured / target;
}

nlohmann::json first_cir_row(const ScenarioOptions& options, const RunOptions& run, Clock::time_point begin) {
  sim::Scenario scenario = radio_only(options, tick_rows[0]);
  scenario.ticks = 1;
  const sim::Experiment experiment = sim::make_experiment(std::move(scenario));
  gpu::Device device(run.device_options());
  sim::Simulator simulator(device, experiment);
  simulator.start(0);
  Discard discard;
  while (simulator.step(discard)) continue;
  nlohmann::json row{{"ms", milliseconds_since(begin)},
                     {"from_cache", counter(simulator.statistics(), "candidates_from_cache") > 0}};
  check_validation(device);
  set_target(row, first_cir_target_ms, row["ms"]);
  return row;
}

nlohmann::json search_row(const ScenarioOptions& options) {
  const sim::Experiment experiment = sim::make_experiment(radio_only(options, tick_rows[0]));
  const sim::Scenario& scenario = experiment.scenario;
  const sim::World& world = *experiment.world;
  const sim::ChannelConfig& channel = scenario.channels[0];
  const rf::RadioModel model(world.scene, channel.carrier_hz, sim::radio_effects(experiment));
  const sim::Courses courses = sim::make_courses(scenario, world, 0);
  const sim::Moment moment = sim::moment_at(world, courses, sim::Clock(scenario.tick_rate_hz), 0);
  rf::BeamSearchOptions search_options;
  search_options.max_depth = channel.limits.max_depth;
  search_options.max_transmissions = experiment.plan.transmission.on ? channel.walls() : 0;
  const rf::BeamSearch search(model.facets, model.kinds, model.wedges, search_options);
  const dvec3 source = transmitter_position(scenario, world, moment);
  const Clock::time_point begin = Clock::now();
  const rf::BeamSearchResult result = search.search(source);
  nlohmann::json row{{"ms", milliseconds_since(begin)},
                     {"candidates", result.list.size()},
                     {"overflow", result.overflow()},
                     {"guarantee", search.guarantee()}};
  set_target(row, search_target_ms, row["ms"]);
  return row;
}

nlohmann::json tick_row(const ScenarioOptions& scenario_options, const RunOptions& run,
                        const RadioBenchOptions& options, const TickRow& which) {
  const sim::Experiment experiment = sim::make_experiment(radio_only(scenario_options, which));
  gpu::Device device(run.device_options());
  nlohmann::json row = pipelined(device, experiment, options);
  row.update(staged(device, experiment, options));
  check_validation(device);
  const bool bare = !which.diffraction && !which.scattering;
  if (row["tick_ms"]["count"] > 0)
    set_target(row, bare ? tick_target_ms : sionna_effects_ms, row["tick_ms"]["median"]);
  return row;
}

nlohmann::json many_row(const ScenarioOptions& scenario_options, const RunOptions& run, uint32_t receivers) {
  const sim::Experiment experiment = sim::make_experiment(radio_only(scenario_options, tick_rows[0]));
  gpu::Device device(run.device_options());
  const std::vector<dvec3> points = draw_receivers(experiment.scene(), experiment.scenario.seed, receivers);
  sim::ChannelSnapshot snapshot(device, experiment, 0, {});
  uint64_t paths = 0;
  const auto take = [&](sim::ChannelSnapshot::Link link) {
    paths += link.paths.size();
    return true;
  };
  snapshot.solve(std::span(points).first(1), 0, take);  // runs the search, or reads it from the cache
  paths = 0;
  const Clock::time_point begin = Clock::now();
  snapshot.solve(points, 0, take);
  nlohmann::json row{{"ms", milliseconds_since(begin)}, {"receivers", receivers}, {"paths", paths}};
  check_validation(device);
  set_target(row, many_target_ms, row["ms"]);
  return row;
}

}  // namespace greatx::apps
