// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

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
      if (boxes[i].node && !boxes[i].box.empty())
        box_from_sensor_[i] = nodes.at_tick(*boxes[i].node).inverse() * from_sensor;
  }
  /// Returns whether a node carries the instance.
  bool holds(uint32_t instance) const {
    return instance != 0 && instance <= boxes_.size() && box_from_sensor_[instance - 1];
  }
  /// Returns the distance from a point in the sensor's frame to the box of an instance that it holds.
  double distance(uint32_t instance, const dvec3& point) const {
    const dvec3 p = box_from_sensor_[instance - 1]->apply(point);
    const scene::Bounds& box = boxes_[instance - 1].box;
    return glm::distance(p, glm::clamp(p, box.min, box.max));
  }

 private:
  std::span<const InstanceBox> boxes_;
  std::vector<std::optional<Pose>> box_from_sensor_;  ///< [instances]
};

}  // namespace

ErrorStatistics compare_depth_boxes(const RecordView& camera, const RecordView& poses,
                                    std::span<const InstanceBox> boxes) {
  const render::CameraDesc desc = camera_of(metadata_of(camera));
  const size_t pixels = size_t{desc.width} * desc.height;
  const std::vector<uint32_t> instances = expect_ids(camera, "instance", pixels);
  const Array depth = expect_array(camera, "depth", DType::f32, pixels);
  const SeenBoxes seen(camera, poses, boxes);
  ErrorStatistics errors;
  for (size_t i = 0; i < pixels; ++i) {
    const auto z = static_cast<double>(depth.as<float>()[i]);
    if (!seen.holds(instances[i]) || !std::isfinite(z)) continue;
    const auto column = static_cast<double>(i % desc.width), row = static_cast<double>(i / desc.width);
    const dvec3 point = z * pixel_ray(desc, column + 0.5, row + 0.5);
    errors.add(seen.distance(instances[i], point) / glm::length(point));
  }
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
