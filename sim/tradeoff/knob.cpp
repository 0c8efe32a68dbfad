// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/knob.h"

#include <algorithm>

#include "core/error.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/sensor_kinds.h"

namespace greatx::sim {

namespace {

struct ModalityRow {
  Modality modality;
  std::string_view name, kind;
};
constexpr ModalityRow modality_rows[] = {{Modality::csi, "csi", "csi"},
                                         {Modality::camera, "camera", "camera"},
                                         {Modality::events, "events", "event_camera"},
                                         {Modality::lidar, "lidar", "lidar"},
                                         {Modality::radar, "radar", "radar"}};

bool belongs(const NodeConfig& node, const SensorConfig& sensor, Modality modality) {
  if (!sensor_kind(sensor).fires) return true;
  if (sensor_kind(sensor).type == kind_of(modality)) return true;
  // The pixels that an event camera has from a camera.
  return modality == Modality::events && std::ranges::any_of(node.sensors, [&](const SensorConfig& other) {
           const auto* const events = std::get_if<EventCameraConfig>(&other.config);
           return events != nullptr && events->camera == sensor.name;
         });
}

}  // namespace

std::string_view name_of(Modality modality) { return modality_rows[static_cast<size_t>(modality)].name; }
std::string_view kind_of(Modality modality) { return modality_rows[static_cast<size_t>(modality)].kind; }
std::optional<Modality> modality_of(std::string_view name) {
  for (const ModalityRow& row : modality_rows)
    if (row.name == name) return row.modality;
  return {};
}

bool is_effect(const Knob& knob) {
  return knob.settings.front().label == "off" && knob.settings[0].changes.size() == 1 &&
         knob.settings[0].changes[0].path.front() == YamlStep("effects");
}

bool has(const Scenario& scenario, Modality modality) {
  if (modality == Modality::csi) return !scenario.channels.empty();
  return std::ranges::any_of(scenario.nodes, [&](const NodeConfig& node) {
    return std::ranges::any_of(node.sensors, [&](const SensorConfig& sensor) {
      return sensor_kind(sensor).type == kind_of(modality);
    });
  });
}

Scenario changed(const Scenario& scenario, const std::vector<YamlChange>& changes,
                 const std::filesystem::path& assets) {
  std::string text = scenario.text;
  for (const YamlChange& change : changes) text = edit_yaml(text, change).text;
  const bool embedded = scenario.file.empty();
  const std::string name = embedded ? scenario.name + ".yaml" : scenario.file.string();
  Scenario result = parse_scenario(text, name, embedded ? "." : scenario.file.parent_path(), assets);
  result.file = scenario.file;
  return result;
}

std::optional<Scenario> alone(const Scenario& scenario, Modality modality,
                              const std::filesystem::path& assets) {
  if (!has(scenario, modality)) return {};
  std::vector<YamlChange> changes;
  const auto remove = [&](YamlPath path) {
    changes.push_back({YamlChange::Kind::remove, std::move(path), ""});
  };
  for (size_t n = 0; n < scenario.nodes.size(); ++n) {
    const NodeConfig& node = scenario.nodes[n];
    for (size_t s = node.sensors.size(); s-- > 0;)
      if (!belongs(node, node.sensors[s], modality)) remove({"nodes", n, "sensors", s});
  }
  if (modality != Modality::csi && !scenario.channels.empty()) remove({"channels"});
  changes.push_back({YamlChange::Kind::set, {"effects", "consistency"}, "off"});
  return changed(scenario, changes, assets);
}

}  // namespace greatx::sim
