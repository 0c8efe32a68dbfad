// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/campaign/slurm.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/campaign/slurm_script.h"
#include "apps/console/command_line.h"

namespace greatx::apps {
namespace {

namespace fs = std::filesystem;

constexpr int64_t minute_s = 60, hour_of_s = 3600, day_s = 86400;
constexpr int64_t most_notice_s = 120;
constexpr uint32_t most_tasks = 4'000'000;  // Slurm's own limit of MaxArraySize

int64_t minutes_up(double seconds) {
  return minute_s * static_cast<int64_t>(std::ceil(seconds / static_cast<double>(minute_s)));
}

/// Returns the numbers between colons, or nothing.
std::vector<int64_t> numbers_of(std::string_view text) {
  std::vector<int64_t> numbers;
  while (true) {
    const size_t colon = std::min(text.find(':'), text.size());
    uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + colon, value);
    if (error != std::errc() || end != text.data() + colon) return {};
    numbers.push_back(value);
    if (colon == text.size()) return numbers;
    text.remove_prefix(colon + 1);
  }
}

/// Refuses what would end a line or a word of the header.
void expect_one_word(const char* option, const std::string& text) {
  const auto bad = [](char c) { return std::string_view(" \t\r\n\"'\\#").find(c) != std::string_view::npos; };
  if (std::ranges::any_of(text, bad))
    throw_user_error("{}: expected one word without quotes, found '{}'", option, text);
}

/// Returns the path of a file as the nodes find it.
std::string absolute(const std::string& path) { return fs::absolute(path).lexically_normal().string(); }

/// Returns an existing file by its absolute path, and the name of something embedded as it is.
std::string absolute_if_there(const std::string& name) {
  std::error_code ignored;
  return fs::exists(name, ignored) ? absolute(name) : name;
}

/// Returns a pattern for Slurm's names of log files. Slurm replaces %A and the like in it, but nothing if
/// there is a backslash.
std::string log_pattern(const std::string& folder, const char* name) {
  std::string pattern;
  for (const char c : folder) {
    if (c == '\\' || c == '\n')
      throw_user_error(
          "--logs: expected a folder without backslash and line feed, which Slurm does not take; found '{}'",
          folder);
    pattern += c;
    if (c == '%') pattern += c;
  }
  return fmt::format("{}/{}", pattern, name);
}

/// Returns an option of sbatch as a line of a script's header, whose quotes are sbatch's own.
std::string header_line(const std::string& option) {
  if (option.find_first_of(" \t#\"'\\") == std::string::npos) return fmt::format("#SBATCH {}\n", option);
  std::string text;
  for (const char c : option) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return fmt::format("#SBATCH \"{}\"\n", text);
}

std::string words(const std::vector<std::string>& list) {
  std::vector<std::string> quoted;
  for (const std::string& word : list) quoted.push_back(shell_word(word));
  return fmt::format("{}", fmt::join(quoted, " "));
}

/// Returns the options of sbatch that both jobs have.
std::vector<std::string> resources(const SlurmOptions& options) {
  std::vector<std::string> list{"--nodes=1", "--ntasks=1", fmt::format("--cpus-per-task={}", options.cpus),
                                "--requeue", "--open-mode=append"};
  const auto add = [&](const char* option, const char* name, const std::string& value) {
    if (value.empty()) return;
    expect_one_word(option, value);
    list.push_back(fmt::format("{}={}", name, value));
  };
  add("--memory", "--mem", options.memory);
  add("--partition", "--partition", options.partition);
  add("--account", "--account", options.account);
  return list;
}

/// Returns the lines of the script's header.
std::string header(const OpenCampaign& open, const SlurmOptions& options, const SlurmTimes& times,
                   uint32_t tasks, const std::string& logs) {
  std::vector<std::string> list{
      fmt::format("--job-name={}", open.campaign.name),
      fmt::format("--array=1-{}{}", tasks, options.at_once > 0 ? fmt::format("%{}", options.at_once) : ""),
      fmt::format("--time={}", slurm_time(times.task_s)),
      fmt::format("--signal=B:USR1@{}", std::min(most_notice_s, times.task_s / 5)),
      fmt::format("--output={}", log_pattern(logs, "%A_%a.out"))};
  for (std::string& option : resources(options)) list.push_back(std::move(option));
  if (!options.gpus.empty()) {
    expect_one_word("--gpus", options.gpus);
    list.push_back(fmt::format("--gres=gpu:{}", options.gpus));
  }
  std::string text;
  for (const std::string& option : list) text += header_line(option);
  for (const std::string& option : options.sbatch) text += header_line(option);
  return text;
}

std::string merge_options(const OpenCampaign& open, const SlurmOptions& options, const SlurmTimes& times,
                          const std::string& logs) {
  std::vector<std::string> list{fmt::format("--job-name={}-merge", open.campaign.name),
                                fmt::format("--time={}", slurm_time(times.merge_s)),
                                fmt::format("--output={}", log_pattern(logs, "merge_%j.out"))};
  for (std::string& option : resources(options)) list.push_back(std::move(option));
  list.insert(list.end(), options.sbatch.begin(), options.sbatch.end());
  return words(list);
}

/// Returns the options of `greatx campaign run` alone.
std::string run_options(const RunOptions& run, const SlurmOptions& options) {
  std::vector<std::string> list{"--jobs", std::to_string(options.jobs), "--threads",
                                std::to_string(std::max(1u, options.cpus / options.jobs))};
  if (!run.device.empty()) list.insert(list.end(), {"--device", run.device});
  if (run.tracer != gpu::Tracer::automatic)
    list.insert(list.end(), {"--tracer", std::string(gpu::name_of(run.tracer))});
  if (run.validation) list.push_back("--validation");
  return words(list);
}

std::string common_options(const CampaignOptions& campaign, const std::string& folder) {
  std::vector<std::string> list{"-o", folder};
  if (!campaign.assets.empty()) list.insert(list.end(), {"--assets", absolute(campaign.assets)});
  for (const std::string& cell : campaign.cells) list.insert(list.end(), {"--cell", cell});
  return words(list);
}

}  // namespace

