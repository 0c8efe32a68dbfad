// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/panels.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace greatx::io {

namespace {

struct Maker {
  std::string_view kind;
  bool
      frames;  ///< a picture per moment, drawn for every sensor of the kind; else over time, for the first one only
  void (*add)(const PanelSource&, Panels&);
};
constexpr Maker makers[] = {
    {"camera", true, add_camera_panels}, {"event_camera", true, add_event_panels},
    {"lidar", true, add_lidar_panels},   {"radar", true, add_radar_panels},
    {"csi", false, add_csi_panels},      {"pose", false, add_pose_panels},
};

/// "body_from_sensor": {"position_m": [3], "orientation_wxyz": [4]}; the identity if it is not there.
Pose mount_of(const SensorSpec& sensor) {
  const nlohmann::json metadata = nlohmann::json::parse(sensor.metadata_json, nullptr, false);
  Pose mount;
  if (!metadata.is_object() || !metadata.contains("body_from_sensor")) return mount;
  const nlohmann::json& json = metadata["body_from_sensor"];
  const auto p = json.value("position_m", std::vector<double>{0, 0, 0});
  const auto q = json.value("orientation_wxyz", std::vector<double>{1, 0, 0, 0});
  if (p.size() == 3) mount.position = {p[0], p[1], p[2]};
  if (q.size() == 4) mount.orientation = dquat(q[0], q[1], q[2], q[3]);
  return mount;
}

}  // namespace

bool PanelSource::has(std::string_view array) const {
  return std::any_of(spec().arrays.begin(), spec().arrays.end(),
                     [&](const ArraySpec& candidate) { return candidate.name == array; });
}

void add_panels(const PanelSource& source, Panels& panels) {
  for (const Maker& maker : makers)
    if (maker.kind == source.spec().kind) maker.add(source, panels);
}

bool has_frame_panels(std::string_view kind) {
  return std::any_of(std::begin(makers), std::end(makers),
                     [&](const Maker& maker) { return maker.kind == kind && maker.frames; });
}

std::vector<std::string> node_names(const SensorSpec& pose) {
  const nlohmann::json metadata = nlohmann::json::parse(pose.metadata_json, nullptr, false);
  if (!metadata.is_object() || !metadata.contains("nodes") || !metadata["nodes"].is_array()) return {};
  std::vector<std::string> names;
  for (const auto& name : metadata["nodes"])
    names.push_back(name.is_string() ? name.get<std::string>() : name.dump());
  return names;
}

std::optional<Pose> world_from_sensor(const PanelSource& source, const IndexRow& row) {
  const std::vector<SensorSpec>& sensors = source.reader.sensors();
  const auto has = [](const SensorSpec& sensor, const char* name) {
    return std::any_of(sensor.arrays.begin(), sensor.arrays.end(),
                       [&](const ArraySpec& array) { return array.name == name; });
  };
  const auto pose = std::find_if(sensors.begin(), sensors.end(), [&](const SensorSpec& s) {
    return s.kind == "pose" && has(s, "position") && has(s, "orientation");
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
  const Array positions = source.reader.load(source.sequence, *at, "position");
  const Array orientations = source.reader.load(source.sequence, *at, "orientation");
  const double* const p = positions.as<double>().data() + 3 * (found - names.begin());
  const double* const q = orientations.as<double>().data() + 4 * (found - names.begin());
  return Pose{{p[0], p[1], p[2]}, dquat(q[0], q[1], q[2], q[3])} * mount_of(source.spec());
}

}  // namespace greatx::io
