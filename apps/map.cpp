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
#include "core/text.h"
#include "draw/map/background.h"
#include "draw/paths/render.h"
#include "sim/channel/radio_map_run.h"
#include "sim/experiment/experiment.h"
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
  std::string precoder = "mean";
  std::optional<uint64_t> beam;
  std::vector<uint32_t> oversampling;
  uint32_t side = 960;
  MapFiles files;
  bool inside = false, beyond_scene = false, no_pictures = false, resume = false, json = false, quiet = false;
};

constexpr double default_height_m = 1.5;

/// Returns the request, with all checks that need no scene. Throws UserError.
sim::MapRequest map_request(const MapOptions& options, const sim::ChannelConfig& channel,
                            const sim::Scenario& scenario) {
  check_instant(options.instant.sequence, options.instant.tick, scenario);
  sim::MapPrecoder precoder{sim::map_precoding(options.precoder), options.beam, {}};
  if (!options.oversampling.empty())
    precoder.oversampling = std::array{options.oversampling[0], options.oversampling[1]};
  for (const std::string& name : options.files.quantities)
    if (sim::map_quantity(name).precoded && precoder.precoding == sim::MapPrecoding::mean)
      throw_user_error("--quantities: expected --precoder for '{}', found none", name);
  const auto corner = [](const std::vector<double>& xy) {
    return xy.empty() ? std::nullopt : std::optional(dvec2(xy[0], xy[1]));
  };
  sim::MapRequest request;
  request.min_m = corner(options.min);
  request.max_m = corner(options.max);
  request.cell_m = options.cell;
  request.height = {options.plane, options.height.value_or(default_height_m), options.over};
  request.power_dbm = options.power;
  request.bandwidth_hz = options.bandwidth;
  request.noise_figure_db = options.noise_figure;
  request.precoder = precoder;
  request.inside_solids = options.inside;
  request.beyond_scene = options.beyond_scene;
  sim::check_map_request(request, channel);
  return request;
}

/// Returns the antenna of the scenario that --rx names, with its orientation at the moment of the snapshot;
/// the default receiver without --rx. Throws UserError if there is no such antenna.
sim::MapReceiver map_receiver(const MapOptions& options, const sim::ChannelSnapshot& snapshot) {
  if (options.receiver.empty()) return {};
  const sim::Experiment& experiment = snapshot.experiment();
  const sim::Scenario& scenario = experiment.scenario;
  const auto place = sim::find_sensor(scenario.nodes, options.receiver);
  if (!place || !std::holds_alternative<sim::AntennaConfig>(
                    scenario.nodes[place->node].sensors[place->sensor].config)) {
    std::vector<std::string> names;
    for (const sim::NodeConfig& node : scenario.nodes)
      for (const sim::SensorConfig& sensor : node.sensors)
        if (std::holds_alternative<sim::AntennaConfig>(sensor.config))
          names.push_back(node.name + "/" + sensor.name);
    throw_user_error("--rx: expected an antenna of the scenario ({}), found '{}'{}", fmt::join(names, ", "),
                     options.receiver, suggestion(options.receiver, names));
  }
  const double carrier_hz = scenario.channels[snapshot.channel()].carrier_hz;
  return {sim::antenna_array(scenario, options.receiver, carrier_hz),
          sim::state_of(sim::antenna_end(experiment, options.receiver), *experiment.world,
                        snapshot.moment().context)
              .orientation};
}

/// Returns a hash of the poses of all bodies. It is part of the request because the poses also depend on
/// files that the scenario names.
std::string hash_of(std::span<const Pose> bodies) {
  Sha256 hash;
  for (const Pose& pose : bodies) {
    const dquat& q = pose.orientation;
    const double values[] = {pose.position.x, pose.position.y, pose.position.z, q.w, q.x, q.y, q.z};
    hash.update(std::as_bytes(std::span(values)));
  }
  return hash.hex();
}

