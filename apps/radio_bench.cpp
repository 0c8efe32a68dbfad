// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/radio_bench.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <variant>

#include <fmt/format.h>

#include "apps/summary.h"
#include "core/random.h"
#include "rf/search/beam_search.h"
#include "sim/channel_paths.h"
#include "sim/moment.h"
#include "sim/plan_options.h"
#include "sim/simulator.h"

namespace greatx::apps {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

struct Discard : RecordSink {
  void write(Packet) override {}
};

nlohmann::json distribution(std::vector<double> samples) {
  if (samples.empty()) return {{"count", 0}};
  std::sort(samples.begin(), samples.end());
  return {{"count", samples.size()},
          {"min", samples.front()},
          {"median", samples[samples.size() / 2]},
          {"max", samples.back()}};
}

/// The scenario's channels and nothing else.
sim::Scenario radio_only(sim::Scenario scenario) {
  for (sim::NodeConfig& node : scenario.nodes)
    std::erase_if(node.sensors, [](const sim::SensorConfig& sensor) {
      return !std::holds_alternative<sim::AntennaConfig>(sensor.config);
    });
  if (scenario.channels.empty())
    throw_user_error("{}: channels: expected one at least for bench --radio, found none", scenario.name);
  return scenario;
}

/// Points in the scene's box, 1.5 m and more above its floor: a function of the seed alone.
std::vector<dvec3> scattered_points(const scene::Scene& scene, uint64_t seed, uint32_t count) {
  RandomStream random(seed, 0x62656e6368ull, 0);  // "bench"
  std::vector<dvec3> points;
  for (uint32_t i = 0; i < count; ++i) {
    const dvec3 size = scene.bounds.size();
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    points.push_back(scene.origin + scene.bounds.min +
                     dvec3(x * size.x, y * size.y, i % 2 == 0 ? 1.5 : 1.5 + z * size.z));
  }
  return points;
}

/// A run of the channels over the scenario's ticks.
nlohmann::json run_ticks(gpu::Device& device, const sim::Scenario& scenario, const sim::World& world,
                         int64_t warm_up, Clock::time_point begin) {
  const sim::EffectPlan plan = sim::make_effect_plan(scenario, world.scene);
  sim::Simulator simulator(device, scenario, world, plan);
  const Clock::time_point start = Clock::now();
  simulator.start(0);
  nlohmann::json row{{"start_ms", milliseconds_since(start)}};
  Discard discard;
  std::vector<double> ticks;
  for (int64_t i = 0;; ++i) {
    const Clock::time_point tick = Clock::now();
    const bool more = simulator.step(discard);
    if (i == 1) row["first_cir_ms"] = milliseconds_since(begin);
    if (!more) break;
    if (i >= warm_up) ticks.push_back(milliseconds_since(tick));
  }
  row["tick_ms"] = distribution(std::move(ticks));
  const sim::RunStatistics statistics = simulator.statistics();
  row["ticks"] = statistics.ticks;
  row["counters"] = statistics.counters;
  return row;
}

/// All points at the first tick, in chunks so that memory stays bounded.
nlohmann::json run_points(gpu::Device& device, const sim::Scenario& scenario, const sim::World& world,
                          uint32_t count) {
  constexpr size_t chunk = 128;
  const sim::EffectPlan plan = sim::make_effect_plan(scenario, world.scene);
  scene::GpuScene gpu_scene(device, world.scene, sim::gpu_scene_options(plan));
  rf::CrossingPass crossings(gpu_scene, rf::facet_kinds(world.scene, sim::radio_effects(plan, scenario)));
  gpu::TickRing ring(device, sim::slots_in_flight, 4u << 20, 4u << 20);
  sim::ChannelPaths paths(gpu_scene, crossings, plan, scenario, world, 0);
  const auto trajectories = sim::make_paths(scenario, 0);
  const sim::Moment moment = sim::moment_at(world, trajectories, sim::Clock(scenario.tick_rate_hz), 0);
  const std::vector<dvec3> points = scattered_points(world.scene, scenario.seed, count);
  paths.set_points(std::span(points).first(0));
  paths.start(moment.context);

  const Clock::time_point begin = Clock::now();
  uint64_t found = 0;
  for (size_t first = 0; first < points.size(); first += chunk) {
    paths.set_points(std::span(points).subspan(first, std::min(chunk, points.size() - first)));
    gpu::TickSlot& slot = ring.begin();
    gpu_scene.record_update(slot, moment.bodies);
    paths.record(slot, moment.context);
    ring.submit(slot);
    ring.wait(slot);
    for (const sim::ChannelPaths::Link& link : paths.collect(slot).links) found += link.paths.size();
  }
  return {{"receivers", count},
          {"ms", milliseconds_since(begin)},
          {"paths", found},
          {"peak_rss_bytes", peak_rss_bytes()}};
}

nlohmann::json run_search(const sim::Scenario& scenario, const sim::World& world) {
  const sim::EffectPlan plan = sim::make_effect_plan(scenario, world.scene);
  const sim::ChannelConfig& channel = scenario.channels[0];
  const rf::RadioModel model(world.scene, channel.carrier_hz, sim::radio_effects(plan, scenario));
  rf::BeamSearchOptions options;
  options.max_depth = channel.max_depth;
  options.max_transmissions = plan.transmission.on ? channel.walls() : 0;
  options.moving_bodies = false;
  const auto trajectories = sim::make_paths(scenario, 0);
  const sim::Moment moment = sim::moment_at(world, trajectories, sim::Clock(scenario.tick_rate_hz), 0);
  dvec3 source(0.0);
  for (size_t node = 0; node < scenario.nodes.size(); ++node)
    for (const sim::SensorConfig& sensor : scenario.nodes[node].sensors)
      if (scenario.nodes[node].name + "/" + sensor.name == channel.transmitter)
        source = (world.scene.to_local(moment.motions[node].pose) * sim::mount_pose(sensor.mount)).position;
  const rf::BeamSearch search(model.facets, model.kinds, model.wedges, options);
  const Clock::time_point begin = Clock::now();
  const rf::BeamSearchResult result = search.search(source);
  return {{"ms", milliseconds_since(begin)},
          {"candidates", result.list.size()},
          {"overflow", result.overflow()},
          {"guarantee", search.guarantee()}};
}

}  // namespace