void SlurmOptions::add_to(CLI::App& command) {
  const auto count = [&](const char* name, uint32_t& value, const char* text, uint64_t low, uint64_t high) {
    return command.add_option(name, value, text)->check(integer_of(low, high));
  };
  command.add_option("--script", script, "file to write [job.sh in the campaign's folder]");
  count("--tasks", tasks, "tasks of the array, each of them a shard [as many as cells]", 1, most_tasks);
  count("--at-once", at_once, "most tasks that run at the same time [no limit]", 1, most_tasks);
  count("--cpus", cpus, "processors of a task", 1, 1024)->capture_default_str();
  count("--jobs", jobs, "processes of a task, which share its processors", 1, 1024)->capture_default_str();
  count("--restarts", restarts, "how often a task goes on after its time limit or a kill", 0, 1000)
      ->capture_default_str();
  command.add_option("--time", time,
                     "time limit of a task, such as 90 (minutes) or 1-12:00:00 [measured: twice the longest "
                     "shard and 5 minutes]");
  command.add_option("--merge-time", merge_time, "time limit of the merge [from the measure; or --time]");
  command.add_option("--partition", partition, "Slurm's partition");
  command.add_option("--account", account, "Slurm's account");
  command.add_option("--memory", memory, "memory of a task, such as 8G");
  command.add_option("--gpus", gpus, "graphics cards of a task: a number, or a type and a number: a100:1");
  command.add_option("--logs", logs, "folder of the jobs' output [logs in the campaign's folder]");
  command.add_option("--greatx", program, "the program on the nodes [this one]");
  const auto lines = [&](const char* name, std::vector<std::string>& list, const char* text) {
    command.add_option(name, list, text)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);
  };
  lines("--setup", setup, "line of bash before greatx on a node, such as 'module load vulkan'");
  lines("--sbatch", sbatch, "further option of both jobs: --sbatch=--qos=long");
}

int64_t parse_slurm_time(const std::string& text, const char* option) {
  const size_t dash = text.find('-');
  const bool days = dash != std::string::npos;
  const std::vector<int64_t> before = days ? numbers_of(text.substr(0, dash)) : std::vector<int64_t>{0};
  std::vector<int64_t> clock = numbers_of(days ? text.substr(dash + 1) : text);
  int64_t seconds = -1;
  if (before.size() == 1 && !clock.empty() && clock.size() <= 3) {
    if (days)
      clock.resize(3);  // hours come first
    else if (clock.size() < 3)
      clock.insert(clock.begin(), 0), clock.resize(3);  // minutes come first
    seconds = before[0] * day_s + clock[0] * hour_of_s + clock[1] * minute_s + clock[2];
  }
  if (seconds < 2 * minute_s)
    throw_user_error(
        "{}: expected 2 minutes or more as M, M:S, H:M:S, D-H, D-H:M or D-H:M:S, for example 90 or "
        "1-12:00:00, found '{}'",
        option, text);
  return seconds;
}

