// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Rows of the steps after the paths: frequency responses, records, files.
#include <algorithm>

#include "apps/bench/radio_rows.h"
#include "apps/bench/recall_scene.h"
#include "apps/paths/cfr.h"
#include "io/dataset/dataset_writer.h"
#include "sim/channel/blocks.h"
#include "sim/channel/link_ends.h"
#include "sim/dataset/dataset_info.h"
#include "sim/plan/antennas.h"
#include "sim/plan/array_plan.h"
#include "sim/run/simulator.h"

namespace greatx::apps {

namespace {

/// Times to reach on two cores, ms.
constexpr double response_target_ms = 1.0, written_tick_target_ms = 4.0, many_responses_target_ms = 8000.0;
constexpr size_t response_paths = 20;

const TickRow& plain_tick = tick_rows[0];

}  // namespace

std::vector<rf::Path> some_paths(sim::ChannelSnapshot& snapshot, std::span<const dvec3> points,
                                 size_t count) {
  std::vector<rf::Path> paths;
  snapshot.solve(points, 0, [&](sim::ChannelSnapshot::Link link) {
    paths.insert(paths.end(), link.paths.begin(), link.paths.end());
    return paths.size() < count;
  });
  if (paths.empty())
    throw_user_error("bench --radio: expected a path to one of {} points, found none", points.size());
  for (size_t i = 0; paths.size() < count; ++i) paths.push_back(paths[i]);
  paths.resize(count);
  return paths;
}

nlohmann::json response_row(const ScenarioOptions& scenario_options, const RunOptions& run) {
  const sim::Experiment experiment = sim::make_experiment(radio_only(scenario_options, plain_tick));
  gpu::Device device(run.device_options());
  sim::ChannelSnapshot snapshot(device, experiment, 0, {});
  const std::vector<rf::Path> paths =
      some_paths(snapshot, draw_receivers(experiment.scene(), experiment.scenario.seed, 100), response_paths);
  const sim::Scenario& scenario = experiment.scenario;
  const sim::ChannelConfig& config = scenario.channels[0];
  const sim::LinkEnds ends = sim::link_ends(
      scenario, config, sim::antenna_array(scenario, config.transmitters[0], config.carrier_hz), {},
      sim::antenna_array(scenario, config.receivers[0], config.carrier_hz), {}, sim::half_band_hz(config));
  const rf::ArrayPose &transmitter = ends.transmitter, &receiver = ends.receiver;
  const rf::ChannelGrid grid = sim::channel_grid(config, experiment.plan);
  std::vector<std::complex<float>> h(rf::response_size(transmitter, receiver, grid));
  std::vector<double> samples;
  for (int i = 0; i < 200; ++i) {
    const Clock::time_point begin = Clock::now();
    rf::frequency_response_into(paths, {}, transmitter, receiver, grid, h);
    samples.push_back(milliseconds_since(begin));
  }
  check_validation(device);
  nlohmann::json row{{"paths", paths.size()},
                     {"ports", transmitter.array.port_count() * receiver.array.port_count()},
                     {"subcarriers", grid.subcarriers},
                     {"response_ms", distribution(std::move(samples))}};
  row["ms"] = row["response_ms"]["median"];
  set_target(row, response_target_ms, row["ms"]);
  return row;
}

nlohmann::json written_tick_row(const ScenarioOptions& scenario_options, const RunOptions& run,
                                const RadioBenchOptions& options) {
  const sim::Experiment experiment = sim::make_experiment(radio_only(scenario_options, plain_tick));
  gpu::Device device(run.device_options());
  sim::Simulator simulator(device, experiment);
  const ScratchFolder scratch;
  io::DatasetWriter writer(scratch.path(), sim::dataset_info(experiment, device, simulator.sensors()));
  writer.begin_sequence(0);
  simulator.start(0);
  std::vector<double> ticks;
  const Until until(options);
  for (int64_t i = 0; !until.enough(ticks.size()); ++i) {
    const Clock::time_point tick = Clock::now();
    if (!simulator.step(writer)) break;
    if (i >= options.warm_up) ticks.push_back(milliseconds_since(tick));
  }
  check_validation(device);
  nlohmann::json row{{"tick_ms", distribution(std::move(ticks))}};
  if (row["tick_ms"]["count"] > 0) set_target(row, written_tick_target_ms, row["tick_ms"]["median"]);
  return row;
}

nlohmann::json many_responses_row(const ScenarioOptions& scenario_options, const RunOptions& run,
                                  uint32_t receivers) {
  const sim::Experiment experiment = sim::make_experiment(radio_only(scenario_options, plain_tick));
  gpu::Device device(run.device_options());
  const std::vector<dvec3> points = draw_receivers(experiment.scene(), experiment.scenario.seed, receivers);
  sim::ChannelSnapshot snapshot(device, experiment, 0, {0, 0, 0});
  const ScratchFolder scratch;
  const auto stop = [](sim::ChannelSnapshot::Link) { return false; };
  snapshot.solve(std::span(points).first(1), 0, stop);  // runs the search, or reads it from the cache
  const Clock::time_point begin = Clock::now();
  CfrFile file(scratch.path() / "cfr.npy", snapshot, 0, points.size());
  snapshot.solve(points, 0, [&](sim::ChannelSnapshot::Link link) {
    file.add(link);
    return true;
  });
  file.finish();
  nlohmann::json row{{"ms", milliseconds_since(begin)}, {"receivers", receivers}};
  check_validation(device);
  set_target(row, many_responses_target_ms, row["ms"]);
  return row;
}

}  // namespace greatx::apps
