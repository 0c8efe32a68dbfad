// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/compare/record_consistency.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/units.h"
#include "sim/compare/consistency.h"
#include "sim/compare/record_reading.h"

namespace greatx::sim {

namespace {

render::CameraImages images_of(const RecordView& camera, const render::CameraDesc& desc) {
  render::CameraImages images;
  images.width = desc.width;
  images.height = desc.height;
  const size_t pixels = size_t{desc.width} * desc.height;
  const Array depth = expect_array(camera, "depth", DType::f32, pixels);
  images.depth.assign(depth.as<float>().begin(), depth.as<float>().end());
  if (!has(camera.spec, "instance")) return images;
  images.instance = expect_ids(camera, "instance", pixels);
  const Array material = expect_array(camera, "material", DType::u16, pixels);
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

ErrorStatistics compare_lidar(const RecordView& lidar, const RecordView& camera) {
  const Json about = metadata_of(camera);
  const render::CameraDesc desc = camera_of(about);
  const render::CameraImages images = images_of(camera, desc);
  const Pose camera_from_lidar =
      pose_of(about.at("body_from_sensor")).inverse() * pose_of(metadata_of(lidar).at("body_from_sensor"));
  const ReturnsRecord returns = read_returns(lidar);
  const Array material = expect_array(lidar, "material", DType::u32, returns.instances().size());
  return lidar_against_depth(desc, images, camera_from_lidar, returns.xyzi(), returns.instances(),
                             material.as<uint32_t>(), returns.error_m, returns.noise, returns.power());
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
