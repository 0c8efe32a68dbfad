// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/console/json_text.h"
#include "apps/console/session.h"
#include "sim/channel/notes.h"
#include "sim/experiment/experiment.h"
#include "sim/scenario/parse/load_scenario.h"

namespace greatx::apps {

namespace {

struct ExplainOptions {
  ScenarioOptions scenario;
  bool json = false;
};

void run_explain(const ExplainOptions& options) {
  const sim::Experiment experiment = sim::make_experiment(load_scenario(options.scenario));
  const sim::Scenario& scenario = experiment.scenario;
  const sim::World& world = *experiment.world;
  if (options.json) {
    nlohmann::json json{{"scenario", scenario.name}, {"effects", nlohmann::json::array()}};
    for (const sim::Effect* effect : experiment.plan.all())
      json["effects"].push_back({{"name", effect->name},
                                 {"on", effect->on},
                                 {"switchable", effect->switchable},
                                 {"reason", effect->reason},
                                 {"bound", effect->bound}});
    json["parts"] = nlohmann::json::array();
    for (const sim::Part& part : world.parts)
      json["parts"].push_back({{"name", part.name}, {"rate_hz", part.rate.value_hz()}});
    json["channels"] = nlohmann::json::object();
    for (uint32_t channel = 0; channel < scenario.channels.size(); ++channel)
      for (const auto& [name, text] : sim::channel_notes(experiment, channel))
        json["channels"][scenario.channels[channel].name][name] = text;
    std::cout << json_text(json) << '\n';
    return;
  }
  std::cout << fmt::format("{}: {} triangles, {} facets, {} instances, {} bodies\n", scenario.name,
                           world.scene.triangle_count(), world.scene.facets.size(),
                           world.scene.instances.size(), world.scene.bodies.size());
  for (const sim::Part& part : world.parts)
    std::cout << fmt::format("  turns {:<24} {:+.6g} Hz about ({:.3f}, {:.3f}, {:.3f}) of its node\n",
                             part.name, part.rate.value_hz(), world.scene.bodies[part.body].joint->axis.x,
                             world.scene.bodies[part.body].joint->axis.y,
                             world.scene.bodies[part.body].joint->axis.z);
  for (const sim::Effect* effect : experiment.plan.all())
    std::cout << fmt::format("  {:<4} {:<24}{} {}{}\n", effect->on ? "on" : "off", effect->name,
                             effect->switchable ? " " : "*", effect->reason,
                             effect->bound.empty() ? "" : " — " + effect->bound);
  std::cout << "* follows from the sensors; the others can be switched under `effects:` in the scenario\n";
  for (uint32_t channel = 0; channel < scenario.channels.size(); ++channel) {
    std::cout << fmt::format("channel '{}', candidates:\n", scenario.channels[channel].name);
    for (const auto& [name, text] : sim::channel_notes(experiment, channel))
      std::cout << fmt::format("  {:<18} {}\n", name, text);
  }
}

}  // namespace

void add_explain(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "explain", "say which effects a scenario calls for, why, and what the others could change");
  auto options = std::make_shared<ExplainOptions>();
  options->scenario.add_to(*command);
  command->add_flag("--json", options->json, "print one JSON object");
  command->callback([options] { run_explain(*options); });
}

}  // namespace greatx::apps