/// Returns everything that decides the bytes of the map.
Json json_of(const MapOptions& options, const sim::ChannelSnapshot& snapshot, const sim::RadioMapRun& map,
             const gpu::Device& device) {
  const auto& [scenario, world, plan] = snapshot.experiment();
  const sim::ChannelConfig& channel = scenario.channels[snapshot.channel()];
  const sim::Moment& moment = snapshot.moment();
  const sim::MapGrid& grid = map.cells().grid;
  const dvec2 max = grid.max_m();
  const dquat& q = map.receiver().orientation;
  Json json{{"greatx", GREATX_VERSION},
            {"scenario", scenario.name},
            {"scenario_sha256", Sha256().update(scenario.text).hex()},
            {"scene_sha256", world->scene.hash},
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
                  {"height", map.cells().height_rule},
                  {"inside_solids", map.cells().solve_inside}};
  json["transmitters"] = Json::array();
  for (size_t t = 0; t < map.transmitters().size(); ++t) {
    const std::string& name = channel.transmitters[t];
    const dvec3& at = map.transmitters()[t];
    json["transmitters"].push_back(
        {{"name", name},
         {"position_m", {at.x, at.y, at.z}},
         {"power_dbm", map.power().transmit_dbm[t]},
         {"antenna", sim::describe_array(sim::antenna_array(scenario, name, channel.carrier_hz))}});
  }
  json["receiver"] = {{"antenna", options.receiver.empty() ? "isotropic, vertical" : options.receiver},
                      {"orientation_wxyz", {q.w, q.x, q.y, q.z}},
                      {"array", sim::describe_array(map.receiver().array)}};
  json["noise"] = {{"bandwidth_hz", map.power().bandwidth_hz},
                   {"noise_figure_db", map.power().noise_figure_db},
                   {"temperature_k", sim::MapPower::temperature_k},
                   {"power_dbm", decibels(map.power().noise_w()) + 30.0}};
  if (map.precoding() != sim::MapPrecoding::mean) {
    json["precoder"] = {{"name", options.precoder}};
    if (options.beam) json["precoder"]["beam"] = *options.beam;
    if (map.precoding() != sim::MapPrecoding::maximum_ratio)
      json["precoder"]["oversampling"] =
          options.oversampling.empty() ? std::vector<uint32_t>{1, 1} : options.oversampling;
  }
  json["effects"] = Json::object();
  for (const sim::Effect* effect : plan.all()) json["effects"][effect->name] = effect->on;
  json["quantities"] = options.files.quantities;
  json["pictures"] = {{"on", options.files.pictures},
                      {"each_transmitter", options.files.each_transmitter},
                      {"side", options.side}};
  return json;
}

/// Solves the cells that have no links yet. Throws Interrupted if it is stopped before the last cell.
void solve(const MapOptions& options, sim::RadioMapRun& map, MapJournal& journal) {
  const size_t transmitters = map.transmitters().size(), total = map.cells().grid.cells();
  const auto done = [&] { return journal.links().size() / transmitters; };
  Progress progress("map", static_cast<int64_t>(total), options.quiet, "cells");
  progress.update(static_cast<int64_t>(done()));
  try {
    const TerminalWatch watch(options.quiet);
    map.solve(done(), [&](std::span<const sim::MapLink> links) {
      journal.append(links);
      progress.update(static_cast<int64_t>(done()));
      return !interrupted();
    });
  } catch (const Interrupted&) {
    // The cells in progress are lost; the cells before them are kept.
  }
  if (done() < total)
    throw Interrupted(fmt::format("{}: {} of {} cells are kept; the same command with --resume goes on",
                                  options.output, done(), total));
}

