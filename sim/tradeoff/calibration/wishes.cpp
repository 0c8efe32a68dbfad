// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/calibration/wishes.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "core/error.h"
#include "core/fields/yaml.h"

namespace greatx::sim {

namespace {

/// Knobs that say what is simulated rather than how exactly, each with the reason.
struct NotAccuracy {
  const char *knob, *why;
};
constexpr NotAccuracy not_accuracy[] = {
    {"resolution", "the shape of a picture is a part of what is asked for"},
    {"lidar_range_noise", "noise is a part of the sensor"},
    {"lidar_detection", "the threshold is a part of the sensor"},
    {"radar_noise", "noise is a part of the sensor"},
    {"radar_phase_noise", "noise is a part of the sensor"},
    {"radar_quantisation", "steps of the converter are a part of the sensor"},
    {"free_edges", "whether such edges are plates is a property of the model"},
    {"doppler", "it costs nothing"}};

bool remembers_cameras(const Scenario& scenario) {
  return std::ranges::any_of(scenario.nodes, [](const NodeConfig& node) {
    return std::ranges::any_of(node.sensors, [](const SensorConfig& sensor) {
      return std::holds_alternative<EventCameraConfig>(sensor.config);
    });
  });
}

/// Whether the scenario itself gives a place a value other than `auto`.
bool is_written(const Scenario& scenario, const YamlPath& path) {
  const auto value = value_at(read_yaml(scenario.text, scenario.name), path);
  return value != nullptr && yaml_line(*value) != "auto";
}

bool has_key(const Scenario& scenario, const char* key) {
  return value_at(read_yaml(scenario.text, scenario.name), {key}) != nullptr;
}

}  // namespace

std::vector<YamlChange> without_wishes(const Scenario& scenario) {
  std::vector<YamlChange> changes;
  for (const char* const key : {"accuracy", "time_budget_ms_per_tick"})
    if (has_key(scenario, key)) changes.push_back({YamlChange::Kind::remove, {key}, ""});
  return changes;
}

Scenario scenario_to_calibrate(const Experiment& whole, Modality modality,
                               const std::filesystem::path& assets) {
  const Scenario bare = changed(whole.scenario, without_wishes(whole.scenario), assets);
  std::optional<Scenario> part = alone(bare, modality, assets);
  if (!part)
    throw_user_error("{}: accuracy: an error of '{}' is given, but the scenario has no such sensor",
                     whole.scenario.name, name_of(modality));
  if (modality != Modality::radar) return *part;
  std::vector<YamlChange> quiet;
  for (const char* const noise : {"radar_noise", "radar_phase_noise", "radar_quantisation"})
    quiet.push_back({YamlChange::Kind::set, {"effects", noise}, "off"});
  return changed(*part, quiet, assets);
}

std::string why_kept(const Knob& knob, const Experiment& base, const Scenario& whole, Modality modality) {
  for (const NotAccuracy& row : not_accuracy)
    if (knob.name == row.knob) return row.why;
  if (modality == Modality::events && knob.name != "steps") return "steps are evenly spaced here";
  if (modality == Modality::camera && remembers_cameras(whole)) return "event cameras see it, too";
  for (const Setting& setting : knob.settings)
    for (const YamlChange& change : setting.changes)
      if (is_written(base.scenario, change.path)) return "the scenario writes it";
  if (!knob.skipped.empty()) return knob.skipped;
  if (!knob.context.empty()) return fmt::format("only {}", knob.context);
  for (const Effect* effect : base.plan.all())
    if (effect->name == knob.name && !effect->on && effect->reason == "within the tolerance")
      return "its bound is within the tolerance";
  return {};
}

void check_figures(const SettingResult& reference, std::span<const AccuracyTarget> targets,
                   const Scenario& scenario) {
  for (const AccuracyTarget& target : targets)
    if (target.asked && std::ranges::none_of(reference.errors, [&](const SensorError& error) {
          return error.figure.name == target.kind->figure;
        }))
      throw_user_error(
          "{}: accuracy.{}: no sensor delivered anything to compare ({}) on the ticks of the calibration",
          scenario.name, target.kind->name, target.kind->about);
}

std::vector<YamlChange> for_whole(std::vector<YamlChange> changes, const Scenario& alone,
                                  const Scenario& whole) {
  for (YamlChange& change : changes) {
    YamlPath& path = change.path;
    if (path.size() < 4 || path[0] != YamlStep("nodes")) continue;
    const NodeConfig& node = alone.nodes[std::get<size_t>(path[1])];
    const std::string& name = node.sensors[std::get<size_t>(path[3])].name;
    const std::optional<SensorPlace> place = find_sensor(whole.nodes, node.name + "/" + name);
    GREATX_CHECK(place.has_value(), "no sensor {}/{}", node.name, name);
    path[1] = size_t{place->node};
    path[3] = size_t{place->sensor};
  }
  return changes;
}

}  // namespace greatx::sim
