// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <chrono>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/console/progress.h"
#include "apps/console/session.h"
#include "apps/console/watch.h"
#include "apps/paths/cfr.h"
#include "apps/paths/glb.h"
#include "apps/paths/output.h"
#include "core/text.h"
#include "draw/paths/draw.h"
#include "draw/paths/render.h"
#include "io/formats/png.h"
#include "sim/experiment/experiment.h"
#include "sim/plan/plan_options.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/parse/receiver_list.h"

namespace greatx::apps {

namespace {

using Json = nlohmann::ordered_json;

struct PathsOptions {
  ScenarioOptions scenario;
  RunOptions run;
  sim::ChannelSnapshot::Instant instant;
  std::string channel, transmitter, receiver, receivers;
  bool json = false, json_lines = false, brief = false, quiet = false;
  std::string csv, png, glb, cfr;
  std::string view = "auto";
  uint32_t width = 1600, height = 1000;
  PathColors colors = PathColors::gain;
  bool with_scene = false;
  std::optional<double> within_db;
};

/// Pixel rows of a picture above and below the view of the scene.
constexpr uint32_t picture_bars = picture_head + picture_foot;

/// Holds the request: the channel, the moment, the receivers and the view.
struct PathsRequest {
  uint32_t channel = 0;
  sim::ChannelSnapshot::Instant instant;
  std::vector<dvec3> points;         ///< positions of --receivers; empty: the channel's receivers
  std::optional<uint32_t> only;      ///< index of the receiver of --receiver; none: all
  std::optional<CameraName> camera;  ///< camera of --view; none: automatic
};

/// Returns the index of a transmitter or receiver that `text` gives by its number or by its name. `names` is
/// empty if they have none. Throws UserError, which names `option`.
uint32_t find_end(const char* option, const std::string& text, size_t count,
                  std::span<const std::string> names) {
  uint32_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error == std::errc{} && end == text.data() + text.size() && index < count) return index;
  for (uint32_t i = 0; i < names.size(); ++i)
    if (names[i] == text) return i;
  throw_user_error("{}: expected 0 to {}{}, found '{}'{}", option, count - 1,
                   names.empty() ? "" : fmt::format(", or one of {}", fmt::join(names, ", ")), text,
                   suggestion(text, {names.begin(), names.end()}));
}

PathsRequest paths_request(const PathsOptions& options, const sim::Scenario& scenario) {
  PathsRequest request;
  request.channel = find_channel(options.channel, scenario);
  if (!options.receivers.empty())
    request.points = sim::load_receiver_list(options.receivers, sim::EarthPositions(scenario.scene));
  const sim::ChannelConfig& channel = scenario.channels[request.channel];
  if (!options.receiver.empty())
    request.only = request.points.empty()
                       ? find_end("--receiver", options.receiver, channel.receivers.size(), channel.receivers)
                       : find_end("--receiver", options.receiver, request.points.size(), {});
  request.instant = options.instant;
  request.instant.transmitter =
      options.transmitter.empty()
          ? 0
          : find_end("--transmitter", options.transmitter, channel.transmitters.size(), channel.transmitters);
  check_instant(options.instant.sequence, options.instant.tick, scenario);
  if (options.view != "auto")
    request.camera = find_camera(options.view, scenario);
  else if (options.height < picture_bars + 100)
    throw_user_error("--height: expected {} or more, found {}", picture_bars + 100, options.height);
  if (options.with_scene && options.glb.empty())
    throw_user_error("--with-scene: expected --glb FILE with it, found none");
  if (!options.cfr.empty() && request.only)
    throw_user_error("--cfr: expected all receivers, found --receiver {}", options.receiver);
  if (options.within_db && options.glb.empty() && options.png.empty())
    throw_user_error("--within: expected --png or --glb with it, found none");
  return request;
}

constexpr const char* gain_note =
    "(lambda / 4 pi)^2 ||T||^2 / 2: isotropic antennas of unit gain, both polarizations received, mean over "
    "the "
    "polarization sent; of a link: the sum over its paths";
constexpr const char* phase_note =
    "arg of (lambda / 4 pi) T_theta_theta e^{-j 2 pi f tau}: vertical to vertical, at the carrier";

Json head_of(const PathsOptions& options, const PathsRequest& request, const sim::Experiment& experiment,
             const sim::Moment& moment) {
  const auto& [scenario, world, plan] = experiment;
  const sim::ChannelConfig& channel = scenario.channels[request.channel];
  Json head{{"greatx", GREATX_VERSION},
            {"scenario", scenario.name},
            {"scene_sha256", world->scene.hash},
            {"seed", scenario.seed},
            {"sequence", options.instant.sequence},
            {"tick", moment.context.tick},
            {"time_s", moment.context.time_s},
            {"channel", channel.name},
            {"transmitter", channel.transmitters[*request.instant.transmitter]},
            {"carrier_hz", channel.carrier_hz},
            {"max_depth", channel.limits.max_depth},
            {"gain", gain_note},
            {"phase", phase_note},
            {"effects", Json::object()}};
  for (const sim::Effect* effect : plan.all())
    head["effects"][effect->name] = {
        {"on", effect->on}, {"reason", effect->reason}, {"bound", effect->bound}};
  return head;
}

Json tail_of(const PathTotals& totals, const sim::ChannelSnapshot& snapshot) {
  Json tail{{"totals", totals.json()}, {"counters", Json::object()}};
  std::map<std::string, uint64_t> counters;
  snapshot.count(counters);
  for (const auto& [name, count] : counters) tail["counters"][name] = count;
  for (const auto& [name, text] : snapshot.notes()) tail[name] = text;
  return tail;
}

/// Returns the closing lines of the tables.
std::string closing_text(const PathTotals& totals, const Json& head, const Json& tail, double seconds) {
  std::string text = fmt::format("{} in {:.2f} s\n", totals.text(), seconds);
  for (const auto& [name, value] : tail.items())
    if (value.is_string()) text += fmt::format("{}: {}\n", name, value.get<std::string>());
  std::vector<std::string> counts, effects;
  for (const auto& [name, value] : tail["counters"].items())
    counts.push_back(fmt::format("{} {}", name, value.get<uint64_t>()));
  text += fmt::format("counted: {}\n", fmt::join(counts, ", "));
  for (const auto& [name, effect] : head["effects"].items())
    if (effect["on"].get<bool>()) effects.push_back(name);
  text +=
      fmt::format("effects on: {}\ngain: {}\nphase: {}\n", fmt::join(effects, ", "), gain_note, phase_note);
  return text;
}

void write_picture(const PathsOptions& options, const PathsRequest& request, const sim::EffectPlan& plan,
                   const Json& head, std::span<const PathLink> links, const PathScene& scene,
                   sim::ChannelSnapshot& snapshot) {
  const sim::Experiment& experiment = snapshot.experiment();
  PictureRenderer renderer(snapshot.gpu_scene(), snapshot.ring(), plan, experiment.scenario.environment,
                           snapshot.moment());
  ScenarioView chosen;
  if (request.camera)
    chosen = scenario_view(*request.camera, experiment, snapshot.moment(), options.width);
  else
    chosen.view = choose_view(links, scene, options.width, options.height - picture_bars,
                              [&](const PictureView& view) { return renderer.depth(view); });
  const render::CameraImages images = renderer.picture(chosen.view, chosen.excluded_body);
  std::string title =
      fmt::format("{}, {}", head["scenario"].get<std::string>(), head["channel"].get<std::string>());
  if (options.within_db) title += fmt::format(": paths within {:g} dB", *options.within_db);
  const PictureText text{title,
                         fmt::format("tick {}, {:.3f} s, {:.4g} GHz", head["tick"].get<int64_t>(),
                                     head["time_s"].get<double>(), 1e-9 * head["carrier_hz"].get<double>()),
                         head["transmitter"].get<std::string>()};
  const io::Bytes png =
      io::encode_png(draw_paths(chosen.view, images.rgb, images.depth, links, scene, options.colors, text));
  const std::filesystem::path file = options.png;
  io::create_folder_of(file);
  io::write_file_atomically(file, png);
}

void write_glb(const PathsOptions& options, const Json& head, std::span<const PathLink> links,
               const PathScene& scene, const sim::ChannelSnapshot& snapshot) {
  PathGlbOptions glb;
  glb.colors = options.colors;
  glb.name = fmt::format("{} {}", head["scenario"].get<std::string>(), head["channel"].get<std::string>());
  glb.tick = snapshot.moment().context.tick;
  glb.time_s = snapshot.moment().context.time_s;
  if (options.with_scene) glb.bodies = snapshot.moment().bodies;
  const std::filesystem::path file = options.glb;
  io::create_folder_of(file);
  io::write_file_atomically(file, paths_glb(links, scene, glb));
}

/// Solves the request and passes every receiver to the outputs. Returns the links if pictures or exports need
/// them, else none.
std::vector<PathLink> solve(const PathsOptions& options, const PathsRequest& request, const PathScene& scene,
                            sim::ChannelSnapshot& snapshot,
                            std::span<const std::unique_ptr<PathsOutput>> outputs, CfrFile* cfr,
                            PathTotals& totals) {
  const bool keep = !options.png.empty() || !options.glb.empty();
  const double carrier_hz = scene.carrier_hz;
  std::vector<PathLink> kept;
  Progress progress("paths", static_cast<int64_t>(request.points.size()),
                    options.quiet || request.points.size() < 2, "receivers");
  if (!request.points.empty() && !request.only) progress.update(0);
  const auto take = [&](sim::ChannelSnapshot::Link solved) {
    if (request.only && solved.receiver != *request.only) return true;
    if (cfr) cfr->add(solved);
    PathLink link = path_link(std::move(solved), scene.scene->origin);
    totals.add(figures_of(link, carrier_hz));
    for (const auto& output : outputs) output->add(link);
    if (keep) kept.push_back(std::move(link));
    progress.update(static_cast<int64_t>(totals.receivers));
    return !interrupted();
  };
  if (request.points.empty())
    snapshot.solve(take);
  else if (request.only)
    snapshot.solve(std::span(request.points).subspan(*request.only, 1), *request.only, take);
  else
    snapshot.solve(request.points, 0, take);
  if (interrupted())
    throw Interrupted(fmt::format("paths: ended after {} receivers; what was printed is whole, files are not",
                                  totals.receivers));
  return kept;
}

void run_paths(const PathsOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  sim::Scenario scenario = load_scenario(options.scenario);
  const PathsRequest request = paths_request(options, scenario);
  auto world = std::make_shared<const sim::World>(sim::load_world(scenario));
  scene::Bounds points;
  for (const dvec3& point : request.points) points.add(point);
  const sim::Experiment experiment = sim::make_experiment(std::move(scenario), std::move(world), points);
  // Only a picture needs the effects of cameras.
  const sim::EffectPlan view_plan = options.png.empty() ? experiment.plan : picture_plan(experiment);
  gpu::Device device(options.run.device_options());
  sim::ChannelSnapshot snapshot(device, experiment, request.channel, request.instant,
                                sim::gpu_scene_options(view_plan));
  const PathScene scene{&experiment.scene(), snapshot.model().wedges,
                        experiment.scenario.channels[request.channel].carrier_hz};

  std::vector<std::unique_ptr<PathsOutput>> outputs;
  if (options.json)
    outputs.push_back(json_output(std::cout, scene));
  else if (options.json_lines)
    outputs.push_back(json_lines_output(std::cout, scene));
  else if (!options.quiet)
    outputs.push_back(table_output(std::cout, scene, options.brief));
  if (!options.csv.empty()) outputs.push_back(csv_output(options.csv, scene));

  install_interrupt_handler();
  const TerminalWatch watch(options.quiet);
  const Json head = head_of(options, request, experiment, snapshot.moment());
  for (const auto& output : outputs) output->begin(head);
  std::optional<CfrFile> cfr;
  if (!options.cfr.empty())
    cfr.emplace(options.cfr, snapshot, *request.instant.transmitter,
                request.points.empty() ? std::nullopt : std::optional(request.points.size()));
  PathTotals totals;
  std::vector<PathLink> links =
      solve(options, request, scene, snapshot, outputs, cfr ? &*cfr : nullptr, totals);
  if (cfr) cfr->finish();
  const Json tail = tail_of(totals, snapshot);
  for (const auto& output : outputs) output->end(tail);

  if (options.within_db) links = strong_paths(links, scene.carrier_hz, *options.within_db);
  if (!options.png.empty()) write_picture(options, request, view_plan, head, links, scene, snapshot);
  if (!options.glb.empty()) write_glb(options, head, links, scene, snapshot);
  device.wait_idle();
  check_validation(device);
  if (options.json || options.json_lines || options.quiet) return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::cout << closing_text(totals, head, tail, seconds);
  for (const std::string* file : {&options.csv, &options.cfr, &options.png, &options.glb})
    if (!file->empty()) std::cout << "wrote " << *file << '\n';
}

void add_selection(CLI::App& command, PathsOptions& options) {
  command.add_option("--tick", options.instant.tick, "at which tick")
      ->capture_default_str()
      ->check(integer_of(0, sim::most_ticks));
  command.add_option("--sequence", options.instant.sequence, "in which sequence")
      ->capture_default_str()
      ->check(integer_of(0, sim::most_sequences));
  command.add_option("--channel", options.channel, "name of the channel [the first]");
  command.add_option("--transmitter", options.transmitter,
                     "which of the channel's: its number, from 0, or its name node/sensor [0]");
  command.add_option(
      "--receivers", options.receivers,
      "CSV of positions x, y, z (world, m) in place of the channel's receivers: at rest, isotropic");
  command.add_option("--receiver", options.receiver,
                     "this one alone: its number, from 0, or its name node/sensor [all]");
}

void add_pictures(CLI::App& command, PathsOptions& options) {
  command.add_option("--png", options.png, "draw the paths over a view of the scene");
  command
      .add_option("--view", options.view,
                  "auto: obliquely from above, from where most of the paths are in sight; or node/sensor: "
                  "a camera or an event camera of the scenario")
      ->capture_default_str();
  command.add_option("--width", options.width, "of the picture, pixels")
      ->capture_default_str()
      ->check(integer_of(320, 16384));
  command
      .add_option("--height", options.height, "of the picture, pixels; a scenario's camera has its own shape")
      ->capture_default_str()
      ->check(integer_of(1, 16384));
  command.add_option("--color", options.colors, "of lines: by gain, or by kind of path")
      ->transform(index_in({"gain", "kind"}))
      ->default_str("gain");
  command
      .add_option("--within", options.within_db,
                  "draw and export no path that is more than this weaker than the strongest, dB [all]")
      ->check(number_of(0.0));
  command.add_option("--glb", options.glb, "write the paths as a glTF binary");
  command.add_flag("--with-scene", options.with_scene, "the scene's triangles too, in plain colours (--glb)");
}

}  // namespace

void add_paths(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("paths", "find, list and draw all paths of a channel at one tick (docs/paths.md)");
  auto options = std::make_shared<PathsOptions>();
  options->scenario.add_to(*command);
  options->run.add_to(*command);
  add_selection(*command, *options);
  CLI::Option* json = command->add_flag("--json", options->json, "print one JSON object with everything");
  CLI::Option* lines = command->add_flag("--json-lines", options->json_lines,
                                         "print JSON objects, one a line: head, each receiver, totals");
  command->add_flag("--brief", options->brief, "print one line a receiver")->excludes(json)->excludes(lines);
  lines->excludes(json);
  command->add_option(
      "--csv-out", options->csv,
      "write a CSV with one line a receiver: number of paths, line of sight, gain, delay spread");
  command->add_option(
      "--cfr", options->cfr,
      "write frequency responses as .npy, complex64 [receivers, rx_ant, 1, tx_ant, time, subcarrier]");
  add_pictures(*command, *options);
  command->add_flag("-q,--quiet", options->quiet, "print nothing but errors, and JSON if asked for");
  command->callback([options] { run_paths(*options); });
}

}  // namespace greatx::apps
