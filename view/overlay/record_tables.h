// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What overlays need beside records: the tables of a run (instances, materials, classes) and the metadata of
// its sensors, parsed once per run; and the poses of the nodes at a tick.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/record.h"
#include "core/vec.h"
#include "rf/antenna/antenna.h"

namespace greatx::view {

/// Where something is fixed: on a node, or, without a node, in the world.
struct Place {
  std::string name;  ///< "node/sensor", or "point 17"
  std::optional<uint32_t> node;
  Pose mount;          ///< body_from_sensor, or world_from_sensor
  bool known = false;  ///< false: the run does not say where it is
};

struct InstanceFacts {
  std::string name, semantic_class;
  std::optional<uint32_t> node;  ///< that carries it; none: it never moves
  bool has_box = false;
  dvec3 low{0.0}, high{0.0};  ///< corners of its box, m, in the frame of the node or of the world
};

/// Of a camera or an event camera; pixels.
struct CameraFacts {
  double width = 0, height = 0, fx = 1, fy = 1, cx = 0, cy = 0, near_m = 0;
  bool distorted = false;
  std::string shared_with;  ///< of an event camera that has the pixels of a camera: its name; else empty
};

struct RadarFacts {
  double azimuth_min = 0, azimuth_max = 0;  ///< rad
  double range_span_m = 0;
  double velocity_max_m_s = 0;  ///< velocities beyond it are aliases
  double range_bin_m = 0, velocity_bin_m_s = 0;
  /// Widths of a beam across the boresight, wavelength / aperture, rad; 0: the antennas do not tell
  /// directions apart there.
  double azimuth_beam = 0, elevation_beam = 0;
  double frame_middle_s = 0;         ///< after the tick: when positions hold
  std::optional<Place> illuminator;  ///< of a bistatic radar
};

struct AntennaFacts {
  Place place;
  rf::AntennaArray array;
  std::string pattern, polarization;  ///< as the metadata name them
};

struct ChannelFacts {
  double carrier_hz = 0;
  std::vector<AntennaFacts> transmitters, receivers;
};

struct SensorFacts {
  std::string kind;
  Place place;  ///< of what has a mount
  std::optional<CameraFacts> camera;
  std::optional<RadarFacts> radar;
  std::optional<ChannelFacts> channel;
};

class RecordTables {
 public:
  /// `run_json`: of io::DatasetInfo. `source` begins the messages, e.g. "out/demo/dataset.json". Throws
  /// UserError if a value is not as docs/dataset.md has it. Values that are missing are not known.
  RecordTables(const std::string& run_json, std::span<const SensorSpec> sensors, const std::string& source);

  const std::vector<std::string>& nodes() const { return nodes_; }
  const std::vector<InstanceFacts>& instances() const { return instances_; }
  const std::vector<std::string>& classes() const { return classes_; }
  std::optional<uint32_t> node_called(std::string_view name) const;
  /// Of ids as on disk (index + 1): "nothing" for 0; "instance 12" where the run has no such row. Names are
  /// printable.
  std::string instance_name(uint32_t id) const;
  std::string material_name(uint32_t id) const;
  std::string class_name(uint32_t semantic) const;
  /// The number of a class, 0 (unlabeled) if the run has no such class.
  uint32_t class_number(std::string_view name) const;
  /// Throws UserError if the sensor is not of this run.
  const SensorFacts& facts(const SensorSpec& spec) const;
  /// [sensors], in the run's order.
  const std::vector<SensorFacts>& sensors() const { return sensors_; }
  /// The sensor that records poses; null: none.
  const SensorSpec* pose_sensor() const { return poses_ ? &*poses_ : nullptr; }
  /// Whether shots of a LiDAR start from the pose at their own time (the effect lidar_sweep_motion).
  bool sweep_motion() const { return sweep_motion_; }

 private:
  void read_run(const std::string& run_json, const std::string& source);
  SensorFacts read_sensor(const SensorSpec& spec, const std::string& source) const;

  std::vector<std::string> nodes_, materials_, classes_;
  std::map<std::string, uint32_t, std::less<>> node_numbers_;
  std::vector<InstanceFacts> instances_;
  std::vector<SensorFacts> sensors_;
  std::map<std::string, size_t, std::less<>> sensor_numbers_;
  std::optional<SensorSpec> poses_;
  bool sweep_motion_ = true;
};

/// The nodes at a tick, as a record of poses has them.
class NodePoses {
 public:
  /// Throws UserError if an array is not as docs/dataset.md has it. Velocities that the record lacks are 0.
  NodePoses(const RecordTables& tables, const Record& poses);

  int64_t tick() const { return tick_; }
  int64_t time_ns() const { return time_ns_; }
  size_t size() const { return motions_.size(); }
  const Motion& motion(uint32_t node) const { return motions_.at(node); }
  const Pose& pose(uint32_t node) const { return motions_.at(node).pose; }
  /// `dt_s` after the tick, from the velocities, the acceleration and the angular velocity at the tick.
  Pose after(uint32_t node, double dt_s) const;
  /// World_from_sensor, `dt_s` after the tick; none if the run does not say where the place is.
  std::optional<Pose> world_from(const Place& place, double dt_s = 0.0) const;

 private:
  int64_t tick_ = 0, time_ns_ = 0;
  std::vector<Motion> motions_;
};

/// World_from_body of one node. Throws UserError if there is no such node.
Pose pose_of(const RecordTables& tables, std::string_view node, const Record& poses);

}  // namespace greatx::view