MapStage stage_of(const MapOptions& options, const sim::MapRequest& request,
                  const sim::ChannelSnapshot& snapshot, const sim::RadioMapRun& map) {
  const sim::Scenario& scenario = snapshot.experiment().scenario;
  const sim::ChannelConfig& channel = scenario.channels[snapshot.channel()];
  MapStage stage;
  stage.cells = &map.cells();
  for (size_t t = 0; t < map.transmitters().size(); ++t)
    stage.transmitters.push_back({channel.transmitters[t], dvec2(map.transmitters()[t])});
  stage.title = fmt::format("{}, {}", scenario.name, channel.name);
  const std::string where =
      options.plane ? fmt::format("z = {:g} m", *options.plane)
                    : fmt::format("{:g} m above {}", request.height.above_m,
                                  options.over == sim::MapOver::ground ? "ground" : "ground and roofs");
  stage.subtitle = fmt::format("{}, cells of {:g} m, {:.4g} GHz, tick {}", where, map.cells().grid.cell_m,
                               1e-9 * channel.carrier_hz, snapshot.moment().context.tick);
  return stage;
}

void run_map(const MapOptions& given) {
  MapOptions options = given;
  options.files.pictures = !options.no_pictures;
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds_since = [](auto start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  sim::Scenario scenario = load_scenario(options.scenario);
  const uint32_t number = find_channel(options.channel, scenario);
  const sim::ChannelConfig channel = scenario.channels[number];
  const sim::MapRequest request = map_request(options, channel, scenario);
  auto world = std::make_shared<const sim::World>(sim::load_world(scenario));
  const scene::Bounds bounds = sim::map_bounds(request, channel, world->scene);
  const sim::Experiment experiment = sim::make_experiment(std::move(scenario), std::move(world), bounds);
  const sim::EffectPlan view_plan = options.files.pictures ? picture_plan(experiment) : experiment.plan;
  gpu::Device device(options.run.device_options());
  sim::ChannelSnapshot snapshot(device, experiment, number, options.instant,
                                sim::gpu_scene_options(view_plan));
  sim::RadioMapRun run(snapshot, request, map_receiver(options, snapshot));
  const Json asked = json_of(options, snapshot, run, device);

  MapJournal journal(options.output, asked, options.resume);
  if (journal.finished()) {
    if (!options.quiet) std::cout << options.output << " is already finished\n";
    return;
  }
  install_interrupt_handler();
  const size_t before = journal.links().size();
  const auto solving = std::chrono::steady_clock::now();
  solve(options, run, journal);
  const double solve_s = seconds_since(solving);
  const size_t solved = (journal.links().size() - before) / run.transmitters().size();

  const sim::RadioMap map = run.map(journal.links());
  MapStage stage = stage_of(options, request, snapshot, run);
  if (options.files.pictures)
    stage.background = map_background(run.cells(), view_plan, snapshot, options.side);
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
    Json result{{"output", options.output}, {"totals", totals.json()}, {"transmitters", map.transmitters()},
                {"cells_solved", solved},   {"solve_s", solve_s},      {"seconds", seconds_since(begin)},
                {"counters", counters}};
    std::cout << json_text(result) << '\n';
  } else if (!options.quiet) {
    std::cout << totals.text(stage.transmitters);
    std::vector<std::string> counts;
    for (const auto& [name, count] : counters) counts.push_back(fmt::format("{} {}", name, count));
    std::cout << fmt::format("counted: {}\n", fmt::join(counts, ", "));
    std::cout << fmt::format("{} cells x {} transmitters in {:.1f} s ({:.0f} cells/s), all in {:.1f} s\n",
                             solved, map.transmitters(), solve_s,
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
      ->transform(index_in({"ground", "roofs"}))
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
  command
      .add_option("--precoder", options.precoder,
                  "of the transmitters: mean (over their ports), beam, best_beam, maximum_ratio")
      ->capture_default_str();
  command.add_option("--beam", options.beam, "index of the DFT beam of --precoder beam")
      ->check(integer_of(0, int64_t{1} << 40));
  command
      .add_option("--oversampling", options.oversampling,
                  "DFT beams per element, along the rows and along the columns [1 1]")
      ->expected(2)
      ->check(integer_of(1, 32));
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
