// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/compare/record_reading.h"

#include <algorithm>
#include <cmath>

namespace greatx::sim {

RecordView view_of(const SensorSpec& spec, const Record& record) {
  return {spec, [&spec, &record](const std::string& name) {
            const auto found = std::ranges::find(spec.arrays, name, &ArraySpec::name);
            GREATX_CHECK(found != spec.arrays.end(), "{} has no array {}", spec.name, name);
            return record.arrays[static_cast<size_t>(found - spec.arrays.begin())];
          }};
}

Json metadata_of(const RecordView& record) { return Json::parse(record.spec.metadata_json); }

Pose pose_of(const Json& json) {
  const Json &p = json.at("position_m"), &q = json.at("orientation_wxyz");
  const auto number = [](const Json& list, size_t i) { return list.at(i).get<double>(); };
  return {{number(p, 0), number(p, 1), number(p, 2)},
          {number(q, 0), number(q, 1), number(q, 2), number(q, 3)}};
}

bool has(const SensorSpec& spec, const std::string& name) {
  return std::ranges::any_of(spec.arrays, [&](const ArraySpec& array) { return array.name == name; });
}

Array expect_array(const RecordView& record, const char* name, DType dtype, size_t elements) {
  Array array = record.array(name);
  if (array.dtype != dtype || array.element_count() != static_cast<int64_t>(elements))
    throw_user_error("{}: {}: expected {} elements {}, found {} of {}", record.spec.name, name, elements,
                     numpy_name(dtype), array.element_count(), numpy_name(array.dtype));
  return array;
}

std::vector<uint32_t> expect_ids(const RecordView& record, const char* name, size_t elements) {
  const Array array = record.array(name);
  if (array.element_count() != static_cast<int64_t>(elements))
    throw_user_error("{}: {}: expected {} elements, found {}", record.spec.name, name, elements,
                     array.element_count());
  if (array.dtype == DType::u16) return {array.as<uint16_t>().begin(), array.as<uint16_t>().end()};
  return {array.as<uint32_t>().begin(), array.as<uint32_t>().end()};
}

std::string node_of(const std::string& sensor) { return sensor.substr(0, sensor.find('/')); }

ReturnsRecord read_returns(const RecordView& lidar) {
  const Json about = metadata_of(lidar);
  ReturnsRecord returns;
  returns.instance = lidar.array("instance");
  const auto count = static_cast<size_t>(returns.instance.element_count());
  returns.points = expect_array(lidar, "points", DType::f32, 4 * count);
  returns.error_m = about.value("point_error_m", 0.0);
  const Json receiver = about.value("receiver", Json::object());
  returns.noise = {receiver.value("range_std_m", 0.0), receiver.value("rise_m", 0.0),
                   receiver.value("noise_equivalent_power", 0.0)};
  if (returns.noise.std_m > 0.0 || returns.noise.rise_m > 0.0)
    returns.powers = expect_array(lidar, "power", DType::f32, count);
  return returns;
}

Nodes::Nodes(const RecordView& poses) {
  const Json nodes = metadata_of(poses).at("nodes");
  const auto of_nodes = [&](const char* name, size_t parts) {
    return expect_array(poses, name, DType::f64, parts * nodes.size());
  };
  const Array position = of_nodes("position", 3), orientation = of_nodes("orientation", 4),
              velocity = of_nodes("velocity", 3), acceleration = of_nodes("acceleration", 3),
              angular_velocity = of_nodes("angular_velocity", 3);
  const auto vector = [](const Array& array, size_t node) {
    const std::span<const double> v = array.as<double>().subspan(3 * node, 3);
    return dvec3(v[0], v[1], v[2]);
  };
  for (size_t i = 0; i < nodes.size(); ++i) {
    const std::span<const double> q = orientation.as<double>().subspan(4 * i, 4);
    numbers_[nodes.at(i).get<std::string>()] = static_cast<uint32_t>(i);
    motions_.push_back({{vector(position, i), dquat(q[0], q[1], q[2], q[3])},
                        vector(velocity, i),
                        vector(acceleration, i),
                        vector(angular_velocity, i)});
  }
}

Pose Nodes::after(uint32_t node, double dt_s) const {
  const Motion& m = motions_.at(node);
  Pose pose = m.pose;
  pose.position += dt_s * (m.velocity + 0.5 * dt_s * m.acceleration);
  const double rate = glm::length(m.angular_velocity);
  if (rate > 0.0)
    pose.orientation =
        glm::normalize(glm::angleAxis(rate * dt_s, m.angular_velocity / rate) * pose.orientation);
  return pose;
}

render::CameraDesc camera_of(const Json& json) {
  render::CameraDesc desc;
  desc.width = json.at("width");
  desc.height = json.at("height");
  desc.fx = json.at("fx");
  desc.fy = json.at("fy");
  desc.cx = json.at("cx");
  desc.cy = json.at("cy");
  desc.near_m = json.at("near_m");
  return desc;
}

}  // namespace greatx::sim
