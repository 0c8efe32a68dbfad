// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads records by the declarations and metadata of their sensors. The records may come from files, so what
// they hold is checked.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/vec.h"
#include "renderer/camera/camera.h"
#include "sim/compare/evidence.h"
#include "sim/compare/record_consistency.h"

namespace greatx::sim {

using Json = nlohmann::json;

Json metadata_of(const RecordView& record);
/// Returns the pose of an object with `position_m` and `orientation_wxyz`.
Pose pose_of(const Json& json);
bool has(const SensorSpec& spec, const std::string& name);
/// Returns an array. Throws UserError unless it has the given type and number of elements.
Array expect_array(const RecordView& record, const char* name, DType dtype, size_t elements);
/// Returns the ids of an array of u16 or u32, as u32. Throws UserError unless it has so many elements.
std::vector<uint32_t> expect_ids(const RecordView& record, const char* name, size_t elements);
/// Returns the node of a sensor's name, "node/sensor".
std::string node_of(const std::string& sensor);
/// Returns size, focal lengths, principal point and near plane of a pinhole camera, from its metadata.
render::CameraDesc camera_of(const Json& json);

/// Holds the returns of a LiDAR.
struct ReturnsRecord {
  Array points, instance, powers;
  double error_m = 0.0;  ///< largest distance between a point and its rounded coordinates
  RangeNoise noise;      ///< along the beams
  std::span<const float> xyzi() const { return points.as<float>(); }  ///< [4 n] in the LiDAR's frame
  std::span<const uint32_t> instances() const { return instance.as<uint32_t>(); }
  /// [n]; empty if there is no noise.
  std::span<const float> power() const {
    return powers.bytes.empty() ? std::span<const float>() : powers.as<float>();
  }
};
ReturnsRecord read_returns(const RecordView& lidar);

/// Holds the poses of the nodes at a tick, and extrapolates them.
class Nodes {
 public:
  explicit Nodes(const RecordView& poses);
  const Pose& at_tick(const std::string& node) const { return motions_.at(numbers_.at(node)).pose; }
  const Pose& at_tick(uint32_t node) const { return motions_.at(node).pose; }
  /// Extrapolates by `dt_s` with the velocities, accelerations and angular velocities of the tick.
  Pose after(uint32_t node, double dt_s) const;
  Pose after(const std::string& node, double dt_s) const { return after(numbers_.at(node), dt_s); }

 private:
  std::map<std::string, uint32_t> numbers_;
  std::vector<Motion> motions_;
};

}  // namespace greatx::sim
