// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/load_scenario.h"

#include <algorithm>
#include <array>

#include <fmt/ranges.h>

#include "core/activity.h"
#include "core/expected.h"
#include "core/input_file.h"
#include "core/units.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

/// Returns the number of ticks whose time lies in [0, duration).
int64_t ticks_of_duration(const Field& field, const Rational& tick_rate_hz) {
  const Rational duration = rational_of(field, "a duration greater than 0 in seconds");
  const auto ticks = product(duration, tick_rate_hz);
  const int64_t whole =
      ticks ? ticks->numerator / ticks->denominator + (ticks->numerator % ticks->denominator ? 1 : 0) : 0;
  if (!ticks || whole > most_ticks)
    field.fail(fmt::format("a duration of at most {} ticks of 1/{} s", most_ticks, tick_rate_hz.str()));
  return whole;
}

void parse_time(const FieldMap& map, Scenario& scenario) {
  if (const auto f = map.find("tick_rate_hz"))
    scenario.tick_rate_hz = rational_of(*f, "a rate greater than 0 such as 1000, 29.97 or 30000/1001");
  map.exclude("duration_s", "ticks");
  if (const auto f = map.find("ticks"))
    scenario.ticks = static_cast<int64_t>(f->integer(1, most_ticks));
  else
    scenario.ticks = ticks_of_duration(map.require("duration_s", "a duration in seconds (or 'ticks')"),
                                       scenario.tick_rate_hz);
  if (const auto f = map.find("trajectory_ticks"))
    scenario.trajectory_ticks = static_cast<int64_t>(f->integer(1, most_ticks));
}

std::map<std::string, Switch> parse_effects(const Field& field) {
  constexpr Switch switches[] = {Switch::automatic, Switch::on, Switch::off};
  std::map<std::string, Switch> effects;
  for (const auto& [name, value] : field.entries())
    effects[name] = switches[value.choice({"auto", "on", "off"})];
  return effects;
}

AccuracyWish parse_accuracy(const FieldMap& map) {
  AccuracyWish wish;
  if (const auto f = map.find("time_budget_ms_per_tick")) wish.budget_ms = f->between(1e-3, 1e9);
  const auto accuracy = map.find("accuracy");
  if (!accuracy) return wish;
  std::vector<std::string_view> names;
  for (const AccuracyKind& kind : accuracy_kinds()) names.push_back(kind.name);
  for (const auto& [name, value] : accuracy->entries())
    if (std::ranges::find(names, name) == names.end()) value.refuse(expected_one_of(names, name));
  for (const AccuracyKind& kind : accuracy_kinds())
    for (const auto& [name, value] : accuracy->entries())
      if (name == kind.name) wish.targets.push_back({&kind, value.between(kind.least, kind.most)});
  if (wish.targets.empty()) accuracy->fail("one error or more", "none");
  return wish;
}

StorageConfig parse_storage(const Field& field) {
  const FieldMap map(field, {"compression"});
  StorageConfig storage;
  if (const auto f = map.find("compression"))
    storage.compression = static_cast<Compression>(f->choice({"none", "fast", "small"}));
  return storage;
}

/// Gives sensors whose outputs are not listed those that keep each array once, if the data set is compressed.
void store_once(Scenario& scenario) {
  if (scenario.storage.compression == Compression::none) return;
  for (NodeConfig& node : scenario.nodes) {
    for (SensorConfig& sensor : node.sensors) {
      if (auto* const camera = std::get_if<CameraConfig>(&sensor.config); camera && !camera->listed)
        camera->depth_exr = camera->depth_png24 = false;
      if (auto* const lidar = std::get_if<LidarConfig>(&sensor.config); lidar && !lidar->outputs.listed)
        lidar->outputs = {.points = false, .ply = false, .arrays = true};
    }
  }
}

