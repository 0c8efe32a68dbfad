// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The joint settings of a study.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "apps/tradeoff/study.h"
#include "apps/tradeoff/study_json.h"
#include "core/error.h"
#include "sim/tradeoff/front.h"

namespace greatx::apps {

/// The knobs that take part in the joint settings of a modality.
struct JointKnobs {
  std::vector<const sim::Knob*> knobs;
  std::vector<sim::FrontKnob> fronts;  ///< of each knob
  std::string context;                 ///< Knob::context, which they share
  double own_ms = 0.0;                 ///< of a tick of the scenario
  double own_cost_ms = 0.0;            ///< cost_of() the scenario
};

namespace {

using Json = nlohmann::json;

constexpr const char* how_searched =
    "The search predicts joint settings from the single knobs: slower settings add their time, faster ones "
    "multiply it by their factor, and errors add as squares. It joins knob by knob and keeps every joint "
    "setting that no other one beats. Where all references at once would take too long, costly knobs "
    "go no further than the scenario's own setting. Joint settings spread over that predicted front were "
    "then measured together, in turns, against all knobs at their references at once.";

/// Returns the figure to judge by: the first one of the first setting that has any; null: none.
const Json* first_figure(const Json& knob) {
  for (const Json& setting : knob["settings"])
    if (!setting["errors"].empty()) return &setting["errors"].front();
  return nullptr;
}

double time_of(const Json& setting) { return setting["tick_ms"]["median"].get<double>(); }

/// Of a block as short as joint settings may have: one start, a warm-up and two timed ticks.
double cost_of(const Json& setting) { return setting["start_ms"].get<double>() + 3.0 * time_of(setting); }

/// Returns the context that most knobs share. A knob with another one acts on something else.
std::string shared_context(const std::vector<sim::Knob>& knobs) {
  std::map<std::string, size_t> uses;
  for (const sim::Knob& knob : knobs)
    if (knob.skipped.empty()) ++uses[knob.context];
  if (uses.empty()) return {};
  return std::ranges::max_element(uses, {}, [](const auto& use) { return use.second; })->first;
}

/// Adds a knob with its times and errors from the report, if it changes anything.
void add(JointKnobs& joint, const sim::Knob& knob, const Json& measured, const std::string& figure) {
  const Json& settings = measured["settings"];
  if (knob.context != joint.context || !knob.standard || settings.size() != knob.settings.size()) return;
  const Json& own = settings[*knob.standard];
  // The machine may have been faster or slower than with the other knobs.
  const double pace = joint.knobs.empty() ? 1.0 : joint.own_ms / time_of(own);
  sim::FrontKnob front{{}, *knob.standard, knob.reference, cost_of(settings[knob.reference]) / cost_of(own)};
  bool matters = false;
  for (const Json& setting : settings) {
    sim::FrontSetting point{pace * time_of(setting), 0.0};
    for (const Json& error : setting["errors"])
      if (error["name"] == figure && !error["value"].is_null())
        point.power =
            std::max(point.power, sim::error_power(error["value"].get<double>(), sim::relative_db(figure)));
    matters |= !setting["exact"].get<bool>();
    front.settings.push_back(point);
  }
  if (!matters) return;
  if (joint.knobs.empty()) {
    joint.own_ms = time_of(own);
    joint.own_cost_ms = cost_of(own);
  }
  joint.knobs.push_back(&knob);
  joint.fronts.push_back(std::move(front));
}

/// Returns joint settings spread over the predicted front, the scenario's own one, and the finest one.
std::vector<sim::FrontPoint> points_of(const JointKnobs& joint, size_t count) {
  sim::FrontPoint standard, finest;
  for (const sim::FrontKnob& front : joint.fronts) {
    const auto take = [&](sim::FrontPoint& point, size_t setting) {
      point = sim::joined(std::move(point), joint.own_ms, front.settings[setting], setting);
    };
    take(standard, front.standard);
    take(finest, front.reference);
  }
  std::vector<sim::FrontPoint> points = sim::thinned(sim::front_of(joint.own_ms, joint.fronts), count);
  points.push_back(standard);
  points.push_back(finest);
  return points;
}

/// Returns the changes of a joint setting.
std::vector<YamlChange> changes_of(const JointKnobs& joint, const sim::FrontPoint& point) {
  std::vector<YamlChange> changes = joint.knobs.front()->context_changes;
  for (size_t k = 0; k < joint.knobs.size(); ++k)
    for (const YamlChange& change : joint.knobs[k]->settings[point.choice[k]].changes)
      changes.push_back(change);
  return changes;
}

Json json_of_point(const JointKnobs& joint, const sim::FrontPoint& point, const sim::SettingResult& result,
                   const std::string& figure) {
  double worst = -std::numeric_limits<double>::infinity();
  for (const sim::SensorError& error : result.errors)
    if (error.figure.name == figure) worst = std::max(worst, error.figure.value);
  Json json{{"settings", Json::object()},
            {"predicted_ms", point.ms},
            {"predicted_error", number(sim::error_of_power(point.power, sim::relative_db(figure)))},
            {"tick_ms", spread_json(result.wall_ms)},
            {"error", number(worst)},
            {"default", false},
            {"reference", false}};
  for (size_t k = 0; k < joint.knobs.size(); ++k)
    if (point.choice[k] != joint.fronts[k].standard)
      json["settings"][joint.knobs[k]->name] = joint.knobs[k]->settings[point.choice[k]].label;
  return json;
}

}  // namespace

Json Study::measure_joint(const Part& part, const JointKnobs& joint, const std::string& figure) {
  std::vector<sim::Experiment> settings;
  std::vector<sim::FrontPoint> kept;
  const std::vector<sim::FrontPoint> points = points_of(joint, options_.joint);
  for (const sim::FrontPoint& point : points) try {
      settings.push_back(
          sim::experiment_with(part.experiment, changes_of(joint, point), whole_, scenario_options_.assets));
      kept.push_back(point);
    } catch (const UserError&) {  // settings that exclude each other
      if (&point == &points.back()) throw;
    }
  const std::vector<sim::SettingResult> results =
      measure(settings, settings.size() - 1, part, options_.joint_s);
  Json json = Json::array();
  for (size_t i = 0; i < results.size(); ++i)
    json.push_back(json_of_point(joint, kept[i], results[i], figure));
  json[results.size() - 2]["default"] = true;
  json[results.size() - 1]["reference"] = true;
  return json;
}

void Study::measure_front(const Part& part) {
  const std::string modality(sim::name_of(part.modality));
  JointKnobs joint;
  joint.context = shared_context(part.knobs);
  std::string figure, unit, sensor;
  for (const Json& measured : report_["knobs"]) {
    if (measured["modality"] != modality || !measured["skipped"].get<std::string>().empty()) continue;
    const auto knob = std::ranges::find(part.knobs, measured["name"].get<std::string>(), &sim::Knob::name);
    if (knob == part.knobs.end()) continue;
    if (const Json* const first = first_figure(measured); first != nullptr && figure.empty()) {
      figure = (*first)["name"];
      unit = (*first)["unit"];
      sensor = (*first)["sensor"];
    }
    add(joint, *knob, measured, figure);
  }
  // A block of each joint setting should fit, the scenario's own and the finest among them.
  const auto settings = static_cast<double>(options_.joint + 2);
  const double most = 1e3 * options_.joint_s / (settings * std::max(joint.own_cost_ms, 1e-3));
  Json costly = Json::array();
  for (const size_t k : sim::limit_costly(joint.fronts, most)) costly.push_back(joint.knobs[k]->name);
  report_["fronts"].push_back({{"modality", modality},
                               {"sensor", sensor},
                               {"figure", figure},
                               {"unit", unit},
                               {"how", how_searched},
                               {"context", joint.context},
                               {"costly", costly},
                               {"points", Json::array()}});
  if (!joint.knobs.empty()) report_["fronts"].back()["points"] = measure_joint(part, joint, figure);
  keep();
  ++done_;
  say(fmt::format("{}: {} joint settings", modality, report_["fronts"].back()["points"].size()));
}

}  // namespace greatx::apps
