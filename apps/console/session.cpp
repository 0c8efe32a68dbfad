// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/console/session.h"

#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "apps/console/command_line.h"
#include "apps/console/run_record.h"
#include "assets/assets.h"
#include "core/expected.h"
#include "core/fields/named_path.h"
#include "core/text.h"
#include "io/dataset/dataset_format.h"
#include "scene/files/known_format.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/parse/override.h"

namespace greatx::apps {

void ScenarioOptions::add_to(CLI::App& command) {
  std::vector<std::string_view> names;
  for (const EmbeddedScenario& embedded : embedded_scenarios()) names.push_back(embedded.name);
  command
      .add_option("SCENARIO", scenario,
                  fmt::format("scenario file (.yaml), or an embedded one: {}", fmt::join(names, ", ")))
      ->capture_default_str();
  command.add_option("--assets", assets, "folder to look in for files that are not beside the scenario");
  command
      .add_option(
          "--set", set,
          "PATH=VALUE: instead of the scenario's own value at a place such as nodes[uav].model; no value "
          "takes the place away")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  command.add_option("--seed", seed, "instead of the scenario's seed");
  command.add_option("--ticks", ticks, "instead of the scenario's length")
      ->check(integer_of(1, sim::most_ticks));
  command.add_option("--sequences", sequences, "instead of the scenario's number of sequences")
      ->check(integer_of(1, sim::most_sequences));
}

namespace {

/// Applies --set to the scenario's text and reads it again.
sim::Scenario with_values(const sim::Scenario& scenario, const ScenarioOptions& options,
                          const std::string& name, const std::filesystem::path& folder) {
  std::string text = scenario.text;
  for (const std::string& change : options.set) {
    const size_t equals = change.find('=');
    if (equals == std::string::npos || equals == 0)
      throw_user_error("--set: expected PATH=VALUE, found '{}'", change);
    text = set_yaml_value(text, change.substr(0, equals), change.substr(equals + 1), "--set");
  }
  sim::Scenario changed = sim::parse_scenario(text, name + " with --set", folder, options.assets);
  changed.file = scenario.file;
  return changed;
}

}  // namespace

void RunOptions::add_to(CLI::App& command) {
  command.add_option(
      "--device", device,
      "index or part of the name of a Vulkan device (greatx info) [$GREATX_DEVICE, else the best]");
  command
      .add_option_function<std::string>(
          "--tracer", [this](const std::string& name) { tracer = *gpu::tracer_of(name); },
          "how rays meet triangles: auto, driver (its ray queries) or tree (trees of greatx's own) "
          "[$GREATX_TRACER, else auto: tree on a CPU or without ray queries]")
      ->check(one_of({"auto", "driver", "tree"}));
  command.add_flag("--validation", validation,
                   "run under the Vulkan validation layer; a message is an error");
}

sim::Scenario load_scenario(const ScenarioOptions& options, bool chooses) {
  sim::Scenario scenario;
  const auto embedded = std::find_if(embedded_scenarios().begin(), embedded_scenarios().end(),
                                     [&](const EmbeddedScenario& s) { return s.name == options.scenario; });
  if (embedded != embedded_scenarios().end()) {
    const std::string name = std::string(embedded->name) + ".yaml";
    scenario = sim::parse_scenario(std::string(embedded->text), name, ".", options.assets);
    if (!options.set.empty()) scenario = with_values(scenario, options, name, ".");
  } else {
    const std::filesystem::path file = options.scenario;
    std::error_code unreadable;  // for example of a symbolic link to itself
    if (!std::filesystem::is_regular_file(file, unreadable)) {
      if (std::filesystem::is_directory(file, unreadable))
        throw_user_error(
            "{}: expected a scenario (.yaml), found a folder{}", options.scenario,
            std::filesystem::exists(file / io::scenario_file, unreadable)
                ? fmt::format("; {} is the scenario of this data set", (file / io::scenario_file).string())
                : "");
      for (const EmbeddedScenario& campaign : embedded_campaigns())
        if (options.scenario == campaign.name)
          throw_user_error(
              "{0}: expected a scenario, found a campaign; `greatx campaign run {0} -o DIR` runs it",
              options.scenario);
      std::vector<std::string> names;
      for (const EmbeddedScenario& s : embedded_scenarios()) names.emplace_back(s.name);
      throw_user_error("{}: no such scenario: expected a YAML file or one of {}{}", options.scenario,
                       fmt::join(names, ", "), suggestion(options.scenario, names));
    }
    const auto format = scene::recognised_format(file, scene::first_bytes(file));
    if (format && !format->is_scenario)
      throw UserError(scene::wrong_format(file, *format, "a scenario (.yaml)"));
    const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
    ScenarioOptions from = options;
    // The scenario.yaml of a data set names its files as the scenario did that was run, from the folder that
    // this one was in.
    if (from.assets.empty() && file.filename() == io::scenario_file)
      from.assets = last_value(folder / io::run_file, "assets_folder");
    scenario = sim::load_scenario(file, from.assets);
    if (!options.set.empty()) scenario = with_values(scenario, from, file.string(), folder);
  }
  sim::override_scenario(scenario, {options.seed, options.ticks, options.sequences});
  if (options.ticks && scenario.trajectory_ticks && scenario.ticks > *scenario.trajectory_ticks)
    spdlog::warn("{}: its curves end at tick {} of {}; from there on they go straight", scenario.name,
                 *scenario.trajectory_ticks - 1, scenario.ticks);
  if (!chooses && !scenario.accuracy.empty())
    spdlog::warn(
        "{}: only `greatx generate` and `greatx calibrate` choose settings for 'accuracy' and "
        "'time_budget_ms_per_tick'; this command takes those that are written",
        scenario.name);
  return scenario;
}

std::string assets_folder(const ScenarioOptions& options) {
  const std::filesystem::path folder = options.assets.empty()
                                           ? std::filesystem::path(options.scenario).parent_path()
                                           : std::filesystem::path(options.assets);
  std::error_code ignored;
  return std::filesystem::absolute(folder.empty() ? "." : folder, ignored).lexically_normal().string();
}

uint32_t find_channel(const std::string& name, const sim::Scenario& scenario) {
  if (scenario.channels.empty())
    throw_user_error("{}: channels: expected one channel or more, found none", scenario.name);
  if (name.empty()) return 0;
  std::vector<std::string> names;
  for (uint32_t i = 0; i < scenario.channels.size(); ++i) {
    if (scenario.channels[i].name == name) return i;
    names.push_back(scenario.channels[i].name);
  }
  throw_user_error("--channel: {}", expected_one_of(names, name));
}

void check_instant(uint32_t sequence, int64_t tick, const sim::Scenario& scenario) {
  if (tick >= scenario.ticks)
    throw_user_error("--tick: expected 0 to {}, the last tick of {}, found {}", scenario.ticks - 1,
                     scenario.name, tick);
  if (sequence >= scenario.sequences)
    throw_user_error("--sequence: expected 0 to {}, found {}", scenario.sequences - 1, sequence);
}

void check_validation(const gpu::Device& device) {
  const std::vector<std::string> messages = device.validation_log()->take();
  if (messages.empty()) return;
  throw std::runtime_error(
      fmt::format("{} validation messages:\n{}", messages.size(), fmt::join(messages, "\n")));
}

}  // namespace greatx::apps
