// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "apps/console/session.h"
#include "apps/console/watch.h"
#include "apps/map/journal.h"
#include "apps/map/output.h"
#include "core/hash.h"
#include "draw/map/background.h"
#include "draw/paths/render.h"
#include "sim/channel/radio_map_values.h"
#include "sim/plan/antennas.h"
#include "sim/plan/plan_options.h"
#include "sim/scenario/parse/load_scenario.h"

namespace greatx::apps {

namespace {

using Json = nlohmann::ordered_json;

struct MapOptions {
  ScenarioOptions scenario;
  RunOptions run;
  sim::ChannelSnapshot::Instant instant;
  std::string output, channel, receiver;
  std::optional<double> plane, height, cell, bandwidth;
  sim::MapOver over = sim::MapOver::ground;
  std::vector<double> min, max, power;
  double noise_figure = 0.0;
  uint32_t side = 960;
  MapFiles files;
  bool inside = false, beyond_scene = false, no_pictures = false, resume = false, json = false, quiet = false;
};

constexpr double default_height_m = 1.5;

/// What is asked of which channel.
struct MapRequest {
  uint32_t channel = 0;
  sim::MapGrid grid;
  sim::MapHeight height;
  sim::MapPower power;
  sim::MapReceiver receiver;
  std::vector<MapMarker> transmitters;
  std::vector<dvec3> ends;  ///< [tx] world positions
};

/// All that needs no scene.
MapRequest map_request(const MapOptions& options, const sim::Scenario& scenario) {
  MapRequest request;
  request.channel = find_channel(options.channel, scenario);
  const sim::ChannelConfig& channel = scenario.channels[request.channel];
  check_instant(options.instant.sequence, options.instant.tick, scenario);
  for (const std::string& name : options.files.quantities) sim::map_quantity(name);
  request.height = {options.plane, options.height.value_or(default_height_m), options.over};
  request.power = sim::map_power(options.power, options.bandwidth, options.noise_figure, channel);
  return request;
}

/// What needs the moment: where transmitters are, how the receiver is turned.
void add_ends(MapRequest& request, const MapOptions& options, const sim::Scenario& scenario,
              const sim::World& world, const sim::Moment& moment) {
  const sim::ChannelConfig& channel = scenario.channels[request.channel];
  for (const std::string& name : channel.transmitters) {
    const dvec3 at = sim::world_position(sim::antenna_end(scenario, world, name), moment.context);
    request.transmitters.push_back({name, dvec2(at)});
    request.ends.push_back(at);
  }
  if (options.receiver.empty()) return;
  const auto place = sim::find_sensor(scenario.nodes, options.receiver);
  if (!place || !std::holds_alternative<sim::AntennaConfig>(
                    scenario.nodes[place->node].sensors[place->sensor].config)) {
    std::vector<std::string> names;
    for (const sim::NodeConfig& node : scenario.nodes)
      for (const sim::SensorConfig& sensor : node.sensors)
        if (std::holds_alternative<sim::AntennaConfig>(sensor.config))
          names.push_back(node.name + "/" + sensor.name);
    throw_user_error("--rx: expected an antenna of the scenario ({}), found '{}'", fmt::join(names, ", "),
                     options.receiver);
  }
  request.receiver.array = sim::antenna_array(scenario, options.receiver, channel.carrier_hz);
  request.receiver.orientation =
      sim::state_of(sim::antenna_end(scenario, world, options.receiver), world, moment.context).orientation;
}

/// Everything that decides the map's bytes.
/// Where everything that moves stands: files that the scenario names decide it, too.
std::string hash_of(std::span<const Pose> bodies) {
  Sha256 hash;
  for (const Pose& pose : bodies) {
    const dquat& q = pose.orientation;
    const double values[] = {pose.position.x, pose.position.y, pose.position.z, q.w, q.x, q.y, q.z};
    hash.update(std::as_bytes(std::span(values)));
  }
  return hash.hex();
}

Json json_of(const MapOptions& options, const MapRequest& request, const sim::Scenario& scenario,
             const sim::World& world, const sim::EffectPlan& plan, const sim::MapCells& cells,
             const gpu::Device& device, const sim::Moment& moment) {
  const sim::ChannelConfig& channel = scenario.channels[request.channel];
  const sim::MapGrid& grid = request.grid;
  const dvec2 max = grid.max_m();
  const dquat& q = request.receiver.orientation;
  Json json{{"greatx", GREATX_VERSION},
            {"scenario", scenario.name},
            {"scenario_sha256", Sha256().update(scenario.text).hex()},
            {"scene_sha256", world.scene.hash},
            {"bodies_sha256", hash_of(moment.bodies)},
            {"device", device.info().name},
            {"driver", device.info().driver},
            {"seed", scenario.seed},
            {"sequence", options.instant.sequence},
            {"tick", moment.context.tick},
            {"time_s", moment.context.time_s},
            {"channel", channel.name},
            {"carrier_hz", channel.carrier_hz},
            {"max_depth", channel.limits.max_depth}};
  json["grid"] = {{"min_m", {grid.min_m.x, grid.min_m.y}},
                  {"max_m", {max.x, max.y}},
                  {"cell_m", grid.cell_m},
                  {"rows", grid.rows},
                  {"columns", grid.columns},
                  {"row_0", "south"},
                  {"column_0", "west"},
                  {"center", "min_m + (index + 0.5) * cell_m"},
                  {"height", cells.height_rule},
                  {"inside_solids", cells.solve_inside}};
  json["transmitters"] = Json::array();
  for (size_t t = 0; t < request.ends.size(); ++t)
    json["transmitters"].push_back(
        {{"name", request.transmitters[t].name},
         {"position_m", {request.ends[t].x, request.ends[t].y, request.ends[t].z}},
         {"power_dbm", request.power.transmit_dbm[t]},
         {"antenna",
          sim::describe_array(sim::antenna_array(scenario, channel.transmitters[t], channel.carrier_hz))}});
  json["receiver"] = {{"antenna", options.receiver.empty() ? "isotropic, vertical" : options.receiver},
                      {"orientation_wxyz", {q.w, q.x, q.y, q.z}},
                      {"array", sim::describe_array(request.receiver.array)}};
  json["noise"] = {{"bandwidth_hz", request.power.bandwidth_hz},
                   {"noise_figure_db", request.power.noise_figure_db},
                   {"temperature_k", sim::MapPower::temperature_k},
                   {"power_dbm", decibels(request.power.noise_w()) + 30.0}};
  json["effects"] = Json::object();
  for (const sim::Effect* effect : plan.all()) json["effects"][effect->name] = effect->on;
  json["quantities"] = options.files.quantities;
  json["pictures"] = {{"on", options.files.pictures},
                      {"each_transmitter", options.files.each_transmitter},
                      {"side", options.side}};
  return json;
}

/// Until every cell has its links, or somebody stops it.
void solve(const MapOptions& options, const MapRequest& request, const sim::Scenario& scenario,
           const sim::MapCells& cells, sim::ChannelSnapshot& snapshot, MapJournal& journal) {
  const size_t transmitters = request.ends.size(), total = cells.grid.cells();
  const auto done = [&] { return journal.links().size() / transmitters; };
  Progress progress("map", static_cast<int64_t>(total), options.quiet, "cells");
  progress.update(static_cast<int64_t>(done()));
  sim::RadioMapSolver solver(snapshot, scenario, request.channel, request.receiver);
  try {
    const TerminalWatch watch(options.quiet);
    solver.solve(cells, done(), [&](std::span<const rf::LinkStatistics> links) {
      journal.append(links);
      progress.update(static_cast<int64_t>(done()));
      return !interrupted();
    });
  } catch (const Interrupted&) {
    // In the midst of some cells: those before are kept.
  }
  if (done() < total)
    throw Interrupted(fmt::format("{}: {} of {} cells are kept; the same command with --resume goes on",
                                  options.output, done(), total));
}

MapStage stage_of(const MapOptions& options, const MapRequest& request, const sim::Scenario& scenario,
                  const sim::MapCells& cells, const sim::Moment& moment) {
  const sim::ChannelConfig& channel = scenario.channels[request.channel];
  MapStage stage;
  stage.cells = &cells;
  stage.transmitters = request.transmitters;
  stage.title = fmt::format("{}, {}", scenario.name, channel.name);
  const std::string where =
      options.plane ? fmt::format("z = {:g} m", *options.plane)
                    : fmt::format("{:g} m above {}", request.height.above_m,
                                  options.over == sim::MapOver::ground ? "ground" : "ground and roofs");
  stage.subtitle = fmt::format("{}, cells of {:g} m, {:.4g} GHz, tick {}", where, cells.grid.cell_m,
                               1e-9 * channel.carrier_hz, moment.context.tick);
  return stage;
}

void run_map(const MapOptions& given) {
  MapOptions options = given;
  options.files.pictures = !options.no_pictures;
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds_since = [](auto start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const sim::Scenario scenario = load_scenario(options.scenario);
  MapRequest request = map_request(options, scenario);
  const sim::World world = sim::load_world(scenario);
  const auto corner = [](const std::vector<double>& xy) {
    return xy.empty() ? std::nullopt : std::optional(dvec2(xy[0], xy[1]));
  };
  request.grid = sim::map_grid_of(corner(options.min), corner(options.max), options.cell, world.scene,
                                  scenario.channels[request.channel].transmitters.size());
  const sim::EffectPlan plan = sim::make_effect_plan(
      scenario, world.scene, sim::bounds_of_cells(request.grid, request.height, world.scene));
  const sim::EffectPlan view_plan = options.files.pictures ? picture_plan(scenario, world.scene) : plan;
  gpu::Device device(options.run.device_options());
  sim::ChannelSnapshot snapshot(device, scenario, world, plan, sim::gpu_scene_options(view_plan),
                                request.channel, options.instant);
  add_ends(request, options, scenario, world, snapshot.moment());
  sim::MapCells cells = sim::place_cells(request.grid, request.height, world.scene, snapshot.model().kinds,
                                         snapshot.moment().bodies, request.ends, options.beyond_scene);
  cells.solve_inside = options.inside;
  const Json asked = json_of(options, request, scenario, world, plan, cells, device, snapshot.moment());

  MapJournal journal(options.output, asked, options.resume);
  if (journal.finished()) {
    if (!options.quiet) std::cout << options.output << " is already finished\n";
    return;
  }
  install_interrupt_handler();
  const size_t before = journal.links().size();
  const auto solving = std::chrono::steady_clock::now();
  solve(options, request, scenario, cells, snapshot, journal);
  const double solve_s = seconds_since(solving);
  const size_t solved = (journal.links().size() - before) / request.ends.size();

  const sim::RadioMap map{&cells, journal.links(), request.power};
  MapStage stage = stage_of(options, request, scenario, cells, snapshot.moment());
  if (options.files.pictures)
    stage.background =
        map_background(cells, world.scene, scenario.environment, view_plan, snapshot, options.side);
  const MapTotals totals = map_totals(map);
  Json description{{"request", asked}, {"totals", totals.json()}};
  for (const auto& [name, text] : snapshot.notes()) description["candidates"][name] = text;
  description.update(write_map_files(options.output, map, stage, options.files));
  device.wait_idle();
  check_validation(device);
  io::write_file_atomically(std::filesystem::path(options.output) / map_description,
                            json_text(description) + "\n");
  journal.finish();

  std::map<std::string, uint64_t> counters;
  snapshot.count(counters);
  if (options.json) {
    Json result{{"output", options.output}, {"totals", totals.json()}, {"transmitters", request.ends.size()},
                {"cells_solved", solved},   {"solve_s", solve_s},      {"seconds", seconds_since(begin)},
                {"counters", counters}};
    std::cout << json_text(result) << '\n';
  } else if (!options.quiet) {
    std::cout << totals.text(request.transmitters);
    std::vector<std::string> counts;
    for (const auto& [name, count] : counters) counts.push_back(fmt::format("{} {}", name, count));
    std::cout << fmt::format("counted: {}\n", fmt::join(counts, ", "));
    std::cout << fmt::format("{} cells x {} transmitters in {:.1f} s ({:.0f} cells/s), all in {:.1f} s\n",
                             solved, request.ends.size(), solve_s,
                             solve_s > 0.0 ? static_cast<double>(solved) / solve_s : 0.0,
                             seconds_since(begin));
    std::cout << "wrote " << options.output << '\n';
  }
}

void add_place(CLI::App& command, MapOptions& options) {
  CLI::Option* plane =
      command.add_option("--plane", options.plane, "one height of the world for all cells, m")
          ->check(number_of(-sim::most_position_m, sim::most_position_m));
  command
      .add_option("--height", options.height,
                  fmt::format("above what lies beneath each cell, m [{}]", default_height_m))
      ->check(number_of(0.0, sim::most_position_m))
      ->excludes(plane);
  command
      .add_option("--over", options.over,
                  "what lies beneath: ground (roads, pavements, terrain), or roofs as well")
      ->transform(CLI::CheckedTransformer(std::map<std::string, sim::MapOver>{
          {"ground", sim::MapOver::ground}, {"roofs", sim::MapOver::roofs}}))
      ->default_str("ground")
      ->excludes(plane);
  command.add_option("--min", options.min, "south-western corner, x y, m [the scene's]")
      ->expected(2)
      ->check(number_of(-sim::most_position_m, sim::most_position_m));
  command.add_option("--max", options.max, "north-eastern corner, x y, m [the scene's]")
      ->expected(2)
      ->check(number_of(-sim::most_position_m, sim::most_position_m));
  command.add_option("--cell", options.cell,
                     "side of a cell, m [1, 2, 5, 10, ...: at most 150 along the longer side]");
  command.add_flag("--inside", options.inside, "values for cells inside solids, too");
  command.add_flag("--beyond-scene", options.beyond_scene, "the map may lie outside of the scene's bounds");
}

void add_radio(CLI::App& command, MapOptions& options) {
  command.add_option("--tick", options.instant.tick, "at which tick")
      ->capture_default_str()
      ->check(integer_of(0, sim::most_ticks));
  command.add_option("--sequence", options.instant.sequence, "in which sequence")
      ->capture_default_str()
      ->check(integer_of(0, sim::most_sequences));
  command.add_option("--channel", options.channel, "name of the channel [the first]");
  command.add_option("--rx", options.receiver,
                     "antenna node/sensor of the scenario to put into every cell, turned as at the tick "
                     "[one isotropic element, vertical]");
  command
      .add_option("--power", options.power,
                  fmt::format("dBm of all transmitters, or P,P,...: one each [the channel's, else {}]",
                              sim::default_map_power_dbm))
      ->delimiter(',');
  command.add_option("--bandwidth", options.bandwidth, "of the noise, Hz [the channel's]");
  command.add_option("--noise-figure", options.noise_figure, "of the receiver, dB")->capture_default_str();
}

}  // namespace

void add_map(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "map", "radio map: gain, SINR, best server, spreads over a plane or the terrain (docs/map.md)");
  auto options = std::make_shared<MapOptions>();
  options->scenario.add_to(*command);
  options->run.add_to(*command);
  command->add_option("-o,--output", options->output, "folder of the map")->required();
  add_place(*command, *options);
  add_radio(*command, *options);
  command
      ->add_option("--quantities", options->files.quantities,
                   "names, with commas between them: arrays and pictures to write [all]")
      ->delimiter(',');
  command->add_flag("--each-transmitter", options->files.each_transmitter,
                    "pictures of each transmitter, beside those of the best server");
  command->add_flag("--no-pictures", options->no_pictures, "arrays alone");
  command->add_option("--side", options->side, "of the map in a picture at most, pixels")
      ->capture_default_str()
      ->check(integer_of(100, 8192));
  command->add_flag("--resume", options->resume, "go on with a map that was stopped");
  command->add_flag("--json", options->json, "print figures as one JSON object");
  command->add_flag("-q,--quiet", options->quiet, "print nothing but errors, and JSON if asked for");
  command->callback([options] { run_map(*options); });
}

}  // namespace greatx::apps