/// Refuses names that would share a folder or a body.
void check_names(const Field& root, const Scenario& scenario) {
  for (const auto& [key, field] : root.entries()) {
    if (key != "channels") continue;
    for (const Field& channel : field.list("channels"))
      for (const auto& [name_key, name] : channel.entries())
        for (const NodeConfig& node : scenario.nodes)
          if (name_key == "name" && name.text() == node.name)
            name.fail("a name that no node has", fmt::format("'{}', a node's", node.name));
  }
  for (const NodeConfig& node : scenario.nodes)
    for (const StaticObject& object : scenario.scene.objects)
      if (object.name == node.name)
        throw_user_error_at(node.where, "nodes: expected a name that no object of the scene has, found '{}'",
                            node.name);
}

bool is_generated_city(const SceneConfig& scene) {
  if (scene.objects.empty()) return false;
  const auto* const made = std::get_if<Generated>(&scene.objects.front().model.source);
  return made != nullptr && made->kind == "city";
}

}  // namespace

Scenario parse_scenario(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                        const std::filesystem::path& assets) {
  const Field root = Field::parse_yaml(text, {name, folder, assets});
  if (!root.is_map())
    root.fail("a scenario: a map with 'greatx: 1', 'name', 'ticks' and others (docs/scenario.md)");
  const FieldMap map(root, {"greatx", "name", "seed", "sequences", "duration_s", "ticks", "trajectory_ticks",
                            "tick_rate_hz", "scene", "environment", "traffic", "nodes", "channels", "effects",
                            "tolerance_db", "accuracy", "time_budget_ms_per_tick", "storage"});
  map.require("greatx", "1 (the format's version)").choice({"1"});

  Scenario scenario;
  scenario.text = text;
  scenario.name = map.require("name", "a name").name();
  if (const auto f = map.find("seed")) scenario.seed = f->integer(0);
  if (const auto f = map.find("sequences")) scenario.sequences = f->integer32(1, most_sequences);
  parse_time(map, scenario);
  if (const auto f = map.find("scene")) scenario.scene = parse_scene(*f);
  if (const auto f = map.find("environment"))
    scenario.environment = parse_environment(*f, scenario.scene.georeference, scenario.warnings);
  if (const auto f = map.find("traffic"))
    scenario.nodes =
        parse_traffic(*f, scenario.seed, is_generated_city(scenario.scene), scenario.traffic.emplace());
  if (const auto f = map.find("nodes"))
    scenario.nodes = parse_nodes(*f, scenario.tick_rate_hz, EarthPositions(scenario.scene), scenario.nodes);
  if (const auto f = map.find("channels")) {
    scenario.channels = parse_channels(*f, scenario.tick_rate_hz, scenario.nodes);
    if (scenario.scene.optical_only && !scenario.channels.empty())
      f->fail("no channels, for scene.optical_only is true", fmt::format("{}", scenario.channels.size()));
  }
  if (const auto f = map.find("effects")) scenario.effects = parse_effects(*f);
  if (const auto f = map.find("tolerance_db")) scenario.tolerance_db = f->non_negative();
  scenario.accuracy = parse_accuracy(map);
  if (const auto f = map.find("storage")) scenario.storage = parse_storage(*f);
  store_once(scenario);
  check_names(root, scenario);
  return scenario;
}

Scenario load_scenario(const std::filesystem::path& file, const std::filesystem::path& assets) {
  const Activity activity("reading the scenario");
  const std::string name = file.string();
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw_user_error("{}: expected a scenario file, found no such file", name);
  if (!std::filesystem::is_regular_file(file, error))
    throw_user_error("{}: expected a scenario file, found something else than a regular file", name);
  const std::string text =
      InputFile(file, fmt::format("{}: expected a readable scenario", name), budget::yaml_file).text();
  Scenario scenario = parse_scenario(text, name, std::filesystem::absolute(file).parent_path(), assets);
  scenario.file = std::filesystem::absolute(file).lexically_normal();
  return scenario;
}

}  // namespace greatx::sim
