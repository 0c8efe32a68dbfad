// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/bench.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "apps/bench/camera_bench.h"
#include "apps/bench/lidar_bench.h"
#include "apps/bench/measure.h"
#include "apps/bench/radar_bench.h"
#include "apps/bench/radio_bench.h"
#include "apps/bench/recall.h"
#include "apps/bench/reference_bench.h"
#include "apps/bench/rig_bench.h"
#include "apps/bench/sight_bench.h"
#include "apps/bench/suite.h"
#include "apps/bench/suite_compare.h"
#include "apps/bench/view_bench.h"
#include "apps/console/command_line.h"
#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "apps/console/session.h"
#include "apps/console/summary.h"
#include "apps/console/watch.h"
#include "io/dataset/dataset_writer.h"
#include "sim/dataset/dataset_info.h"
#include "sim/run/simulator.h"
#include "sim/scenario/parse/load_scenario.h"

namespace greatx::apps {

namespace {

struct Options {
  ScenarioOptions scenario;
  RunOptions run;
  int64_t warm_up = 5;
  bool discard = false, json = false;
  bool recall = false;
  RecallOptions recall_options;
  bool camera = false;
  CameraBenchOptions camera_options;
  ReferenceBenchOptions reference_options;
  bool lidar = false;
  LidarBenchOptions lidar_options;
  bool radar = false;
  RadarBenchOptions radar_options;
  bool radio = false;
  RadioBenchOptions radio_options;
  bool rig = false;
  RigBenchOptions rig_options;
  bool sight = false;
  SightBenchOptions sight_options;
  bool view = false;
  ViewBenchOptions view_options;
  bool suite = false;
  SuiteOptions suite_options;
  std::vector<std::filesystem::path> compared;
};

void print(const nlohmann::json& result) {
  const auto row = [](const std::string& name, const nlohmann::json& d) {
    if (d["count"].get<size_t>() == 0) return;
    std::cout << fmt::format("  {:<28} {:9.2f} {:9.2f} {:9.2f}   x {}\n", name, d["min"].get<double>(),
                             d["median"].get<double>(), d["max"].get<double>(), d["count"].get<size_t>());
  };
  std::cout << fmt::format(
      "{} on {} ({})\nset-up {:.0f} ms, first packet after {:.0f} ms, peak memory {:.0f} MiB\n",
      result["scenario"].get<std::string>(), result["device"].get<std::string>(),
      result["driver"].get<std::string>(), result["setup_ms"].get<double>(),
      result["first_packet_ms"].get<double>(), result["peak_rss_bytes"].get<double>() / (1 << 20));
  std::cout << fmt::format("  {:<28} {:>9} {:>9} {:>9}   (ms)\n", "", "min", "median", "max");
  row(result["written"].get<bool>() ? "full tick, written" : "full tick, discarded", result["tick_ms"]);
  for (const auto& [name, pass] : result["pass_ms"].items()) row("  gpu " + name, pass);
  for (const auto& [name, pass] : result["host_ms"].items()) row("  host " + name, pass);
}

void run(const Options& options) {
  const Clock::time_point begin = Clock::now();
  const sim::Experiment experiment = sim::make_experiment(load_scenario(options.scenario));
  const sim::Scenario& scenario = experiment.scenario;
  gpu::Device device(options.run.device_options());
  sim::Simulator simulator(device, experiment);
  ScratchFolder scratch;
  Discard discard;
  std::unique_ptr<io::DatasetWriter> writer;
  if (!options.discard) {
    writer = std::make_unique<io::DatasetWriter>(scratch.path(),
                                                 sim::dataset_info(experiment, device, simulator.sensors()));
    writer->begin_sequence(0);
  }
  RecordSink& sink = writer ? static_cast<RecordSink&>(*writer) : discard;
  simulator.keep_pass_samples(true);
  install_interrupt_handler();
  const TerminalWatch watch(options.json);
  simulator.start(0);
  const double setup_ms = milliseconds_since(begin);

  Progress progress("bench", scenario.ticks, options.json);
  std::vector<double> ticks;
  double first_packet_ms = 0.0;
  size_t passes_to_drop = 0;
  bool stopped = false;
  for (int64_t i = 0;; ++i) {
    const Clock::time_point tick_begin = Clock::now();
    const bool more = simulator.step(sink);
    if (i == 1) first_packet_ms = milliseconds_since(begin);
    stopped = more && interrupted();
    if (!more || stopped) break;
    if (i >= options.warm_up) ticks.push_back(milliseconds_since(tick_begin));
    passes_to_drop = static_cast<size_t>(options.warm_up);
    progress.update(std::min(simulator.next_tick(), scenario.ticks));
  }
  const Clock::time_point drain_begin = Clock::now();
  if (writer) writer->end_sequence();
  const double drain_ms = milliseconds_since(drain_begin);
  check_validation(device);

  const sim::RunStatistics statistics = simulator.statistics();
  nlohmann::json result = summary_of(statistics, device, milliseconds_since(begin) / 1000.0);
  result["scenario"] = scenario.name;
  result["written"] = !options.discard;
  result["warm_up"] = options.warm_up;
  result["setup_ms"] = setup_ms;
  result["first_packet_ms"] = first_packet_ms;
  result["drain_ms"] = drain_ms;
  result["tick_ms"] = distribution(ticks);
  const auto rows = [&](const std::map<std::string, sim::PassTotal>& passes) {
    nlohmann::json json = nlohmann::json::object();
    for (const auto& [name, pass] : passes) {
      std::vector<double> samples = pass.samples;
      samples.erase(samples.begin(),
                    samples.begin() + static_cast<std::ptrdiff_t>(std::min(samples.size(), passes_to_drop)));
      if (!samples.empty()) json[name] = distribution(std::move(samples));
    }
    return json;
  };
  result["pass_ms"] = rows(statistics.passes);
  result["host_ms"] = rows(statistics.host);
  result["finished"] = !stopped;
  if (options.json)
    std::cout << json_text(result) << '\n';
  else
    print(result);
  if (stopped)
    throw Interrupted(
        fmt::format("bench: the figures are those of {} of {} ticks", statistics.ticks, scenario.ticks));
}

/// Runs one of the benchmarks that have rows of their own, and prints its result.
template <typename BenchOptions>
void run_rows(const Options& options, BenchOptions bench_options,
              nlohmann::json (*bench)(const ScenarioOptions&, const RunOptions&, const BenchOptions&),
              std::string (*text)(const nlohmann::json&)) {
  bench_options.warm_up = options.warm_up;
  // The watch shows the progress of searches. No interrupt handler is installed, so Ctrl-C ends the program
  // at once.
  const TerminalWatch watch(options.json);
  const nlohmann::json result = bench(options.scenario, options.run, bench_options);
  std::cout << (options.json ? json_text(result) + "\n" : text(result));
}

void add_sight_options(CLI::App& command, Options& options) {
  command.add_flag(
      "--line-of-sight", options.sight,
      "time the first channel with no other effect than the line of sight instead: the tick, many "
      "receivers in one call");
  SightBenchOptions& sight = options.sight_options;
  command
      .add_option("--against", sight.against,
                  "of --line-of-sight: another program greatx, built with GREATX_EFFECTS=line_of_sight, that "
                  "runs in turns with this one [none]")
      ->check(CLI::ExistingFile);
  command.add_option("--pairs", sight.pairs, "of --line-of-sight --against: runs of each program")
      ->capture_default_str()
      ->check(integer_of(1, 1000));
  command.add_option("--calls", sight.repeats, "of --line-of-sight: measured calls for all receivers")
      ->capture_default_str()
      ->check(integer_of(1, 1'000'000));
}

void add_view_options(CLI::App& command, Options& options) {
  command.add_flag("--view", options.view,
                   "measure the viewer instead: orbit, drag to picture, slow-down of a live run, start, "
                   "scrubbing a data set");
  ViewBenchOptions& view = options.view_options;
  command.add_option("--orbit-seconds", view.seconds, "of --view: how long the view orbits")
      ->capture_default_str()
      ->check(number_of(0.1, 1e4));
  command.add_option("--size", view.size, "of --view: of the window, pixels")->capture_default_str();
  command.add_option("--drags", view.drags, "of --view: measured from rest")
      ->capture_default_str()
      ->check(integer_of(1, 1'000'000));
  command.add_option("--turns", view.rounds, "of --view: of a live run with and without the window")
      ->capture_default_str()
      ->check(integer_of(1, 1000));
}

void add_suite_options(CLI::App& command, Options& options) {
  command.add_flag("--suite", options.suite,
                   "measure all passes in generated scenes of growing size instead, with every tracer of the "
                   "device: files of figures, tables and curves in DIR");
  SuiteOptions& suite = options.suite_options;
  command
      .add_option("-o,--output", suite.folder,
                  "of --suite, and of --camera --reference: the folder of the files")
      ->option_text("DIR");
  command.add_flag("--quick", suite.quick, "of --suite: up to 100 k triangles instead of 10 M");
  command.add_option("--most-triangles", suite.most_triangles, "of --suite: leaves out larger scenes")
      ->capture_default_str()
      ->check(integer_of(1000, 10'000'000));
  command.add_option("--repeats", suite.repeats, "of --suite: measured runs of each row")
      ->capture_default_str()
      ->check(integer_of(1, 1000));
  command
      .add_option("--compare", options.compared,
                  "compare two files suite.json instead: ratios, and which differ by more than their spread")
      ->expected(2)
      ->option_text("A.json B.json");
}

void run_suite(const Options& options) {
  if (options.suite_options.folder.empty())
    throw_user_error("bench --suite: expected -o DIR, the folder of its files");
  const nlohmann::json result = run_suite(options.run, options.suite_options, options.json);
  std::cout << (options.json ? json_text(result) + "\n" : suite_text(result));
}

void compare(const Options& options) {
  const nlohmann::json result = compare_suites(options.compared[0], options.compared[1]);
  std::cout << (options.json ? json_text(result) + "\n" : compare_text(result));
}

}  // namespace

void add_bench(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("bench", "time a scenario: every pass and the full tick, end to end");
  auto options = std::make_shared<Options>();
  options->scenario.add_to(*command);
  options->run.add_to(*command);
  command->add_option("--warm-up", options->warm_up, "ticks that are run and not counted")
      ->capture_default_str()
      ->check(integer_of(0, sim::most_ticks));
  command->add_flag("--discard", options->discard, "simulate only: encode and write nothing");
  command->add_flag("--json", options->json, "print one JSON object");
  command->add_flag(
      "--recall", options->recall,
      "hold the specular paths against an exhaustive reference instead; without SCENARIO: in a room, a "
      "street canyon and the city");
  RecallOptions& recall = options->recall_options;
  command->add_option("--count", recall.receivers, "of --recall: receivers drawn from the seed")
      ->capture_default_str()
      ->check(integer_of(1, 1'000'000));
  command->add_option("--receivers", recall.receiver_file, "of --recall: CSV of positions x, y, z instead")
      ->check(CLI::ExistingFile);
  command
      ->add_option("--depth", recall.paths.max_depth, "of --recall: reflections and walls passed on a path")
      ->capture_default_str()
      ->check(integer_of(0, 6));
  command->add_option("--walls", recall.paths.max_transmissions, "of --recall: of them walls passed")
      ->capture_default_str()
      ->check(integer_of(0, 6));
  command
      ->add_flag(
          "--edges{1}", recall.paths.edges,
          "of --recall: paths over one edge as well, with reflections on both sides of it; --edges=2: over "
          "two, of any strength")
      ->check(integer_of(0, 2));
  command
      ->add_flag(
          "--scattering{1}", recall.paths.scattering,
          "of --recall: hold the scattered paths of several budgets against those of all patches; "
          "--scattering=2: those of two patches, and with --edges of an edge and a patch, against many draws")
      ->check(integer_of(0, 2));
  command->add_option("--budgets", recall.budgets, "of --recall --scattering: values of scattering_budget")
      ->delimiter(',')
      ->capture_default_str()
      ->check(integer_of(1, 1 << 30));
  command->add_option("--max-rays", recall.max_rays_log2, "of --recall: rays from 2^14 to 2^this; 0: none")
      ->capture_default_str()
      ->check(integer_of(0, 24));
  command->add_flag(
      "--camera", options->camera,
      "time the first camera alone instead, row by row: antialiasing, each effect, night, lamps");
  command->add_option("--pictures", options->camera_options.pictures, "of --camera: measured of each row")
      ->capture_default_str()
      ->check(integer_of(1, 1'000'000));
  ReferenceBenchOptions& reference = options->reference_options;
  command
      ->add_option("--reference", reference.samples,
                   "of --camera: compare the picture, and the picture without each approximation, with a "
                   "path-traced reference of so many paths a pixel instead")
      ->check(integer_of(1, 1'000'000));
  command->add_option("--bounces", reference.bounces, "of --reference: reflections after the first")
      ->capture_default_str()
      ->check(integer_of(0, 10'000));
  command
      ->add_option(
          "--later-roughness", reference.later_roughness,
          "of --reference: least roughness of surfaces after the first reflection, against the noise "
          "of sharp spots of light; 0: unbiased")
      ->capture_default_str()
      ->check(number_of(0.0, 1.0));
  command->add_option("--tick", reference.tick, "of --reference: of the first sequence")
      ->capture_default_str()
      ->check(integer_of(0, sim::most_ticks));
  command->add_flag(
      "--lidar", options->lidar,
      "time the first LiDAR alone instead, row by row: single rays, each effect, rings, returns");
  command->add_option("--sweeps", options->lidar_options.sweeps, "of --lidar: measured of each row")
      ->capture_default_str()
      ->check(integer_of(1, 1'000'000));
  command->add_option("--channels", options->lidar_options.channels, "of --lidar: of all rows but the last")
      ->capture_default_str()
      ->check(integer_of(1, 1024));
  command
      ->add_option("--azimuth-steps", options->lidar_options.azimuth_steps,
                   "of --lidar: of all rows but the last")
      ->capture_default_str()
      ->check(integer_of(1, 4096));
  command->add_flag(
      "--radar", options->radar,
      "time the first radar alone instead, row by row: whole frames, echoes by numbers of tubes "
      "with their error");
  command->add_option("--frames", options->radar_options.frames, "of --radar: measured of each row")
      ->capture_default_str()
      ->check(integer_of(1, 1'000'000));
  command->add_flag(
      "--radio", options->radio,
      "time the first channel alone instead, stage by stage: first CIR, search, ticks without and "
      "with diffraction and scattering, many receivers in one call");
  command
      ->add_option("--many", options->radio_options.receivers,
                   "of --radio and --line-of-sight: receivers in one call")
      ->capture_default_str()
      ->check(integer_of(1, 1'000'000));
  command
      ->add_option("--map-cells", options->radio_options.map_cells,
                   "of --radio: also a radio map of so many cells of 1 m along each side, e.g. 300 [none]")
      ->check(integer_of(1, 2000));
  command
      ->add_option("--row-seconds", options->radio_options.seconds,
                   "of --radio and --line-of-sight: a row of ticks ends after so long")
      ->capture_default_str()
      ->check(number_of(1e-3, 1e6));
  command->add_flag("--rig", options->rig,
                    "time the whole tick, written, and the tick without each sensor in turns instead: what "
                    "each one costs");
  command->add_option("--rounds", options->rig_options.rounds, "of --rig: measured of each row")
      ->capture_default_str()
      ->check(integer_of(1, 1'000'000));
  command->add_option("--block", options->rig_options.block, "of --rig: ticks of a round")
      ->capture_default_str()
      ->check(integer_of(1, 1'000'000));
  command
      ->add_option("--bodies", options->rig_options.bodies,
                   "of --rig: rows with so many moving cars more instead, such as 10,100 [none]")
      ->delimiter(',')
      ->check(integer_of(1, 1000));
  add_sight_options(*command, *options);
  add_view_options(*command, *options);
  add_suite_options(*command, *options);
  const char* const modes[] = {"--recall", "--camera",        "--lidar", "--radar", "--radio",
                               "--rig",    "--line-of-sight", "--view",  "--suite", "--compare"};
  for (const char* a : modes)
    for (const char* b : modes)
      if (a != b) command->get_option(a)->excludes(command->get_option(b));
  command->callback([options, command] {
    if (options->suite) return run_suite(*options);
    if (!options->compared.empty()) return compare(*options);
    if (command->count("--reference") > 0) {
      if (!options->camera) throw_user_error("bench --reference: expected --camera beside it");
      options->reference_options.folder = options->suite_options.folder;
      return run_rows(*options, options->reference_options, reference_bench, reference_bench_text);
    }
    if (options->camera) return run_rows(*options, options->camera_options, camera_bench, camera_bench_text);
    if (options->lidar) return run_rows(*options, options->lidar_options, lidar_bench, lidar_bench_text);
    if (options->radar) return run_rows(*options, options->radar_options, radar_bench, radar_bench_text);
    if (options->radio) return run_rows(*options, options->radio_options, radio_bench, radio_bench_text);
    if (options->sight) {
      options->sight_options.receivers = options->radio_options.receivers;
      options->sight_options.seconds = options->radio_options.seconds;
      return run_rows(*options, options->sight_options, sight_bench, sight_bench_text);
    }
    if (options->rig) return run_rows(*options, options->rig_options, rig_bench, rig_bench_text);
    if (options->view) return run_rows(*options, options->view_options, view_bench, view_bench_text);
    if (!options->recall) return run(*options);
    options->recall_options.scenario = options->scenario;
    options->recall_options.run = options->run;
    options->recall_options.json = options->json;
    options->recall_options.every_scene = command->count("SCENARIO") == 0;
    run_recall(options->recall_options);
  });
}

}  // namespace greatx::apps
