// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The parts of a report: for each kind of sensor, what the page needs to know of the sensor and of each of
// its records. Inside of draw/report.
//
// A part is a pair of functions. describe() returns the sensor's JSON: what holds for all of its records.
// encode() returns the JSON of one record, adds its arrays to the blobs, and names them by their numbers. A
// record depends on nothing but itself, so that records can be left out when the page becomes too long.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/text.h"
#include "core/vec.h"
#include "draw/report/blobs.h"
#include "draw/sheet/panels.h"
#include "io/dataset/dataset_reader.h"

namespace greatx::io::report {

using Json = nlohmann::ordered_json;

/// How much of a record the page holds. A report takes the finest detail with which enough moments fit.
struct Detail {
  int64_t picture_width;  ///< of colour pictures, pixels at most
  int64_t value_width;    ///< of depth, ids, flow, events: pixels at most
  size_t cloud_points;    ///< of a LiDAR's record, at most
  size_t map_cells;       ///< of a map of power, at most
  size_t paths;           ///< of a channel's record, the strongest
  float quality;          ///< of colour pictures, libwebp's
};
inline constexpr Detail details[] = {{1280, 640, 60000, 1 << 16, 400, 80.0f},
                                     {640, 320, 20000, 1 << 14, 300, 74.0f},
                                     {400, 240, 6000, 1 << 13, 150, 66.0f},
                                     {240, 160, 2000, 1 << 12, 60, 55.0f}};
inline constexpr size_t most_detections = 400, most_boxes = 400, most_links = 16, most_port_pairs = 8;
inline constexpr size_t most_subcarriers = 512, most_series_points = 1000, most_nodes_shown = 64;
inline constexpr size_t most_objects = 3000, most_name = 200;

/// Collects what is left out, so that each reason is told once, and the ids whose names the page needs.
struct Collected {
  std::set<std::string> notes;
  std::set<uint32_t> instances, materials, classes;
};

/// Holds the poses of a sequence: of each node at each tick of the pose sensor, if the data set has one.
class PoseTable {
 public:
  PoseTable(const RecordSource& records, uint32_t sequence);
  bool any() const { return source_.has_value(); }
  const std::vector<std::string>& nodes() const { return nodes_; }
  const std::vector<IndexRow>& rows() const { return rows_; }
  const PanelSource& source() const { return *source_; }
  /// Returns the pose of each node at a tick, or nothing if no record has this tick.
  std::vector<Pose> at(int64_t tick) const;
  std::vector<Pose> at(const IndexRow& row) const;
  /// Returns the pose of `mount` on a node at a tick.
  std::optional<Pose> world_from(const std::string& node, const Pose& mount, int64_t tick) const;
  /// The first position of the first node, in whole metres, or zero.
  const dvec3& origin() const { return origin_; }

 private:
  std::optional<PanelSource> source_;
  std::vector<std::string> nodes_;
  std::vector<IndexRow> rows_;
  dvec3 origin_{0.0};
};

/// Everything that the parts of one sequence share.
struct Context {
  const RecordSource& records;
  uint32_t sequence;
  const PoseTable& poses;
  Detail detail;
  Blobs& blobs;
  Collected& collected;
};

/// Returns round(value), or 0 if it is not finite. Metadata of a sensor may allow such values in any array.
int64_t nearest(double value);
/// Rounds to `digits` places behind the point, so that the JSON is short. Null if the number is not finite.
Json rounded(double value, int digits);
/// Returns [x, y, z] from the origin, rounded to millimetres.
Json place_json(const Context& context, const dvec3& world);
/// Returns [x, y, z, qw, qx, qy, qz], or null.
Json pose_json(const Context& context, const std::optional<Pose>& world_from_sensor);
/// A name from a data set, fit to be shown: printable, and cut off behind `most_name` characters.
std::string shown_name(std::string_view name);

// Of each kind of sensor: camera_part.cpp, event_part.cpp, lidar_part.cpp, radar_part.cpp, channel_part.cpp.
Json describe_camera(const PanelSource& source);
Json encode_camera(const Context& context, const PanelSource& source, const IndexRow& row);
Json describe_events(const PanelSource& source);
Json encode_events(const Context& context, const PanelSource& source, const IndexRow& row);
Json describe_lidar(const PanelSource& source);
Json encode_lidar(const Context& context, const PanelSource& source, const IndexRow& row);
Json describe_radar(const PanelSource& source);
Json encode_radar(const Context& context, const PanelSource& source, const IndexRow& row);
Json describe_channel(const PanelSource& source);
Json encode_channel(const Context& context, const PanelSource& source, const IndexRow& row);

/// Packs a map of power [ranges, columns], W, as dBm in 255 even steps: code 0 is `low_dbm` or less. If the
/// map has more cells than the detail allows, a cell of the page is the strongest of a block.
Json encode_power(const Context& context, std::span<const float> watts, int64_t rows, int64_t columns);

/// Returns the maps, true targets and detections of links of a channel that senses: sensing_part.cpp.
Json encode_sensing(const Context& context, const PanelSource& source, const IndexRow& row, size_t targets,
                    const std::vector<ChannelLink>& links);

/// Packs a raster of ids, u8, u16 or u32, thinned to the detail's width, and collects the ids.
Json encode_ids(const Context& context, const Array& ids, std::set<uint32_t>& seen);

// The sequence's own parts: pose_part.cpp.
Json trajectories_json(const PoseTable& poses, Collected& collected);
Json poses_json(const Context& context, const std::vector<IndexRow>& moments);
/// Quantities over all ticks: of channels, and speed and altitude of nodes.
Json series_json(const RecordSource& records, uint32_t sequence, const PoseTable& poses,
                 Collected& collected);

// What holds for the whole data set: summary_part.cpp.
Json summary_json(const DatasetReader& reader, Collected& collected);
Json names_json(const DatasetReader& reader, const Collected& collected);
Json objects_json(const DatasetReader& reader, const dvec3& origin, Collected& collected);

}  // namespace greatx::io::report
