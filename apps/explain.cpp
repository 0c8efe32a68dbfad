// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "apps/commands.h"
#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "apps/console/session.h"
#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "scene/georeference/georeference.h"
#include "sim/channel/notes.h"
#include "sim/experiment/experiment.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/tradeoff/effect_measure.h"

namespace greatx::apps {

namespace {

std::string turn_words(const sim::PartMotion& motion) {
  if (const auto* rate = std::get_if<sim::TurnRate>(&motion))
    return fmt::format("{:+.6g} Hz", rate->value_hz());
  if (const auto* roll = std::get_if<sim::RollConfig>(&motion))
    return fmt::format("rolls, radius {:.6g} m,", roll->radius_m);
  if (std::holds_alternative<sim::PedalConfig>(motion)) return "as the cyclist pedals";
  return "with the steps";
}

struct ExplainOptions {
  ScenarioOptions scenario;
  RunOptions run;
  bool json = false, measure = false, quiet = false;
};

constexpr int64_t pass_ticks = 5;

/// What was measured; empty without --measure.
struct Measured {
  std::string device;
  std::vector<sim::EffectChange> changes;
  std::vector<sim::PassTime> passes;
};

Measured measured(const sim::Experiment& experiment, const ExplainOptions& options) {
  Measured result;
  gpu::Device device(options.run.device_options());
  result.device = fmt::format("{} ({})", device.info().name, device.info().driver);
  install_interrupt_handler();
  const spdlog::level::level_enum level = spdlog::get_level();
  if (level == spdlog::level::info) spdlog::set_level(spdlog::level::err);
  result.passes = sim::pass_times(device, experiment, pass_ticks);
  result.changes =
      sim::measure_effects(device, experiment, options.scenario.assets, [&](const std::string& words) {
        if (interrupted()) throw Interrupted("the measurement was interrupted");
        if (!options.quiet && !words.empty()) std::cerr << fmt::format("measuring {}\n", words);
      });
  spdlog::set_level(level);
  check_validation(device);
  return result;
}

/// Says what switching an effect changes, e.g. "on would change the records by nmse -16 dB and add 25 ms".
std::string change_words(const sim::EffectChange& change) {
  if (!change.unmeasured.empty()) return "not measured: " + change.unmeasured;
  const double ms = change.switched_ms.median - change.own_ms.median;
  const double spread =
      std::max(change.own_ms.high - change.own_ms.low, change.switched_ms.high - change.switched_ms.low);
  const std::string time = fmt::format("{:+.3g} ms (+-{:.2g}) of {:.3g} ms a tick of {}", ms, spread,
                                       change.own_ms.median, sim::name_of(change.modality));
  std::vector<std::string> figures;
  for (const sim::ErrorFigure& figure : change.figures)
    if (figure.value != 0.0 && std::isfinite(figure.value))
      figures.push_back(fmt::format("{} {:.3g} {}", figure.name, figure.value, figure.unit));
  const std::string changes = change.exact      ? "the same bytes"
                              : figures.empty() ? "bytes, but no figure of error"
                                                : fmt::format("{}", fmt::join(figures, ", "));
  return fmt::format("{} would give {}, and {}", change.on ? "off" : "on", changes, time);
}

void add_measured(nlohmann::json& json, const Measured& measured) {
  json["device"] = measured.device;
  json["measured"] = nlohmann::json::array();
  for (const sim::EffectChange& change : measured.changes) {
    nlohmann::json row{{"effect", change.effect},
                       {"modality", sim::name_of(change.modality)},
                       {"on", change.on},
                       {"unmeasured", change.unmeasured},
                       {"own_ms", change.own_ms.median},
                       {"switched_ms", change.switched_ms.median},
                       {"exact", change.exact},
                       {"figures", nlohmann::json::object()}};
    for (const sim::ErrorFigure& figure : change.figures)
      row["figures"][figure.name] = {
          {"unit", figure.unit},
          {"value", std::isfinite(figure.value) ? nlohmann::json(figure.value) : nlohmann::json()}};
    json["measured"].push_back(std::move(row));
  }
  json["passes"] = nlohmann::json::array();
  for (const sim::PassTime& pass : measured.passes)
    json["passes"].push_back(
        {{"name", pass.name}, {"host", pass.host}, {"count", pass.count}, {"ms", pass.ms}});
}

void print_json(const sim::Experiment& experiment, const Measured& measured) {
  const sim::Scenario& scenario = experiment.scenario;
  nlohmann::json json{{"scenario", scenario.name}, {"effects", nlohmann::json::array()}};
  for (const sim::Effect* effect : experiment.plan.all())
    json["effects"].push_back({{"name", effect->name},
                               {"on", effect->on},
                               {"switchable", effect->switchable},
                               {"reason", effect->reason},
                               {"bound", effect->bound}});
  if (const auto& reference = scenario.scene.georeference)
    json["georeference"] = nlohmann::json::parse(scene::georeference_json(*reference));
  if (const auto& place = scenario.environment.place)
    json["place"] = {{"latitude_deg", degrees(place->latitude)},
                     {"longitude_deg", degrees(place->longitude)},
                     {"height_m", place->height_m},
                     {"time", place->time},
                     {"of_scene", place->of_scene}};
  if (!scenario.warnings.empty()) json["warnings"] = scenario.warnings;
  json["parts"] = nlohmann::json::array();
  for (const sim::Part& part : experiment.world->parts)
    if (const auto* rate = std::get_if<sim::TurnRate>(&part.motion))
      json["parts"].push_back({{"name", part.name}, {"rate_hz", rate->value_hz()}});
    else
      json["parts"].push_back({{"name", part.name}, {"turns", turn_words(part.motion)}});
  json["channels"] = nlohmann::json::object();
  for (uint32_t channel = 0; channel < scenario.channels.size(); ++channel)
    for (const auto& [name, text] : sim::channel_notes(experiment, channel))
      json["channels"][scenario.channels[channel].name][name] = text;
  if (!measured.device.empty()) add_measured(json, measured);
  std::cout << json_text(json) << '\n';
}

void print_passes(const Measured& measured) {
  std::cout << fmt::format("times per tick of the whole scenario on {}, means of {} ticks:\n",
                           measured.device, pass_ticks);
  for (const sim::PassTime& pass : measured.passes)
    if (pass.ms >= 0.005)
      std::cout << fmt::format("  {:<6} {:<40} {:>9.2f} ms{}\n", pass.host ? "host" : "device", pass.name,
                               pass.ms, pass.count == 1.0 ? "" : fmt::format(", {:.3g} times", pass.count));
}

/// Says where on the Earth the scene is, and where and when the sun and the sky are those of.
void print_places(const sim::Scenario& scenario) {
  if (const auto& reference = scenario.scene.georeference)
    std::cout << fmt::format("  origin at {}\n", scene::georeference_words(*reference));
  if (const auto& place = scenario.environment.place)
    std::cout << fmt::format("  sun and sky at latitude {:.6g}, longitude {:.6g} ({}), {}\n",
                             degrees(place->latitude), degrees(place->longitude),
                             place->of_scene ? "the scene's georeference" : "environment.place",
                             printable(place->time));
  for (const std::string& warning : scenario.warnings)
    std::cout << fmt::format("  warning: {}\n", printable(warning));
}

void print_words(const sim::Experiment& experiment, const Measured& measured) {
  const sim::Scenario& scenario = experiment.scenario;
  const sim::World& world = *experiment.world;
  std::cout << fmt::format("{}: {} triangles, {} facets, {} instances, {} bodies\n", scenario.name,
                           world.scene.triangle_count(), world.scene.facets.size(),
                           world.scene.instances.size(), world.scene.bodies.size());
  print_places(scenario);
  for (const sim::Part& part : world.parts)
    std::cout << fmt::format("  turns {:<24} {} about ({:.3f}, {:.3f}, {:.3f}) of its node\n", part.name,
                             turn_words(part.motion), world.scene.bodies[part.body].joint->axis.x,
                             world.scene.bodies[part.body].joint->axis.y,
                             world.scene.bodies[part.body].joint->axis.z);
  for (const sim::Effect* effect : experiment.plan.all()) {
    std::cout << fmt::format("  {:<4} {:<24}{} {}{}\n", effect->on ? "on" : "off", effect->name,
                             effect->switchable ? " " : "*", effect->reason,
                             effect->bound.empty() ? "" : " — " + effect->bound);
    for (const sim::EffectChange& change : measured.changes)
      if (change.effect == effect->name && !change.unmeasured.starts_with("nothing to act on"))
        std::cout << fmt::format("  {:<30} {}\n", "", change_words(change));
  }
  std::cout << "* follows from the sensors; the others can be switched under `effects:` in the scenario\n";
  if (measured.device.empty())
    std::cout << "--measure runs the scenario and says what each effect costs and changes here\n";
  else
    print_passes(measured);
  for (uint32_t channel = 0; channel < scenario.channels.size(); ++channel) {
    std::cout << fmt::format("channel '{}', candidates:\n", scenario.channels[channel].name);
    for (const auto& [name, text] : sim::channel_notes(experiment, channel))
      std::cout << fmt::format("  {:<18} {}\n", name, text);
  }
}

void run_explain(const ExplainOptions& options) {
  const sim::Experiment experiment = sim::make_experiment(load_scenario(options.scenario));
  const Measured result = options.measure ? measured(experiment, options) : Measured{};
  if (options.json)
    print_json(experiment, result);
  else
    print_words(experiment, result);
}

}  // namespace

void add_explain(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "explain", "say which effects a scenario calls for, why, and what the others could change");
  auto options = std::make_shared<ExplainOptions>();
  options->scenario.add_to(*command);
  options->run.add_to(*command);
  command->add_flag("--measure", options->measure,
                    "run the scenario with every effect switched by itself: its time, and what it changes");
  command->add_flag("--json", options->json, "print one JSON object");
  command->add_flag("-q,--quiet", options->quiet, "print no progress");
  command->callback([options] { run_explain(*options); });
}

}  // namespace greatx::apps
