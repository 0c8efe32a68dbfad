// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Do the modalities see one world? From arrays and metadata alone, as they are written: a run and the files
// that it left give the same figures.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/record.h"
#include "sim/compare/error_statistics.h"
#include "sim/world/instance_boxes.h"

namespace greatx::sim {

/// Names of the figures, in summaries and files.
inline constexpr const char* depth_figure = "depth_vs_ray";
inline constexpr const char* lidar_figure = "lidar_vs_depth";
inline constexpr const char* sight_figure = "line_of_sight_delay_vs_distance";
inline constexpr const char* radar_figure = "radar_range_vs_box";

/// What one record says against another one of its tick.
struct ConsistencyRow {
  std::string figure;
  uint32_t sequence = 0;
  int64_t tick = 0;
  std::string sensor;  ///< whose record it is
  std::string other;   ///< the sensor that it is held against
  uint64_t compared = 0;
  double largest = 0.0;  ///< relative error
};

/// A record: what its sensor declares, and its arrays by name (ContractError if it has none of that name).
struct RecordView {
  const SensorSpec& spec;
  std::function<Array(const std::string& name)> array;
};
/// A record of a run. Spec and record outlive the view.
RecordView view_of(const SensorSpec& spec, const Record& record);

/// Returns of a LiDAR (all shots at the tick) against the depth picture of a pinhole camera on the same node:
/// lidar_against_depth() for each.
ErrorStatistics compare_lidar(const RecordView& lidar, const RecordView& camera);

/// c times the delay of each direct path against the distance of its ends, by the nodes' poses.
ErrorStatistics compare_sights(const RecordView& channel, const RecordView& poses);

/// Of each instance that a radar's frame names, the strongest detection: how far its range lies outside those
/// of the instance's box, over the range. Everything stands where the tick's poses, velocities, accelerations
/// and angular velocities take it to by the frame's middle. Half the way over the box lies between what its
/// nearest point and its farthest corner make of it; ranges that differ by the radar's span are one. So a
/// point target is compared to its extent, and to half a bin where noise and neighbours allow; an instance
/// seen by a reflection alone is farther than its box.
ErrorStatistics compare_radar(const RecordView& radar, const RecordView& poses,
                              std::span<const InstanceBox> boxes);

}  // namespace greatx::sim
