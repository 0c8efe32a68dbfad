// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "apps/campaign/plan.h"
#include "apps/campaign/store.h"
#include "apps/check/report.h"
#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/console/exit_code.h"
#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "apps/console/session.h"
#include "apps/console/watch.h"
#include "core/parallel.h"
#include "sim/check/scene_check.h"
#include "sim/experiment/experiment.h"

namespace greatx::apps {
namespace {

struct CheckOptions {
  ScenarioOptions scenario;
  RunOptions run;
  uint32_t moments = 8;
  int64_t measured_ticks = 4;
  bool host = false, json = false, quiet = false;
};

/// Checks scenarios one after another. The device is opened if something is simulated.
class Checker {
 public:
  explicit Checker(const CheckOptions& options) : options_(options) {
    if (!options.host) device_ = std::make_unique<gpu::Device>(options.run.device_options());
  }

  CheckedScenario check(const std::string& name, const sim::Scenario& scenario) {
    const bool quiet = options_.quiet || options_.json;
    const TerminalWatch watch(quiet);
    const sim::Experiment experiment =
        experiment_ ? sim::make_experiment(scenario, *experiment_) : sim::make_experiment(scenario);
    CheckedScenario checked{name, sim::check_scene(experiment.scene()), {}, {}};
    const auto add = [&](std::vector<sim::Finding> more) {
      checked.findings.insert(checked.findings.end(), more.begin(), more.end());
    };
    for (const std::string& warning : scenario.warnings)
      add({{sim::Severity::doubt, "contradiction", "scenario",
            fmt::format("contradicts itself: {}", warning)}});
    const auto stop_if_interrupted = [&] {
      if (interrupted()) throw Interrupted("the check was interrupted");
    };
    {
      Progress progress(name + ": ways", scenario.sequences, quiet, "sequences");
      add(sim::check_courses(experiment, checked.courses, [&](uint32_t done) {
        progress.update(done);
        stop_if_interrupted();
      }));
    }
    if (device_ && options_.moments > 0) {
      Progress progress(name + ": moments", options_.moments, quiet, "moments");
      add(sim::look(experiment, *device_, options_.moments, checked.looks, [&](uint32_t done) {
        progress.update(done);
        stop_if_interrupted();
      }));
    }
    experiment_ = std::make_unique<sim::Experiment>(experiment);
    return checked;
  }

  std::optional<CellCost> measure(const sim::Scenario& scenario) {
    if (!device_ || options_.measured_ticks == 0) return std::nullopt;
    const TerminalWatch watch(options_.quiet || options_.json);
    return measure_cell(scenario, *device_, options_.measured_ticks);
  }
  void check_messages() const {
    if (device_) check_validation(*device_);
  }

 private:
  const CheckOptions& options_;
  std::unique_ptr<gpu::Device> device_;
  std::unique_ptr<sim::Experiment> experiment_;  ///< the last one, whose world the next may share
};

void finish(const CheckOptions& options, nlohmann::json json, const std::string& text, size_t faults,
            const std::string& what) {
  json["faults"] = faults;
  if (options.json)
    std::cout << json_text(json) << '\n';
  else
    std::cout << text;
  if (!options.quiet && !options.json)
    std::cout << fmt::format("{}: {}\n", what, faults == 0 ? "no faults" : fmt::format("{} faults", faults));
  if (faults > 0) throw Failed{exit_user};
}

void check_scenario(const CheckOptions& options) {
  const sim::Scenario scenario = load_scenario(options.scenario);
  Checker checker(options);
  const CheckedScenario checked = checker.check(scenario.name, scenario);
  nlohmann::json json = json_of(checked);
  std::string text = text_of(checked, !options.quiet);
  if (const std::optional<CellCost> cost = checker.measure(scenario)) {
    const auto ticks = static_cast<double>(scenario.ticks) * scenario.sequences;
    const double seconds = cost->start_s + ticks * cost->tick_s, gigabytes = 1e-9 * ticks * cost->tick_bytes;
    json["start_s"] = cost->start_s, json["tick_s"] = cost->tick_s, json["tick_bytes"] = cost->tick_bytes;
    json["hours"] = seconds / 3600.0, json["gigabytes"] = gigabytes;
    if (!options.quiet)
      text += fmt::format(
          "  {} sequences of {} ticks: {:.3g} GB and {:.3g} hours ({:.3g} MB and {:.3g} s a "
          "tick, {:.2g} s to start)\n",
          scenario.sequences, scenario.ticks, gigabytes, seconds / 3600.0, 1e-6 * cost->tick_bytes,
          cost->tick_s, cost->start_s);
  }
  checker.check_messages();
  finish(options, std::move(json), text, faults_of(checked), scenario.name);
}

void check_campaign(const CheckOptions& options) {
  if (options.scenario.seed || options.scenario.ticks || options.scenario.sequences ||
      !options.scenario.set.empty())
    throw_user_error(
        "{}: --seed, --ticks, --sequences and --set change a scenario; expected a campaign alone",
        options.scenario.scenario);
  const OpenCampaign open = open_campaign({options.scenario.scenario, "", options.scenario.assets, {}});
  Checker checker(options);
  nlohmann::json json{{"campaign", open.campaign.name}, {"cells", nlohmann::json::array()}};
  std::string text;
  size_t faults = 0;
  std::vector<CellCost> costs;
  for (const sim::CampaignCell& cell : open.cells) {
    const CheckedScenario checked = checker.check(cell.name, cell.scenario);
    json["cells"].push_back(json_of(checked));
    text += text_of(checked, false);
    faults += faults_of(checked);
    if (const std::optional<CellCost> cost = checker.measure(cell.scenario)) costs.push_back(*cost);
  }
  checker.check_messages();
  if (!costs.empty()) {
    const CampaignPlan plan = plan_of(open, costs, static_cast<uint32_t>(usable_cores()), {});
    json["plan"] = plan.json;
    if (!options.quiet) text += plan.text;
  }
  finish(options, std::move(json), text, faults, open.campaign.name);
}

void check(const CheckOptions& options) {
  install_interrupt_handler();
  if (is_campaign(options.scenario.scenario))
    check_campaign(options);
  else
    check_scenario(options);
}

}  // namespace

void add_check(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "check", "look for faults of a scenario or a campaign before hours are spent on it (docs/check.md)");
  auto options = std::make_shared<CheckOptions>();
  options->scenario.add_to(*command);
  CLI::Option* scenario = command->get_option("SCENARIO");
  scenario->description(scenario->get_description() + "; or a campaign: " + embedded_campaign_names());
  options->run.add_to(*command);
  command->add_option("--moments", options->moments, "moments that are simulated, for links and pictures")
      ->capture_default_str()
      ->check(integer_of(0, 100'000));
  command
      ->add_option("--measure", options->measured_ticks,
                   "ticks that are run and written, for hours and gigabytes; 0: none")
      ->capture_default_str()
      ->check(integer_of(0, 1000));
  command->add_flag("--host", options->host, "simulate nothing: no device is needed");
  command->add_flag("--json", options->json, "print one JSON object");
  command->add_flag("-q,--quiet", options->quiet, "print nothing but what is found");
  command->callback([options] { check(*options); });
}

}  // namespace greatx::apps
