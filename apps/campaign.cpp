// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/campaign/index.h"
#include "apps/campaign/jobs.h"
#include "apps/campaign/merge.h"
#include "apps/campaign/plan.h"
#include "apps/campaign/run.h"
#include "apps/campaign/slurm.h"
#include "apps/campaign/stats.h"
#include "apps/campaign/store.h"
#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/console/exit_code.h"
#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "apps/console/session.h"
#include "apps/console/watch.h"
#include "apps/files/consistency_files.h"
#include "core/parallel.h"
#include "io/dataset/verify.h"
#include "io/files/file.h"

namespace greatx::apps {
namespace {

struct Options {
  CampaignOptions campaign;
  RunOptions run;
  SlurmOptions slurm;
  bool json = false, quiet = false;
  std::string shard = "1/1";
  std::vector<std::string> from;
  uint32_t threads = 0, jobs = 1;
  int64_t measured_ticks = 4;
  uint64_t sampled = 2000;
  std::vector<uint32_t> cores{32, 320};
};

/// `has_folder`: the command reads or writes the folder of the campaign.
void add_common(CLI::App& command, const std::shared_ptr<Options>& options, bool has_folder) {
  command
      .add_option("CAMPAIGN", options->campaign.file,
                  "campaign file (.yaml), or an embedded one: " + embedded_campaign_names())
      ->required();
  CLI::Option* output =
      command.add_option("-o,--output", options->campaign.output, "folder of the campaign, such as out/mini");
  if (has_folder) output->required();
  command.add_option("--assets", options->campaign.assets,
                     "folder to look in for files that are not beside the scenarios");
  command.add_option("--cell", options->campaign.cells, "only these cells; `plan` lists them");
  command.add_flag("--json", options->json, "print one JSON object");
  command.add_flag("-q,--quiet", options->quiet, "print nothing but warnings and errors");
}

void print(const Options& options, const nlohmann::json& json, const std::string& text) {
  if (options.json)
    std::cout << json_text(json) << '\n';
  else if (!options.quiet)
    std::cout << text;
}

/// Returns what a few ticks of each cell cost.
std::vector<CellCost> measured_costs(const OpenCampaign& open, gpu::Device& device, const Options& options) {
  std::vector<CellCost> costs;
  install_interrupt_handler();
  Progress progress("measuring", static_cast<int64_t>(open.cells.size()), options.quiet || options.json,
                    "cells");
  for (const sim::CampaignCell& cell : open.cells) {
    const TerminalWatch watch(true);
    costs.push_back(measure_cell(cell.scenario, device, options.measured_ticks));
    progress.update(static_cast<int64_t>(costs.size()));
    if (interrupted()) throw Interrupted("the measure was interrupted");
  }
  check_validation(device);
  return costs;
}

void plan(const Options& options) {
  const OpenCampaign open = open_campaign(options.campaign);
  std::vector<CellCost> costs;
  if (options.measured_ticks > 0) {
    gpu::Device device(options.run.device_options());
    costs = measured_costs(open, device, options);
  }
  CampaignPlan plan = plan_of(open, costs, static_cast<uint32_t>(usable_cores()), options.cores);
  print(options, plan.json, plan.text);
  const auto beyond = [&](const char* what, const std::optional<double>& most, const char* key) {
    if (!most || costs.empty() || plan.json[key] <= *most) return;
    throw_user_error("{}: budget.{}: expected at most {:g}, found {:.3g} to go", options.campaign.file, what,
                     *most, plan.json[key].get<double>());
  };
  beyond("hours", open.campaign.most_hours, "hours");
  beyond("gigabytes", open.campaign.most_gigabytes, "gigabytes");
}

/// Runs units in `jobs` processes, which share them.
CampaignRun run_jobs(const OpenCampaign& open, std::span<const CampaignUnit> units, const Options& options) {
  // What is complete stays so, and need not be looked at again.
  std::vector<CampaignUnit> pending(units.begin(), units.end());
  const auto complete = [&] {
    std::erase_if(pending, [&](const CampaignUnit& unit) { return open.state(unit).complete; });
    return units.size() - pending.size();
  };
  CampaignRun run;
  run.skipped = complete();
  const auto begin = std::chrono::steady_clock::now();
  Progress progress(open.campaign.name, static_cast<int64_t>(units.size()), options.quiet || options.json,
                    "sequences");
  const uint32_t threads = options.threads > 0 ? options.threads : threads_of_each(options.jobs);
  const WorkQueue queue(pending, options.jobs);
  try {
    in_processes(
        options.jobs,
        [&](uint32_t) {
          gpu::Device device(options.run.device_options());
          if (!run_units(open, queue, device, threads, true).complete)
            throw Interrupted("a job was interrupted");
          check_validation(device);
        },
        [&] { progress.update(static_cast<int64_t>(complete())); });
  } catch (const Interrupted&) {
    run.complete = false;
  }
  run.done = complete() - run.skipped;
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return run;
}

void run(const Options& options) {
  const Shard shard = parse_shard(options.shard);
  const OpenCampaign open = open_campaign(options.campaign);
  claim_folder(open);
  install_interrupt_handler();
  const std::vector<CampaignUnit> all = open.units();
  const std::span<const CampaignUnit> units = units_of(all, shard);
  CampaignRun run;
  if (options.jobs > 1) {
    run = run_jobs(open, units, options);
  } else {
    gpu::Device device(options.run.device_options());
    const WorkQueue queue({units.begin(), units.end()}, 1);
    run = run_units(open, queue, device, options.threads, options.quiet || options.json);
    check_validation(device);
  }
  print(options,
        {{"output", options.campaign.output},
         {"done", run.done},
         {"complete_before", run.skipped},
         {"complete", run.complete},
         {"warnings", run.warnings},
         {"seconds", run.seconds}},
        fmt::format("{}: {} sequences made in {:.1f} s, {} were complete before\n", options.campaign.output,
                    run.done, run.seconds, run.skipped));
  if (!run.complete)
    throw Interrupted(fmt::format("{}: {} of {} sequences are complete; the same command goes on",
                                  open.folder.string(), run.done + run.skipped, units.size()));
}

/// Returns the time limits of the jobs: those that the user gives, or measured ones.
SlurmTimes slurm_times(const OpenCampaign& open, uint32_t tasks, const Options& options) {
  SlurmTimes times;
  if (!options.slurm.time.empty()) {
    times.task_s = times.merge_s = parse_slurm_time(options.slurm.time, "--time");
  } else {
    gpu::Device device(options.run.device_options());
    const std::vector<CellCost> costs = measured_costs(open, device, options);
    // A tick on processors takes longer on fewer of them.
    const auto cores = static_cast<double>(usable_cores());
    const double slower = device.info().type == "cpu" ? std::max(1.0, cores / options.slurm.cpus) : 1.0;
    times = measured_times(open, costs, tasks, slower);
  }
  if (!options.slurm.merge_time.empty())
    times.merge_s = parse_slurm_time(options.slurm.merge_time, "--merge-time");
  return times;
}

void slurm(const Options& options) {
  const OpenCampaign open = open_campaign(options.campaign);
  const uint32_t tasks = task_count(open, options.slurm);
  // Faults of the options come before the measure.
  (void)slurm_script(open, options.campaign, options.run, options.slurm, {});
  const SlurmTimes times = slurm_times(open, tasks, options);
  const std::string script = slurm_script(open, options.campaign, options.run, options.slurm, times);
  claim_folder(open);
  const std::filesystem::path file = options.slurm.script.empty()
                                         ? std::filesystem::path(options.campaign.output) / "job.sh"
                                         : std::filesystem::path(options.slurm.script);
  io::create_folder_of(file);
  io::write_file_atomically(file, script);
  print(options,
        {{"script", file.string()},
         {"tasks", tasks},
         {"sequences", open.units().size()},
         {"task_s", times.task_s},
         {"merge_s", times.merge_s}},
        fmt::format("{}: {} tasks for {} sequences, {} each; the merge has {}\nsubmit them by: bash {}\n",
                    file.string(), tasks, open.units().size(), slurm_time(times.task_s),
                    slurm_time(times.merge_s), shell_word(file.string())));
}

void status(const Options& options) {
  const OpenCampaign open = open_campaign(options.campaign);
  nlohmann::json json{{"cells", nlohmann::json::array()}};
  std::string text;
  uint64_t complete = 0, begun = 0;
  for (size_t c = 0; c < open.cells.size(); ++c) {
    uint64_t done = 0, open_units = 0;
    for (uint32_t s = 0; s < open.sequences(c); ++s) {
      const io::PartState state = open.state({c, s});
      done += state.complete, open_units += state.begun && !state.complete;
    }
    const bool merged = open.merged(c);
    json["cells"].push_back({{"cell", open.cells[c].name},
                             {"sequences", open.sequences(c)},
                             {"complete", done},
                             {"begun", open_units},
                             {"merged", merged}});
    text +=
        fmt::format("{}: {} of {} sequences{}{}\n", open.cells[c].name, done, open.sequences(c),
                    open_units > 0 ? fmt::format(", {} begun", open_units) : "", merged ? ", merged" : "");
    complete += done, begun += open_units;
  }
  const uint64_t all = open.units().size();
  json["sequences"] = all, json["complete"] = complete, json["begun"] = begun;
  text += fmt::format("{} of {} sequences are complete, {} are begun\n", complete, all, begun);
  print(options, json, text);
}

void merge(const Options& options) {
  const OpenCampaign open = open_campaign(options.campaign);
  claim_folder(open);
  gather_parts(open, {options.from.begin(), options.from.end()});
  for (const CampaignUnit& unit : open.units())
    if (!open.state(unit).complete)
      throw_user_error(
          "{}: cell '{}': expected sequence {}, complete; found it {}; `greatx campaign run` makes it",
          open.folder.string(), open.cells[unit.cell].name, unit.sequence,
          open.state(unit).begun ? "unfinished" : "missing");
  uint64_t merged = 0;
  Progress progress("merging", static_cast<int64_t>(open.cells.size()), options.quiet || options.json,
                    "cells");
  for (size_t c = 0; c < open.cells.size(); ++c) {
    merged += merge_cell(open, c);
    progress.update(static_cast<int64_t>(c) + 1);
  }
  write_splits(open);
  const uint64_t records = write_index(open, options.quiet || options.json);
  print(options, {{"output", options.campaign.output}, {"merged", merged}, {"records", records}},
        fmt::format("{}: {} of {} cells merged, {} records in index.sqlite and index.csv\n",
                    options.campaign.output, merged, open.cells.size(), records));
}

void stats(const Options& options) {
  const OpenCampaign open = open_campaign(options.campaign);
  const CampaignStats stats = campaign_stats(open, options.sampled, options.quiet || options.json);
  const std::string table = write_stats(open, stats);
  print(options, stats.json,
        table + fmt::format("{}: wrote stats.json, stats.png, card.md and croissant.json\n",
                            options.campaign.output));
}

void verify(const Options& options) {
  const OpenCampaign open = open_campaign(options.campaign);
  nlohmann::json json{{"problems", nlohmann::json::array()}};
  std::string text;
  for (size_t c = 0; c < open.cells.size(); ++c) {
    const std::filesystem::path folder = open.data(c);
    std::error_code ignored;
    std::vector<io::Problem> problems;
    if (!std::filesystem::exists(folder / io::dataset_file, ignored)) {
      problems.push_back({"", "data set of the cell", "one that is merged", "none"});
    } else {
      problems = io::verify(folder);
      if (problems.empty()) problems = verify_consistency(folder).problems;
    }
    for (const io::Problem& problem : problems) {
      json["problems"].push_back({{"cell", open.cells[c].name},
                                  {"file", problem.file},
                                  {"what", problem.what},
                                  {"expected", problem.expected},
                                  {"found", problem.found}});
      text += fmt::format("{}: {}\n", open.cells[c].name, problem.str());
    }
  }
  const size_t count = json["problems"].size();
  text += fmt::format("{}: {}\n", options.campaign.output,
                      count == 0 ? fmt::format("{} cells are complete and sound", open.cells.size())
                                 : fmt::format("{} problems", count));
  print(options, json, text);
  if (count > 0) throw Failed{exit_user};
}

}  // namespace

void add_campaign(CLI::App& app) {
  CLI::App* campaign = app.add_subcommand(
      "campaign", "make many data sets from one file: plan, run in shards, merge, index (docs/campaigns.md)");
  campaign->require_subcommand(1);
  const auto add = [&](const char* name, const char* text, void (*call)(const Options&)) {
    CLI::App* command = campaign->add_subcommand(name, text);
    auto options = std::make_shared<Options>();
    add_common(*command, options, call != plan);
    command->callback([options, call] { call(*options); });
    return std::pair(command, options);
  };
  const auto [of_plan, planned] =
      add("plan", "print the cells and what they cost, measured on a few ticks of each", plan);
  planned->run.add_to(*of_plan);
  of_plan->add_option("--measure", planned->measured_ticks, "ticks of each cell that are run; 0: none")
      ->capture_default_str()
      ->check(integer_of(0, 1000));
  of_plan->add_option("--cores", planned->cores, "also the hours on so many cores")
      ->capture_default_str()
      ->check(integer_of(1, 1'000'000));
  const auto [of_run, ran] =
      add("run", "make the sequences that are not complete; goes on where it was stopped", run);
  ran->run.add_to(*of_run);
  of_run->add_option("--shard", ran->shard, "only part I of N of the sequences: I/N")->capture_default_str();
  of_run
      ->add_option("--threads", ran->threads,
                   "threads that encode and write; 0: one per processor. Changes no byte")
      ->capture_default_str()
      ->check(integer_of(0, 1024));
  of_run
      ->add_option("--jobs", ran->jobs, "processes that share the shard; two keep two cores busier than one")
      ->capture_default_str()
      ->check(integer_of(1, 1024));
  const auto [of_slurm, submitted] =
      add("slurm", "write a script of Slurm jobs: an array that runs the campaign, and its merge", slurm);
  submitted->run.add_to(*of_slurm);
  submitted->slurm.add_to(*of_slurm);
  of_slurm
      ->add_option("--measure", submitted->measured_ticks,
                   "ticks of each cell that are run to find the time limits, unless --time gives them")
      ->capture_default_str()
      ->check(integer_of(1, 1000));
  add("status", "say which sequences are complete", status);
  const auto [of_merge, merged] =
      add("merge", "put the data set of each cell together, and write the index and the splits", merge);
  of_merge->add_option("--from", merged->from,
                       "folders of other shards, whose sequences are moved here first");
  const auto [of_stats, told] =
      add("stats", "histograms, a data card and Croissant metadata of a merged campaign", stats);
  of_stats
      ->add_option("--sample", told->sampled,
                   "records of cameras, and of LiDARs, that are looked at for classes; 0: none")
      ->capture_default_str()
      ->check(integer_of(0, 1'000'000'000));
  add("verify", "check every data set as `greatx verify` does", verify);
}

}  // namespace greatx::apps