std::string slurm_time(int64_t seconds) {
  return fmt::format("{}-{:02}:{:02}:{:02}", seconds / day_s, seconds / hour_of_s % 24,
                     seconds / minute_s % 60, seconds % minute_s);
}

double longest_shard_s(const OpenCampaign& open, const std::vector<CellCost>& costs, uint32_t tasks) {
  const std::vector<CampaignUnit> units = open.units();
  double longest = 0.0;
  for (uint32_t i = 1; i <= tasks; ++i) {
    double seconds = 0.0;
    const CampaignUnit* last = nullptr;
    for (const CampaignUnit& unit : units_of(units, {i, tasks})) {
      if (last == nullptr || last->cell != unit.cell) seconds += costs[unit.cell].start_s;
      seconds += static_cast<double>(open.cells[unit.cell].scenario.ticks) * costs[unit.cell].tick_s;
      last = &unit;
    }
    longest = std::max(longest, seconds);
  }
  return longest;
}

SlurmTimes measured_times(const OpenCampaign& open, const std::vector<CellCost>& costs, uint32_t tasks,
                          double slower) {
  constexpr double factor = 2.0, task_more_s = 300.0, merge_more_s = 600.0, read_bytes_s = 100e6;
  double bytes = 0.0;
  for (size_t c = 0; c < open.cells.size(); ++c)
    bytes += static_cast<double>(open.sequences(c) * open.cells[c].scenario.ticks) * costs[c].tick_bytes;
  return {minutes_up(factor * slower * longest_shard_s(open, costs, tasks) + task_more_s),
          minutes_up(factor * bytes / read_bytes_s + merge_more_s)};
}

uint32_t task_count(const OpenCampaign& open, const SlurmOptions& options) {
  const size_t units = open.units().size();
  const auto tasks = options.tasks > 0 ? options.tasks : static_cast<uint32_t>(open.cells.size());
  if (tasks > units)
    throw_user_error("--tasks: expected 1 to {}, one for each sequence of {} at most, found {}", units,
                     open.campaign.file, tasks);
  if (options.jobs > options.cpus)
    throw_user_error("--jobs: expected 1 to {}, one for each processor of a task (--cpus) at most, found {}",
                     options.cpus, options.jobs);
  return tasks;
}

std::string shell_word(const std::string& text) {
  const auto plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view("_-./:=,+@%").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::ranges::all_of(text, plain)) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + '\'';
}

std::string slurm_script(const OpenCampaign& open, const CampaignOptions& campaign, const RunOptions& run,
                         const SlurmOptions& options, const SlurmTimes& times) {
  const uint32_t tasks = task_count(open, options);
  const std::string folder = absolute(campaign.output);
  const std::string logs =
      options.logs.empty() ? (fs::path(folder) / "logs").string() : absolute(options.logs);
  const std::string program =
      options.program.empty() ? fs::read_symlink("/proc/self/exe").string() : options.program;
  for (const std::string& option : options.sbatch)
    if (!option.starts_with("-") || option.find('\n') != std::string::npos)
      throw_user_error("--sbatch: expected an option of sbatch on one line, such as --qos=long, found '{}'",
                       option);
  std::string setup;
  for (const std::string& line : options.setup) setup += fmt::format("  {}\n", line);
  return filled_slurm_script({
      {"HEADER", header(open, options, times, tasks, logs)},
      {"NAME", open.campaign.name},
      {"GREATX", shell_word(program)},
      {"CAMPAIGN", shell_word(absolute_if_there(campaign.file))},
      {"LOGS", shell_word(logs)},
      {"TASKS", std::to_string(tasks)},
      {"RESTARTS", std::to_string(options.restarts)},
      {"COMMON", common_options(campaign, folder)},
      {"RUN", run_options(run, options)},
      {"MERGE", merge_options(open, options, times, logs)},
      {"THREADS", std::to_string(std::max(1u, options.cpus / options.jobs))},
      {"SETUP", setup.empty() ? "  :\n" : setup},
  });
}

}  // namespace greatx::apps
