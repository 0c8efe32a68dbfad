// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The overlays of the main view: which are on, and the shapes that they make of the tick that is shown.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/dataset/dataset_format.h"
#include "view/overlay/box_shapes.h"
#include "view/overlay/path_shapes.h"
#include "view/overlay/path_story.h"
#include "view/overlay/picture_shapes.h"
#include "view/overlay/record_tables.h"
#include "view/overlay/sensing_shapes.h"
#include "view/overlay/sensor_shapes.h"
#include "view/overlay/trajectory_shapes.h"
#include "view/run/run.h"

namespace greatx::view {

/// The switches and settings of all overlays.
struct OverlaySettings {
  bool paths = true, lidar = false, radar = true, boxes = false, trajectories = true, sensors = true;
  bool events = false;  ///< over the picture of an event camera
  PathOptions path;
  LidarOptions cloud;
  RadarOptions detections;
  TrajectoryOptions trajectory;
  SensorOptions sensor;
  BoxOptions box;
  BoxRectangle rectangle = BoxRectangle::visible;
  EventOptions event;
  std::string camera;  ///< "node/sensor" that one looks through; empty: none
  /// Of the channel whose paths are drawn: its place among the sensors of kind csi.
  size_t channel = 0;
  /// Changes whenever a setting changes; whoever changes one counts it up.
  uint64_t version = 0;
};

class Overlays {
 public:
  /// Throws UserError if the run's description is damaged.
  explicit Overlays(std::shared_ptr<const io::DatasetInfo> info);

  OverlaySettings& settings() { return settings_; }
  const RecordTables& tables() const { return tables_; }
  /// Returns the shapes of `tick`. They are made again only if the tick or the settings have changed.
  const Shapes& shapes(const std::shared_ptr<const ShownTick>& tick);
  /// Returns the shapes made last.
  const Shapes& shapes() const { return shapes_; }
  /// Counts how often shapes() has made them again.
  uint64_t made() const { return made_; }
  /// The path of the chosen channel with this identity of its row; none if the tick has no such path. Throws
  /// UserError if its record is damaged.
  std::optional<PathStory> story(const ShownTick& tick, uint64_t row_id) const;
  /// The row of the `rank`-th path of the chosen channel, 1 being the strongest; 0: there are fewer.
  uint64_t path_of_rank(const std::shared_ptr<const ShownTick>& tick, size_t rank);
  /// Looks through a camera from now on; empty: through none.
  void look_through(const std::string& camera);
  /// The message of an overlay that could not be made; empty if all could.
  const std::string& error() const { return error_; }
  /// Wall time of the last making, ms.
  double milliseconds() const { return milliseconds_; }
  /// Indices of the sensors of a kind.
  std::vector<size_t> sensors_of(std::string_view kind) const;

 private:
  void make(const ShownTick& tick);
  void add_sensors(const ShownTick& tick, const NodePoses* poses);
  void add_boxes(const ShownTick& tick, const NodePoses* poses);
  void add_picture(const ShownTick& tick);
  const Record* newest(const ShownTick& tick, size_t sensor) const;

  std::shared_ptr<const io::DatasetInfo> info_;
  RecordTables tables_;
  PoseHistory history_;
  OverlaySettings settings_;
  Shapes shapes_;
  std::shared_ptr<const ShownTick> made_of_;
  uint64_t made_version_ = ~uint64_t{0}, made_ = 0;
  std::string error_;
  double milliseconds_ = 0.0;
};

}  // namespace greatx::view
