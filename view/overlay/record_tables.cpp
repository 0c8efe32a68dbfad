// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/record_tables.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "io/files/untrusted_json.h"
#include "view/overlay/antenna_metadata.h"
#include "view/overlay/json_values.h"
#include "view/overlay/record_arrays.h"

namespace greatx::view {

namespace {

using io::JsonDocument;
using io::JsonValue;

constexpr size_t most_instances = 1 << 22, most_names = 1'000'000, most_ends = 100'000;
constexpr double largest_pixels = 1e7;

std::string node_part(const std::string& sensor) { return sensor.substr(0, sensor.find('/')); }

CameraFacts camera_facts(const JsonValue& json) {
  CameraFacts facts;
  facts.width = static_cast<double>(json.at("width").integer(1, 1 << 20));
  facts.height = static_cast<double>(json.at("height").integer(1, 1 << 20));
  facts.fx = json.at("fx").number(1e-6, largest_pixels);
  facts.fy = json.at("fy").number(1e-6, largest_pixels);
  facts.cx = json.at("cx").number(-largest_pixels, largest_pixels);
  facts.cy = json.at("cy").number(-largest_pixels, largest_pixels);
  facts.near_m = number_or(json, "near_m", 0.0, 0.0, 1e9);
  facts.distorted = json.has("distortion") || json.has("lens");
  if (json.has("camera")) facts.shared_with = json.at("camera").text();
  return facts;
}

/// Extent of the positions of a list of antennas along the sensor's y and z, m.
dvec2 aperture_of(const JsonValue& json, const char* key) {
  if (!json.has(key)) return dvec2(0.0);
  dvec3 low(farthest_m), high(-farthest_m);
  for (const JsonValue& antenna : json.at(key).list(most_ends)) {
    low = glm::min(low, vector_of(antenna));
    high = glm::max(high, vector_of(antenna));
  }
  return high.x < low.x ? dvec2(0.0) : dvec2(high.y - low.y, high.z - low.z);
}

/// The beams of the virtual array: its aperture is the sum of those of both sides.
void add_beams(RadarFacts& facts, const JsonValue& json) {
  if (!json.has("waveform") || !json.at("waveform").has("carrier_hz")) return;
  const double wavelength_m = speed_of_light / json.at("waveform").at("carrier_hz").number(1.0, 1e15);
  const dvec2 aperture = aperture_of(json, "transmit_m") + aperture_of(json, "receive_m");
  const auto beam = [&](double width_m) {
    return width_m > 0.1 * wavelength_m ? std::min(wavelength_m / width_m, pi) : 0.0;
  };
  facts.azimuth_beam = beam(aperture.x);
  facts.elevation_beam = beam(aperture.y);
}

RadarFacts radar_facts(const JsonValue& json) {
  RadarFacts facts;
  facts.azimuth_min = number_or(json, "azimuth_min_rad", 0.0, -7.0, 7.0);
  facts.azimuth_max = number_or(json, "azimuth_max_rad", 0.0, -7.0, 7.0);
  facts.range_span_m = number_or(json, "range_span_m", 0.0, 0.0, 1e9);
  facts.velocity_max_m_s = std::abs(number_or(json, "velocity_min_m_s", 0.0, -1e9, 1e9));
  facts.frame_middle_s = number_or(json, "frame_middle_s", 0.0, 0.0, 1e3);
  facts.range_bin_m = number_or(json, "range_bin_m", 0.0, 0.0, 1e9);
  facts.velocity_bin_m_s = number_or(json, "velocity_bin_m_s", 0.0, 0.0, 1e9);
  add_beams(facts, json);
  return facts;
}

std::vector<std::string> names_of(const JsonValue& json, const char* key) {
  std::vector<std::string> names;
  if (!json.has(key)) return names;
  for (const JsonValue& name : json.at(key).list(most_names)) names.push_back(name.text());
  return names;
}

std::string name_in(const std::vector<std::string>& names, uint32_t id, const char* what) {
  if (id == 0) return "nothing";
  return id <= names.size() ? printable(names[id - 1]) : fmt::format("{} {}", what, id);
}

}  // namespace

RecordTables::RecordTables(const std::string& run_json, std::span<const SensorSpec> sensors,
                           const std::string& source) {
  const auto poses =
      std::ranges::find_if(sensors, [](const SensorSpec& spec) { return spec.kind == "pose"; });
  if (poses != sensors.end()) {
    poses_ = *poses;
    const JsonDocument metadata(poses->metadata_json.empty() ? "{}" : poses->metadata_json,
                                {fmt::format("{}: {}: metadata", source, poses->name), 0});
    nodes_ = names_of(metadata.root(), "nodes");
    for (const std::string& node : nodes_)
      node_numbers_.emplace(node, static_cast<uint32_t>(node_numbers_.size()));
    if (node_numbers_.size() != nodes_.size()) metadata.root().at("nodes").fail("names that differ");
  }
  read_run(run_json, source);
  for (const SensorSpec& spec : sensors) {
    sensor_numbers_.emplace(spec.name, sensors_.size());
    sensors_.push_back(read_sensor(spec, source));
  }
}

void RecordTables::read_run(const std::string& run_json, const std::string& source) {
  const JsonDocument document(run_json.empty() ? "{}" : run_json, {source + ": run", 0});
  const JsonValue run = document.root();
  materials_ = names_of(run, "materials");
  classes_ = names_of(run, "semantic_classes");
  if (run.has("effects") && run.at("effects").has("lidar_sweep_motion"))
    sweep_motion_ = run.at("effects").at("lidar_sweep_motion").boolean();
  if (!run.has("instances")) return;
  for (const JsonValue& json : run.at("instances").list(most_instances)) {
    InstanceFacts& instance = instances_.emplace_back();
    instance.name = json.at("name").text();
    if (json.has("class")) instance.semantic_class = json.at("class").text();
    if (json.has("node")) {
      instance.node = node_called(json.at("node").text());
      if (!instance.node) json.at("node").fail("one of the nodes of the poses");
    }
    if (!json.has("box_m")) continue;
    const std::vector<JsonValue> corners = json.at("box_m").tuple(2);
    instance.low = vector_of(corners[0]);
    instance.high = vector_of(corners[1]);
    for (int axis = 0; axis < 3; ++axis)
      if (instance.low[axis] > instance.high[axis]) json.at("box_m").fail("the lower corner first");
    instance.has_box = true;
  }
}

SensorFacts RecordTables::read_sensor(const SensorSpec& spec, const std::string& source) const {
  const JsonDocument metadata(spec.metadata_json.empty() ? "{}" : spec.metadata_json,
                              {fmt::format("{}: {}: metadata", source, spec.name), 0});
  const JsonValue json = metadata.root();
  const auto place_of = [&](std::string name, const JsonValue& at, const char* mount) {
    Place place;
    if (at.has(mount)) place.mount = pose_of_json(at.at(mount));
    // What is not named "node/sensor" rests in the world.
    const bool on_node = name.find('/') != std::string::npos;
    if (on_node) place.node = node_called(node_part(name));
    place.known = place.node.has_value() || !on_node;
    place.name = std::move(name);
    return place;
  };
  SensorFacts facts;
  facts.kind = spec.kind;
  facts.place = place_of(spec.name, json, "body_from_sensor");
  facts.place.known = facts.place.node.has_value();
  if ((spec.kind == "camera" || spec.kind == "event_camera") && json.has("width"))
    facts.camera = camera_facts(json);
  if (spec.kind == "radar") {
    facts.radar = radar_facts(json);
    if (json.has("illuminator"))
      facts.radar->illuminator = place_of(json.at("illuminator").text(), json, "body_from_illuminator");
  }
  if (spec.kind != "csi" || !json.has("carrier_hz")) return facts;
  ChannelFacts& channel = facts.channel.emplace();
  channel.carrier_hz = json.at("carrier_hz").number(1.0, 1e15);
  PatternTables tables(json);
  for (const bool transmits : {true, false}) {
    const char* const key = transmits ? "transmitters" : "receivers";
    if (!json.has(key)) continue;
    for (const JsonValue& end : json.at(key).list(most_ends)) {
      AntennaFacts antenna = antenna_of(end, tables);
      antenna.place = place_of(end.at("name").text(), end, "body_from_antenna");
      (transmits ? channel.transmitters : channel.receivers).push_back(std::move(antenna));
    }
  }
  return facts;
}

std::optional<uint32_t> RecordTables::node_called(std::string_view name) const {
  const auto found = node_numbers_.find(name);
  return found == node_numbers_.end() ? std::nullopt : std::optional(found->second);
}

std::string RecordTables::instance_name(uint32_t id) const {
  if (id == 0) return "nothing";
  return id <= instances_.size() ? printable(instances_[id - 1].name) : fmt::format("instance {}", id);
}

std::string RecordTables::material_name(uint32_t id) const { return name_in(materials_, id, "material"); }

std::string RecordTables::class_name(uint32_t semantic) const {
  return semantic < classes_.size() ? printable(classes_[semantic]) : fmt::format("class {}", semantic);
}

uint32_t RecordTables::class_number(std::string_view name) const {
  const auto found = std::ranges::find(classes_, name);
  return found == classes_.end() ? 0 : static_cast<uint32_t>(found - classes_.begin());
}

const SensorFacts& RecordTables::facts(const SensorSpec& spec) const {
  const auto found = sensor_numbers_.find(spec.name);
  if (found == sensor_numbers_.end()) throw_user_error("{}: expected a sensor of the run", spec.name);
  return sensors_[found->second];
}

NodePoses::NodePoses(const RecordTables& tables, const Record& poses)
    : tick_(poses.tick), time_ns_(poses.time_ns) {
  const SensorSpec* const spec = tables.pose_sensor();
  if (spec == nullptr) throw_user_error("expected a sensor of kind 'pose', found none");
  const RecordArrays arrays(*spec, poses);
  const auto nodes = static_cast<int64_t>(tables.nodes().size());
  const std::span<const double> position = arrays.finite<double>("position", {nodes, 3}),
                                orientation = arrays.finite<double>("orientation", {nodes, 4});
  const auto optional = [&](const char* name) {
    return arrays.has(name) ? arrays.finite<double>(name, {nodes, 3}) : std::span<const double>();
  };
  const std::span<const double> velocity = optional("velocity"), acceleration = optional("acceleration"),
                                angular_velocity = optional("angular_velocity");
  const auto vector = [](std::span<const double> values, size_t node) {
    return values.empty() ? dvec3(0.0) : dvec3(values[3 * node], values[3 * node + 1], values[3 * node + 2]);
  };
  motions_.resize(tables.nodes().size());
  for (size_t i = 0; i < motions_.size(); ++i) {
    const std::span<const double> q = orientation.subspan(4 * i, 4);
    const dquat turn(q[0], q[1], q[2], q[3]);
    if (const double length = glm::length(turn); !(std::abs(length - 1.0) < 0.01))
      arrays.fail("orientation", "unit quaternions", fmt::format("one of length {:g} in row {}", length, i));
    motions_[i] = {{vector(position, i), glm::normalize(turn)},
                   vector(velocity, i),
                   vector(acceleration, i),
                   vector(angular_velocity, i)};
  }
}

Pose NodePoses::after(uint32_t node, double dt_s) const {
  const Motion& motion = motions_.at(node);
  Pose pose = motion.pose;
  if (dt_s == 0.0) return pose;
  pose.position += dt_s * (motion.velocity + 0.5 * dt_s * motion.acceleration);
  const double rate = glm::length(motion.angular_velocity);
  if (rate > 0.0)
    pose.orientation =
        glm::normalize(glm::angleAxis(rate * dt_s, motion.angular_velocity / rate) * pose.orientation);
  return pose;
}

std::optional<Pose> NodePoses::world_from(const Place& place, double dt_s) const {
  if (!place.known) return std::nullopt;
  return place.node ? after(*place.node, dt_s) * place.mount : place.mount;
}

Pose pose_of(const RecordTables& tables, std::string_view node, const Record& poses) {
  const std::optional<uint32_t> number = tables.node_called(node);
  if (!number) throw_user_error("expected a node of the poses, found '{}'", node);
  return NodePoses(tables, poses).pose(*number);
}

}  // namespace greatx::view
