// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that the modalities see one world, from arrays and metadata alone, as they are written. A run and
// its files therefore give the same figures.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/record.h"
#include "sim/compare/error_statistics.h"
#include "sim/world/instance_boxes.h"

namespace greatx::sim {

/// The names of the figures in summaries and files.
inline constexpr const char* depth_figure = "depth_vs_ray";
inline constexpr const char* lidar_figure = "lidar_vs_depth";
inline constexpr const char* depth_box_figure = "depth_vs_box";
inline constexpr const char* lidar_box_figure = "lidar_vs_box";
inline constexpr const char* sight_figure = "line_of_sight_delay_vs_distance";
inline constexpr const char* radar_figure = "radar_range_vs_box";
inline constexpr const char* sensing_figure = "sensing_range_vs_box";

/// Holds the comparison of one record with another record of its tick.
struct ConsistencyRow {
  std::string figure;
  uint32_t sequence = 0;
  int64_t tick = 0;
  std::string sensor;  ///< the sensor of the record
  std::string other;   ///< the sensor of the other record
  uint64_t compared = 0;
  double largest = 0.0;  ///< relative error
};

/// Gives access to a record: the declaration of its sensor, and its arrays by name (ContractError if there is
/// no array of that name).
struct RecordView {
  const SensorSpec& spec;
  std::function<Array(const std::string& name)> array;
};
/// Returns a view of a record of a run. Spec and record outlive the view.
RecordView view_of(const SensorSpec& spec, const Record& record);

/// Compares the returns of a LiDAR (all shots at the tick) with the depth picture of a pinhole camera on the
/// same node, by lidar_against_depth().
ErrorStatistics compare_lidar(const RecordView& lidar, const RecordView& camera);

/// Compares c times the delay of each direct path with the distance of its ends, which follows from the poses
/// of the nodes.
ErrorStatistics compare_sights(const RecordView& channel, const RecordView& poses);

/// Compares the ranges of a radar with the boxes of instances. For each instance in the frame it takes the
/// strongest detection, and computes by how much its range lies outside the ranges of the instance's box,
/// relative to the range. Everything stands where the poses, velocities, accelerations and angular velocities
/// of the tick take it by the middle of the frame. The ranges of a box reach from half the path over its
/// nearest point to half the path over its farthest corner. Ranges that differ by the radar's unambiguous
/// span are taken as equal. The figure is therefore as accurate as the extent of a target, and as half a bin
/// where noise and neighbours allow. An instance that is seen only by a reflection is farther away than its
/// box.
ErrorStatistics compare_radar(const RecordView& radar, const RecordView& poses,
                              std::span<const InstanceBox> boxes);

/// Compares the depth picture of a pinhole camera with the boxes of instances. The point that each pixel of
/// an instance on a node sees lies within the instance's box at the tick, up to rounding. The error is the
/// distance from the point to the box, relative to the distance from the camera.
ErrorStatistics compare_depth_boxes(const RecordView& camera, const RecordView& poses,
                                    std::span<const InstanceBox> boxes);

/// The same for the returns of a LiDAR (all shots at the tick). The distance is less by the rounding of the
/// coordinates, and by RangeNoise::bound_m.
ErrorStatistics compare_lidar_boxes(const RecordView& lidar, const RecordView& poses,
                                    std::span<const InstanceBox> boxes);

/// The same as compare_radar() for the detections of each link of a channel that senses, whose ranges are
/// those at the tick.
ErrorStatistics compare_sensing(const RecordView& channel, const RecordView& poses,
                                std::span<const InstanceBox> boxes);

}  // namespace greatx::sim
