// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/sight_bench.h"

#include <filesystem>

#include <fmt/format.h>

#include "apps/bench/measure.h"
#include "apps/bench/radio_rows.h"
#include "apps/bench/recall_scene.h"
#include "apps/bench/row_process.h"
#include "core/built_effects.h"
#include "core/error.h"
#include "rf/channel/frequency_response.h"
#include "sim/channel/channel_snapshot.h"
#include "sim/plan/antennas.h"
#include "sim/plan/effect_list.h"
#include "sim/run/simulator.h"

namespace greatx::apps {

namespace {

constexpr const char* figures[] = {"tick_ms", "links_ms"};

/// Returns the scenario with its first channel only, no sensors but antennas, and the line of sight alone.
sim::Scenario sight_only(const ScenarioOptions& options) {
  sim::Scenario scenario = radio_only(options, tick_rows[0]);
#define GREATX_SWITCH_OFF(name, switchable, passed, documentation) \
  if (switchable) scenario.effects[#name] = sim::Switch::off;
  GREATX_RADIO_EFFECTS(GREATX_SWITCH_OFF)
#undef GREATX_SWITCH_OFF
  scenario.effects["line_of_sight"] = sim::Switch::on;
  return scenario;
}

std::vector<double> ticks_of(gpu::Device& device, const sim::Experiment& experiment,
                             const SightBenchOptions& options) {
  sim::Simulator simulator(device, experiment);
  simulator.start(0);
  Discard discard;
  std::vector<double> ticks;
  const Clock::time_point begin = Clock::now();
  for (int64_t i = 0; ticks.size() < 3 || seconds_since(begin) < options.seconds; ++i) {
    const Clock::time_point tick = Clock::now();
    if (!simulator.step(discard)) break;
    if (i >= options.warm_up) ticks.push_back(milliseconds_since(tick));
  }
  return ticks;
}

/// Measures calls for all receivers. The first call is not counted. Sets `paths` to the paths of one call.
std::vector<double> calls_of(gpu::Device& device, const sim::Experiment& experiment,
                             const SightBenchOptions& options, uint64_t& paths) {
  const sim::Scenario& scenario = experiment.scenario;
  const sim::ChannelConfig& config = scenario.channels[0];
  const rf::ArrayPose transmitter{sim::antenna_array(scenario, config.transmitters[0], config.carrier_hz)},
      receiver{sim::antenna_array(scenario, config.receivers[0], config.carrier_hz)};
  const rf::ChannelGrid grid{config.carrier_hz, config.subcarrier_spacing_hz, config.subcarriers};
  std::vector<std::complex<float>> h(rf::response_size(transmitter, receiver, grid));
  const std::vector<dvec3> points = draw_receivers(experiment.scene(), scenario.seed, options.receivers);
  sim::ChannelSnapshot snapshot(device, experiment, 0, {0, 0, 0});
  std::vector<double> calls;
  for (uint32_t i = 0; i <= options.repeats; ++i) {
    paths = 0;
    const Clock::time_point begin = Clock::now();
    snapshot.solve(points, 0, [&](const sim::ChannelSnapshot::Link& link) {
      paths += link.paths.size();
      rf::frequency_response_into(link.paths, {}, transmitter, receiver, grid, h);
      return true;
    });
    if (i > 0) calls.push_back(milliseconds_since(begin));
  }
  return calls;
}

nlohmann::json own_row(const ScenarioOptions& scenario_options, const RunOptions& run,
                       const SightBenchOptions& options) {
  const sim::Experiment experiment = sim::make_experiment(sight_only(scenario_options));
  gpu::Device device(run.device_options());
  uint64_t paths = 0;
  nlohmann::json row{{"scenario", experiment.scenario.name},
                     {"device", device.info().name},
                     {"driver", device.info().driver},
                     {"effects_built", all_effects_built ? "all" : "line_of_sight"},
                     {"receivers", options.receivers},
                     {"tick_ms", distribution(ticks_of(device, experiment, options))},
                     {"links_ms", distribution(calls_of(device, experiment, options, paths))}};
  row["paths"] = paths;
  check_validation(device);
  return row;
}

/// Runs a program for its own row.
nlohmann::json row_of(const std::string& program, const ScenarioOptions& scenario, const RunOptions& run,
                      const SightBenchOptions& options) {
  std::vector<std::string> command{program,
                                   "bench",
                                   scenario.scenario,
                                   "--line-of-sight",
                                   "--json",
                                   "--many",
                                   std::to_string(options.receivers),
                                   "--warm-up",
                                   std::to_string(options.warm_up),
                                   "--row-seconds",
                                   fmt::format("{}", options.seconds),
                                   "--calls",
                                   std::to_string(options.repeats)};
  const auto add = [&](const char* name, const std::string& value) {
    command.insert(command.end(), {name, value});
  };
  if (!scenario.assets.empty()) add("--assets", scenario.assets);
  if (scenario.seed) add("--seed", std::to_string(*scenario.seed));
  if (scenario.ticks) add("--ticks", std::to_string(*scenario.ticks));
  if (!run.device.empty()) add("--device", run.device);
  if (run.tracer != gpu::Tracer::automatic) add("--tracer", std::string(gpu::name_of(run.tracer)));
  if (run.validation) command.emplace_back("--validation");
  const std::string text = output_of(command);
  const nlohmann::json row = nlohmann::json::parse(text, nullptr, false);
  for (const char* figure : figures)
    if (!row.is_object() || !row.contains(figure) || row[figure].value("count", 0) == 0)
      throw_user_error("bench --against: expected {} of '{}' as JSON, found '{}'", figure, program,
                       text.substr(0, 200));
  return row;
}

double median_of(const std::vector<nlohmann::json>& rows, const char* figure) {
  std::vector<double> medians;
  for (const nlohmann::json& row : rows) medians.push_back(row[figure]["median"]);
  return distribution(medians)["median"];
}

}  // namespace

nlohmann::json sight_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const SightBenchOptions& options) {
  if (options.against.empty()) return own_row(scenario, run, options);
  const std::string programs[2] = {std::filesystem::read_symlink("/proc/self/exe").string(), options.against};
  std::vector<nlohmann::json> rows[2];
  for (uint32_t pair = 0; pair < options.pairs; ++pair)
    for (const size_t turn : {0u, 1u}) {
      const size_t which = pair % 2 == 0 ? turn : 1 - turn;
      rows[which].push_back(row_of(programs[which], scenario, run, options));
    }
  nlohmann::json result;
  for (const char* name : {"scenario", "device", "driver", "receivers"}) result[name] = rows[0][0][name];
  result["pairs"] = options.pairs;
  for (const char* figure : figures) {
    std::vector<double> ratios;
    for (uint32_t pair = 0; pair < options.pairs; ++pair)
      ratios.push_back(rows[0][pair][figure]["median"].get<double>() /
                       rows[1][pair][figure]["median"].get<double>());
    result["ratio"][figure] = distribution(std::move(ratios));
  }
  for (const size_t which : {0u, 1u}) {
    nlohmann::json& program = result[which == 0 ? "this" : "against"];
    for (const char* name : {"effects_built", "paths"}) program[name] = rows[which][0][name];
    for (const char* figure : figures) program[figure] = median_of(rows[which], figure);
  }
  return result;
}

std::string sight_bench_text(const nlohmann::json& result) {
  std::string text =
      fmt::format("{}, line of sight alone, on {} ({})\n", result["scenario"].get<std::string>(),
                  result["device"].get<std::string>(), result["driver"].get<std::string>());
  const std::string names[] = {"tick, nothing written", fmt::format("paths and H of {} receivers",
                                                                    result["receivers"].get<uint32_t>())};
  if (!result.contains("ratio")) {
    text += fmt::format("  built with: {}\n  {:<34} {:>9} {:>9} {:>9}   (ms)\n",
                        result["effects_built"].get<std::string>(), "", "min", "median", "max");
    for (size_t i = 0; i < std::size(figures); ++i) {
      const nlohmann::json& d = result[figures[i]];
      if (d["count"] == 0) continue;
      text += fmt::format("  {:<34} {:9.3f} {:9.3f} {:9.3f}   x {}\n", names[i], d["min"].get<double>(),
                          d["median"].get<double>(), d["max"].get<double>(), d["count"].get<size_t>());
    }
    return text;
  }
  const nlohmann::json &own = result["this"], &other = result["against"];
  text += fmt::format("  built with {} against {}, {} runs each, in turns\n",
                      own["effects_built"].get<std::string>(), other["effects_built"].get<std::string>(),
                      result["pairs"].get<uint32_t>());
  text += fmt::format("  {:<34} {:>9} {:>9} {:>9} {:>7} {:>7}\n", "", "this, ms", "other, ms", "ratio", "min",
                      "max");
  for (size_t i = 0; i < std::size(figures); ++i) {
    const nlohmann::json& ratio = result["ratio"][figures[i]];
    text +=
        fmt::format("  {:<34} {:9.3f} {:9.3f} {:9.3f} {:7.3f} {:7.3f}\n", names[i],
                    own[figures[i]].get<double>(), other[figures[i]].get<double>(),
                    ratio["median"].get<double>(), ratio["min"].get<double>(), ratio["max"].get<double>());
  }
  return text;
}

}  // namespace greatx::apps
