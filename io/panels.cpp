// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/panels.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace greatx::io {

namespace {

struct Maker {
  std::string_view kind;
  void (*add)(const PanelSource&, Panels&);
};
constexpr Maker makers[] = {
    {"camera", add_camera_panels},
    {"lidar", add_lidar_panels},
    {"csi", add_csi_panels},
    {"pose", add_pose_panels},
};

}  // namespace

bool PanelSource::has(std::string_view array) const {
  return std::any_of(spec().arrays.begin(), spec().arrays.end(),
                     [&](const ArraySpec& candidate) { return candidate.name == array; });
}

void add_panels(const PanelSource& source, Panels& panels) {
  for (const Maker& maker : makers)
    if (maker.kind == source.spec().kind) maker.add(source, panels);
}

std::vector<std::string> node_names(const SensorSpec& pose) {
  const nlohmann::json metadata = nlohmann::json::parse(pose.metadata_json, nullptr, false);
  if (!metadata.is_object() || !metadata.contains("nodes") || !metadata["nodes"].is_array()) return {};
  std::vector<std::string> names;
  for (const auto& name : metadata["nodes"])
    names.push_back(name.is_string() ? name.get<std::string>() : name.dump());
  return names;
}

std::optional<dquat> world_from_sensor(const PanelSource& source, const IndexRow& row) {
  const std::vector<SensorSpec>& sensors = source.reader.sensors();
  const auto pose = std::find_if(sensors.begin(), sensors.end(), [](const SensorSpec& s) {
    return s.kind == "pose" && std::any_of(s.arrays.begin(), s.arrays.end(),
                                           [](const ArraySpec& a) { return a.name == "orientation"; });
  });
  if (pose == sensors.end()) return std::nullopt;
  const std::vector<std::string> names = node_names(*pose);
  const std::string node = source.spec().name.substr(0, source.spec().name.find('/'));
  const auto found = std::find(names.begin(), names.end(), node);
  if (found == names.end()) return std::nullopt;
  const std::vector<IndexRow> rows =
      source.reader.records_of(source.sequence, static_cast<size_t>(pose - sensors.begin()));
  const auto at =
      std::find_if(rows.begin(), rows.end(), [&](const IndexRow& r) { return r.tick == row.tick; });
  if (at == rows.end()) return std::nullopt;
  const Array orientations = source.reader.load(source.sequence, *at, "orientation");
  const double* const q = orientations.as<double>().data() + 4 * (found - names.begin());
  const dquat world_from_body(q[0], q[1], q[2], q[3]);
  const nlohmann::json metadata = nlohmann::json::parse(source.spec().metadata_json, nullptr, false);
  const nlohmann::json mount =
      metadata.is_object() ? metadata.value("body_from_sensor", nlohmann::json()) : nullptr;
  if (!mount.is_object() || !mount.contains("orientation_wxyz")) return world_from_body;
  const auto m = mount["orientation_wxyz"].get<std::vector<double>>();
  return m.size() == 4 ? world_from_body * dquat(m[0], m[1], m[2], m[3]) : world_from_body;
}

}  // namespace greatx::io
