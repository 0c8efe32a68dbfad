// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/compare/consistency.h"
#include "sim/compare/record_reading.h"

namespace greatx::sim {

namespace {

/// Holds the boxes of the instances that nodes carry, as a sensor sees them at a tick.
class SeenBoxes {
 public:
  SeenBoxes(const RecordView& sensor, const RecordView& poses, std::span<const InstanceBox> boxes)
      : boxes_(boxes), box_from_sensor_(boxes.size()) {
    const Nodes nodes(poses);
    const Pose from_sensor =
        nodes.at_tick(node_of(sensor.spec.name)) * pose_of(metadata_of(sensor).at("body_from_sensor"));
    for (size_t i = 0; i < boxes.size(); ++i)
      if (boxes[i].node && !boxes[i].box.empty()) {
        box_from_sensor_[i] = nodes.at_tick(*boxes[i].node).inverse() * from_sensor;
        first_ = std::min(first_, static_cast<uint32_t>(i + 1));
      }
  }
  /// Returns whether a node carries the instance.
  bool holds(uint32_t instance) const {
    // Most pixels see static instances, which come first.
    return instance >= first_ && instance <= boxes_.size() && box_from_sensor_[instance - 1];
  }
  /// Returns the distance from a point in the sensor's frame to the box of an instance that it holds.
  double distance(uint32_t instance, const dvec3& point) const {
    const dvec3 p = box_from_sensor_[instance - 1]->apply(point);
    const scene::Bounds& box = boxes_[instance - 1].box;
    return glm::distance(p, glm::clamp(p, box.min, box.max));
  }

 private:
  std::span<const InstanceBox> boxes_;
  std::vector<std::optional<Pose>> box_from_sensor_;       ///< [instances]
  uint32_t first_ = std::numeric_limits<uint32_t>::max();  ///< instance that a node carries
};

}  // namespace

ErrorStatistics compare_depth_boxes(const RecordView& camera, const RecordView& poses,
                                    std::span<const InstanceBox> boxes) {
  const render::CameraDesc desc = camera_of(metadata_of(camera));
  const size_t pixels = size_t{desc.width} * desc.height;
  const Array instance = camera.array("instance"), depth = expect_array(camera, "depth", DType::f32, pixels);
  const SeenBoxes seen(camera, poses, boxes);
  ErrorStatistics errors;
  const auto compare = [&](const auto& instances) {
    if (instances.size() != pixels)
      throw_user_error("{}: instance: expected {} pixels, found {}", camera.spec.name, pixels,
                       instances.size());
    for (size_t i = 0; i < pixels; ++i) {
      if (!seen.holds(instances[i])) continue;
      const auto z = static_cast<double>(depth.as<float>()[i]);
      if (!std::isfinite(z)) continue;
      const auto column = static_cast<double>(i % desc.width), row = static_cast<double>(i / desc.width);
      const dvec3 point = z * pixel_ray(desc, column + 0.5, row + 0.5);
      errors.add(seen.distance(instances[i], point) / glm::length(point));
    }
  };
  if (instance.dtype == DType::u16)
    compare(instance.as<uint16_t>());
  else
    compare(instance.as<uint32_t>());
  return errors;
}

ErrorStatistics compare_lidar_boxes(const RecordView& lidar, const RecordView& poses,
                                    std::span<const InstanceBox> boxes) {
  const ReturnsRecord returns = read_returns(lidar);
  const SeenBoxes seen(lidar, poses, boxes);
  const std::span<const uint32_t> instances = returns.instances();
  ErrorStatistics errors;
  for (size_t i = 0; i < instances.size(); ++i) {
    if (!seen.holds(instances[i])) continue;
    const float* const xyz = &returns.xyzi()[4 * i];
    const dvec3 point(xyz[0], xyz[1], xyz[2]);
    const double noise_m = returns.power().empty() ? 0.0 : returns.noise.bound_m(returns.power()[i]);
    const double outside_m = seen.distance(instances[i], point) - returns.error_m - noise_m;
    errors.add(std::max(0.0, outside_m) / glm::length(point));
  }
  return errors;
}

}  // namespace greatx::sim
