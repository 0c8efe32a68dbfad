// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/compare/record_consistency.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include "core/units.h"
#include "sim/compare/consistency.h"

namespace greatx::sim {

namespace {

using Json = nlohmann::json;

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

/// Returns an array. Throws UserError unless it has the given type and number of elements, since records may
/// come from files.
Array expect_array(const RecordView& record, const char* name, DType dtype, size_t elements) {
  Array array = record.array(name);
  if (array.dtype != dtype || array.element_count() != static_cast<int64_t>(elements))
    throw_user_error("{}: {}: expected {} elements {}, found {} of {}", record.spec.name, name, elements,
                     numpy_name(dtype), array.element_count(), numpy_name(array.dtype));
  return array;
}

std::string node_of(const std::string& sensor) { return sensor.substr(0, sensor.find('/')); }

/// Holds the poses of the nodes at a tick, and extrapolates them.
class Nodes {
 public:
  explicit Nodes(const RecordView& poses) {
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
  const Pose& at_tick(const std::string& node) const { return motions_.at(numbers_.at(node)).pose; }
  /// Extrapolates by `dt_s` with the velocities, accelerations and angular velocities of the tick.
  Pose after(uint32_t node, double dt_s) const {
    const Motion& m = motions_.at(node);
    Pose pose = m.pose;
    pose.position += dt_s * (m.velocity + 0.5 * dt_s * m.acceleration);
    const double rate = glm::length(m.angular_velocity);
    if (rate > 0.0)
      pose.orientation =
          glm::normalize(glm::angleAxis(rate * dt_s, m.angular_velocity / rate) * pose.orientation);
    return pose;
  }
  Pose after(const std::string& node, double dt_s) const { return after(numbers_.at(node), dt_s); }

 private:
  std::map<std::string, uint32_t> numbers_;
  std::vector<Motion> motions_;
};

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

render::CameraImages images_of(const RecordView& camera, const render::CameraDesc& desc) {
  render::CameraImages images;
  images.width = desc.width;
  images.height = desc.height;
  const size_t pixels = size_t{desc.width} * desc.height;
  const Array depth = expect_array(camera, "depth", DType::f32, pixels);
  images.depth.assign(depth.as<float>().begin(), depth.as<float>().end());
  if (!has(camera.spec, "instance")) return images;
  const Array instance = camera.array("instance"),
              material = expect_array(camera, "material", DType::u16, pixels);
  if (instance.element_count() != static_cast<int64_t>(pixels))
    throw_user_error("{}: instance: expected {} pixels, found {}", camera.spec.name, pixels,
                     instance.element_count());
  if (instance.dtype == DType::u16)
    images.instance.assign(instance.as<uint16_t>().begin(), instance.as<uint16_t>().end());
  else
    images.instance.assign(instance.as<uint32_t>().begin(), instance.as<uint32_t>().end());
  images.material.assign(material.as<uint16_t>().begin(), material.as<uint16_t>().end());
  return images;
}

struct Span {
  double near_m = 0.0, far_m = 0.0;
};

/// Returns the least and greatest distance from a point to a box.
Span distances(const dvec3& point, const scene::Bounds& box) {
  const dvec3 nearest = glm::clamp(point, box.min, box.max);
  const dvec3 farthest = glm::max(glm::abs(point - box.min), glm::abs(point - box.max));
  return {glm::distance(point, nearest), glm::length(farthest)};
}

/// Returns the least and greatest half path from the transmitter over a box to the receiver.
Span ranges(const dvec3& transmitter, const dvec3& receiver, const Pose& box_pose, const scene::Bounds& box) {
  const Pose back = box_pose.inverse();
  const Span out = distances(back.apply(transmitter), box), home = distances(back.apply(receiver), box);
  return {0.5 * (out.near_m + home.near_m), 0.5 * (out.far_m + home.far_m)};
}

/// Returns how far a range, known up to multiples of `ambiguity_m`, lies outside a span, relative to the
/// range.
double outside(double range_m, const Span& span, double ambiguity_m, double bin_m) {
  const auto gap = [&](double turns) {
    const double range = range_m + turns * ambiguity_m;
    return std::max({0.0, span.near_m - range, range - span.far_m}) / std::max(range, bin_m);
  };
  const double turns = std::max(0.0, std::ceil((span.near_m - range_m) / ambiguity_m));
  return turns > 0.0 ? std::min(gap(turns - 1.0), gap(turns)) : gap(0.0);
}

/// Returns the strongest detection of each instance with a box, among those of one link.
std::map<uint32_t, size_t> strongest_of(std::span<const uint32_t> instances, std::span<const float> powers,
                                        std::span<const uint32_t> links, uint32_t link,
                                        std::span<const InstanceBox> boxes) {
  std::map<uint32_t, size_t> strongest;
  for (size_t i = 0; i < instances.size(); ++i) {
    const uint32_t id = instances[i];
    if (links[i] != link || id == 0 || id > boxes.size() || boxes[id - 1].box.empty()) continue;
    const auto [at, fresh] = strongest.emplace(id, i);
    if (!fresh && powers[i] > powers[at->second]) at->second = i;
  }
  return strongest;
}

}  // namespace

RecordView view_of(const SensorSpec& spec, const Record& record) {
  return {spec, [&spec, &record](const std::string& name) {
            const auto found = std::ranges::find(spec.arrays, name, &ArraySpec::name);
            GREATX_CHECK(found != spec.arrays.end(), "{} has no array {}", spec.name, name);
            return record.arrays[static_cast<size_t>(found - spec.arrays.begin())];
          }};
}

ErrorStatistics compare_lidar(const RecordView& lidar, const RecordView& camera) {
  const Json about = metadata_of(camera);
  const render::CameraDesc desc = camera_of(about);
  const render::CameraImages images = images_of(camera, desc);
  const Json about_lidar = metadata_of(lidar);
  const Pose camera_from_lidar =
      pose_of(about.at("body_from_sensor")).inverse() * pose_of(about_lidar.at("body_from_sensor"));
  const Array instance = lidar.array("instance");
  const auto returns = static_cast<size_t>(instance.element_count());
  const Array points = expect_array(lidar, "points", DType::f32, 4 * returns),
              material = expect_array(lidar, "material", DType::u32, returns);
  const Json receiver = about_lidar.value("receiver", Json::object());
  const RangeNoise noise{receiver.value("range_std_m", 0.0), receiver.value("rise_m", 0.0),
                         receiver.value("noise_equivalent_power", 0.0)};
  Array power;
  if (noise.std_m > 0.0 || noise.rise_m > 0.0) power = expect_array(lidar, "power", DType::f32, returns);
  return lidar_against_depth(desc, images, camera_from_lidar, points.as<float>(), instance.as<uint32_t>(),
                             material.as<uint32_t>(), about_lidar.value("point_error_m", 0.0), noise,
                             power.bytes.empty() ? std::span<const float>() : power.as<float>());
}

ErrorStatistics compare_sights(const RecordView& channel, const RecordView& poses) {
  const Json about = metadata_of(channel);
  const Nodes nodes(poses);
  const auto place = [&](const char* ends, uint32_t number) {
    const Json& end = about.at(ends).at(number);
    return nodes.at_tick(node_of(end.at("name"))).apply(pose_of(end.at("body_from_antenna")).position);
  };
  const Array delay = channel.array("delay"), interaction = channel.array("interaction"),
              rx = channel.array("rx"), tx = channel.array("tx");
  const std::span<const double> delays = delay.as<double>();
  const size_t depth = delays.empty() ? 0 : static_cast<size_t>(interaction.element_count()) / delays.size();
  for (const Array* array : {&interaction, &rx, &tx})
    if (array->shape.empty() || array->shape[0] != std::ssize(delays) ||
        (!delays.empty() && array->element_count() == 0))
      throw_user_error("{}: expected arrays of {} paths, found one of {}", channel.spec.name, delays.size(),
                       array->element_count());
  const auto number = [](const Array& array, size_t i) {
    uint64_t value = 0;
    std::copy_n(&array.bytes[i * size_of(array.dtype)], size_of(array.dtype),
                reinterpret_cast<std::byte*>(&value));
    return value;  // the arrays are unsigned and little-endian
  };
  ErrorStatistics errors;
  for (size_t i = 0; i < delays.size(); ++i) {
    if (number(interaction, i * depth) != 0) continue;
    const double distance_m = glm::distance(place("transmitters", static_cast<uint32_t>(number(tx, i))),
                                            place("receivers", static_cast<uint32_t>(number(rx, i))));
    errors.add(std::abs(speed_of_light * delays[i] - distance_m) / distance_m);
  }
  return errors;
}

ErrorStatistics compare_radar(const RecordView& radar, const RecordView& poses,
                              std::span<const InstanceBox> boxes) {
  const Json about = metadata_of(radar);
  const Nodes nodes(poses);
  const double middle_s = about.at("frame_middle_s");
  const dvec3 receiver =
      nodes.after(node_of(radar.spec.name), middle_s).apply(pose_of(about.at("body_from_sensor")).position);
  dvec3 transmitter = receiver;
  if (about.at("bistatic").get<bool>())
    transmitter = nodes.after(node_of(about.at("illuminator")), middle_s)
                      .apply(pose_of(about.at("body_from_illuminator")).position);
  const Array instance = radar.array("instance");
  const auto detections = static_cast<size_t>(instance.element_count());
  const Array range = expect_array(radar, "range", DType::f32, detections),
              power = expect_array(radar, "power", DType::f32, detections);
  const std::vector<uint32_t> everything(detections, 0);
  const std::map<uint32_t, size_t> strongest =
      strongest_of(instance.as<uint32_t>(), power.as<float>(), everything, 0, boxes);
  ErrorStatistics errors;
  for (const auto& [id, i] : strongest) {
    const InstanceBox& box = boxes[id - 1];
    const Pose pose = box.node ? nodes.after(*box.node, middle_s) : Pose();
    errors.add(outside(range.as<float>()[i], ranges(transmitter, receiver, pose, box.box),
                       about.at("range_span_m"), about.at("range_bin_m")));
  }
  return errors;
}

ErrorStatistics compare_sensing(const RecordView& channel, const RecordView& poses,
                                std::span<const InstanceBox> boxes) {
  const Json about = metadata_of(channel);
  const Json& sensing = about.at("sensing");
  const Nodes nodes(poses);
  const auto place = [&](const char* ends, size_t number) {
    const Json& end = about.at(ends).at(number);
    return nodes.at_tick(node_of(end.at("name"))).apply(pose_of(end.at("body_from_antenna")).position);
  };
  const Array instance = channel.array("detection_instance");
  const auto detections = static_cast<size_t>(instance.element_count());
  const Array range = expect_array(channel, "detection_range", DType::f32, detections),
              power = expect_array(channel, "detection_power", DType::f32, detections),
              rx = expect_array(channel, "detection_rx", DType::i32, detections),
              tx = expect_array(channel, "detection_tx", DType::i32, detections);
  const size_t receivers = about.at("receivers").size(), transmitters = about.at("transmitters").size();
  std::vector<uint32_t> links;
  for (size_t i = 0; i < detections; ++i) {
    const auto r = static_cast<uint32_t>(rx.as<int32_t>()[i]), t = static_cast<uint32_t>(tx.as<int32_t>()[i]);
    if (r >= receivers || t >= transmitters)
      throw_user_error("{}: detection {}: expected one of {} x {} links, found ({}, {})", channel.spec.name,
                       i, receivers, transmitters, r, t);
    links.push_back(r * static_cast<uint32_t>(transmitters) + t);
  }
  ErrorStatistics errors;
  for (uint32_t link = 0; link < receivers * transmitters; ++link)
    for (const auto& [id, i] : strongest_of(instance.as<uint32_t>(), power.as<float>(), links, link, boxes)) {
      const InstanceBox& box = boxes[id - 1];
      const Pose pose = box.node ? nodes.after(*box.node, 0.0) : Pose();
      errors.add(outside(range.as<float>()[i],
                         ranges(place("transmitters", link % transmitters),
                                place("receivers", link / transmitters), pose, box.box),
                         sensing.at("range_span_m"), sensing.at("range_bin_m")));
    }
  return errors;
}

}  // namespace greatx::sim