nlohmann::json radio_bench(const ScenarioOptions& scenario_options, const RunOptions& run,
                           const RadioBenchOptions& options) {
  const Clock::time_point begin = Clock::now();
  sim::Scenario scenario = radio_only(load_scenario(scenario_options));
  const sim::World world = sim::load_world(scenario);
  gpu::Device device(run.device_options());
  nlohmann::json result{{"scenario", scenario.name},
                        {"device", device.info().name},
                        {"driver", device.info().driver},
                        {"facets", world.scene.facets.size()}};
  result["as_written"] = run_ticks(device, scenario, world, options.warm_up, begin);
  result["search"] = run_search(scenario, world);
  result["many"] = run_points(device, scenario, world, options.receivers);
  for (const auto& [name, effects] :
       {std::pair<std::string, std::vector<std::string>>{"diffraction", {"diffraction"}},
        {"scattering", {"scattering"}},
        {"diffraction_and_scattering", {"diffraction", "scattering"}}}) {
    sim::Scenario variant = scenario;
    for (const std::string& effect : effects) variant.effects[effect] = sim::Switch::on;
    result[name] = run_ticks(device, variant, world, options.warm_up, Clock::now());
  }
  check_validation(device);
  return result;
}

std::string radio_bench_text(const nlohmann::json& result) {
  std::string text = fmt::format("{}, radio alone, {} facets, on {} ({})\n",
                                 result["scenario"].get<std::string>(), result["facets"].get<size_t>(),
                                 result["device"].get<std::string>(), result["driver"].get<std::string>());
  const nlohmann::json &first = result["as_written"], &search = result["search"], &many = result["many"];
  uint64_t cached = 0;
  for (const auto& [name, count] : first["counters"].items())
    if (name.ends_with("candidates_from_cache")) cached += count.get<uint64_t>();
  text += fmt::format(
      "  first CIR after {:.0f} ms ({})\n", first.value("first_cir_ms", 0.0),
      cached > 0 ? "candidates from the cache" : "candidates searched: run again for the cached figure");
  text +=
      fmt::format("  search without the cache {:.0f} ms, {} candidates\n    {}\n", search["ms"].get<double>(),
                  search["candidates"].get<size_t>(), search["guarantee"].get<std::string>());
  text += fmt::format("  {} receivers in one call {:.0f} ms, {} paths, peak memory {:.0f} MiB\n",
                      many["receivers"].get<uint32_t>(), many["ms"].get<double>(),
                      many["paths"].get<uint64_t>(), many["peak_rss_bytes"].get<double>() / (1 << 20));
  text += fmt::format("  {:<28} {:>9} {:>9} {:>9} {:>12}   (ms)\n", "tick, nothing written", "min", "median",
                      "max", "paths/tick");
  for (const char* name : {"as_written", "diffraction", "scattering", "diffraction_and_scattering"}) {
    const nlohmann::json& row = result[name];
    if (row["tick_ms"]["count"].get<size_t>() == 0) continue;
    double paths = 0.0;
    for (const auto& [counter, count] : row["counters"].items())
      if (counter.ends_with(".paths")) paths += count.get<double>();
    const double ticks = row["ticks"].get<double>();
    text += fmt::format("  {:<28} {:9.2f} {:9.2f} {:9.2f} {:12.1f}\n", name,
                        row["tick_ms"]["min"].get<double>(), row["tick_ms"]["median"].get<double>(),
                        row["tick_ms"]["max"].get<double>(), paths / ticks);
  }
  return text;
}

}  // namespace greatx::apps
