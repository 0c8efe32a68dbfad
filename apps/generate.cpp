// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "apps/calibration/resolve.h"
#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "apps/console/run_record.h"
#include "apps/console/session.h"
#include "apps/console/summary.h"
#include "apps/console/watch.h"
#include "apps/files/consistency_files.h"
#include "io/dataset/dataset_writer.h"
#include "sim/dataset/dataset_info.h"
#include "sim/experiment/experiment.h"
#include "sim/run/simulator.h"
#include "sim/scenario/parse/load_scenario.h"

namespace greatx::apps {

namespace {

struct GenerateOptions {
  ScenarioOptions scenario;
  RunOptions run;
  std::string output, compression;
  bool resume = false, json = false, quiet = false;
  uint32_t threads = 0;
};

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Runs the remaining ticks of the data set. Returns false if it was interrupted; the simulated ticks are
/// kept.
bool run_sequences(sim::Simulator& simulator, io::DatasetWriter& writer, const sim::Scenario& scenario,
                   bool quiet, Clock::time_point begin, double& first_packet_s) {
  const io::DatasetWriter::Position position = writer.resume_position();
  Progress progress(scenario.name, scenario.ticks * scenario.sequences, quiet);
  for (uint32_t sequence = position.sequence; sequence < scenario.sequences; ++sequence) {
    writer.begin_sequence(sequence);
    simulator.start(sequence, sequence == position.sequence ? position.next_tick : 0);
    while (simulator.step(writer)) {
      if (first_packet_s == 0.0 && simulator.statistics().packets > 0) first_packet_s = seconds_since(begin);
      progress.update(scenario.ticks * sequence + std::min(simulator.next_tick(), scenario.ticks));
      if (!interrupted()) continue;
      simulator.drain(writer);
      writer.flush();
      return false;
    }
    writer.end_sequence();
  }
  writer.finish();
  return true;
}

/// Gives an experiment settings if its scenario gives errors or a time budget instead. The choice goes into
/// `calibration`; a run that goes on keeps the one in `file`.
sim::Experiment with_settings(sim::Experiment experiment, const GenerateOptions& options, gpu::Device& device,
                              const std::filesystem::path& file, nlohmann::json& calibration) {
  if (experiment.scenario.accuracy.empty()) return experiment;
  install_interrupt_handler();
  Resolved resolved = resolve(experiment, device, options.scenario.assets,
                              options.resume ? file : std::filesystem::path(), false, options.quiet);
  if (!options.quiet && !options.json) std::cout << calibration_words(resolved.json);
  calibration = std::move(resolved.json);
  return sim::make_experiment(std::move(resolved.scenario), experiment);
}

/// A data set takes megabytes to terabytes, so that a folder is not chosen for the user.
void require_output(const GenerateOptions& options, const sim::Scenario& scenario) {
  if (!options.output.empty()) return;
  const std::string& name = options.scenario.scenario;
  throw_user_error(
      "-o: expected the folder of the data set, found none; for example: greatx generate {} -o out/{}\n"
      "The scenario has {} ticks in {} sequence{}; `greatx check {}` measures how many gigabytes and hours "
      "they take.",
      name, scenario.name, scenario.ticks, scenario.sequences, scenario.sequences == 1 ? "" : "s", name);
}

void run_generate(const GenerateOptions& options) {
  const Clock::time_point begin = Clock::now();
  ScenarioOptions chosen = options.scenario;
  if (!options.compression.empty()) chosen.set.push_back("storage.compression=" + options.compression);
  sim::Scenario scenario = load_scenario(chosen, true);
  require_output(options, scenario);
  sim::Experiment asked = sim::make_experiment(std::move(scenario));
  gpu::Device device(options.run.device_options());
  const std::filesystem::path calibration_file = std::filesystem::path(options.output) / io::calibration_file;
  nlohmann::json calibration;
  const sim::Experiment experiment =
      with_settings(std::move(asked), options, device, calibration_file, calibration);
  sim::Simulator simulator(device, experiment);
  io::DatasetWriter writer(options.output, sim::dataset_info(experiment, device, simulator.sensors()),
                           {options.threads, options.resume});
  if (writer.resume_position().finished) {
    if (options.json)
      std::cout << json_text(nlohmann::json{{"output", options.output}, {"finished", true}, {"ticks", 0}})
                << '\n';
    else if (!options.quiet)
      std::cout << options.output << ": complete already, nothing to do\n";
    return;
  }
  RunRecord record;
  record.set_device(device);
  record.set("assets_folder", assets_folder(options.scenario));
  record.set("begins_at",
             {{"sequence", writer.resume_position().sequence}, {"tick", writer.resume_position().next_tick}});
  const std::filesystem::path record_file = std::filesystem::path(options.output) / io::run_file;
  record.write_to(record_file);
  if (!calibration.is_null()) io::write_file_atomically(calibration_file, json_text(calibration));
  install_interrupt_handler();
  double first_packet_s = 0.0;
  bool complete = false;
  try {
    const TerminalWatch watch(options.quiet);
    complete = run_sequences(simulator, writer, experiment.scenario, options.quiet, begin, first_packet_s);
  } catch (const Interrupted&) {
    writer.flush();  // the interrupted tick is lost; the packets before it are complete
  } catch (const gpu::VulkanError& error) {
    if (error.result() == VK_ERROR_DEVICE_LOST)
      spdlog::error("{}: whole packets stay; the same command with --resume goes on", options.output);
    throw;
  }
  device.wait_idle();
  check_validation(device);
  const sim::RunStatistics statistics = simulator.statistics();
  if (complete)
    io::write_file_atomically(std::filesystem::path(options.output) / io::consistency_file,
                              consistency_csv(statistics.rows));

  for (const std::string& warning : statistics.warnings) spdlog::warn("{}", warning);  // even with --quiet
  record.set("ticks", statistics.ticks);
  record.end(complete, statistics.warnings);
  record.write_to(record_file);
  nlohmann::json summary = summary_of(statistics, device, seconds_since(begin));
  summary["first_packet_seconds"] = first_packet_s;
  summary["output"] = options.output;
  summary["finished"] = complete;
  // An unfinished data set has no manifest yet, so the files in its folder are counted.
  const io::FolderSize size =
      complete ? io::FolderSize{writer.stats().files, writer.stats().bytes} : io::folder_size(options.output);
  summary["files"] = size.files;
  summary["bytes"] = size.bytes;
  if (options.json)
    std::cout << json_text(summary) << '\n';
  else if (!options.quiet)
    std::cout << summary_text(summary)
              << fmt::format("{} {}\n", complete ? "wrote" : "interrupted:", options.output);
  if (!complete) {
    const io::DatasetWriter::Position next = writer.resume_position();
    throw Interrupted(fmt::format(
        "{}: complete up to tick {} of {} in sequence {} of {}; the same command with --resume goes on",
        options.output, next.next_tick, experiment.scenario.ticks, next.sequence + 1,
        experiment.scenario.sequences));
  }
}

}  // namespace

void add_generate(CLI::App& app) {
  CLI::App* command = app.add_subcommand("generate", "run a scenario and write its data set");
  auto options = std::make_shared<GenerateOptions>();
  options->scenario.add_to(*command);
  options->run.add_to(*command);
  command->add_option("-o,--output", options->output, "folder of the data set, such as out/city (required)");
  command
      ->add_option("--compression", options->compression,
                   "how large arrays are stored: none (NumPy files), fast or small (HDF5 files; "
                   "docs/dataset.md) [the scenario's storage.compression, else none]")
      ->check(one_of({"none", "fast", "small"}));
  command->add_flag("--resume", options->resume,
                    "go on with an unfinished data set; the finished one has the same bytes");
  command
      ->add_option("--threads", options->threads,
                   "threads that encode and write; 0: one per processor. Changes no byte")
      ->capture_default_str()
      ->check(integer_of(0, 1024));
  command->add_flag("--json", options->json, "print one JSON object with the run's summary");
  command->add_flag("-q,--quiet", options->quiet, "print nothing but warnings and errors");
  command->callback([options] { run_generate(*options); });
}

}  // namespace greatx::apps
