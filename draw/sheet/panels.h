// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a contact sheet is made of. A FramePanel is one picture per chosen moment (a column of the sheet), a
// SeriesPanel one plot over the whole sequence. A kind of sensor gets onto the sheet by one row in
// panels.cpp. The viewer draws the FramePanels too, one record at a time, and asks them for the value under
// the cursor.
//
// A panel takes the colours of the canvas that it draws on. Its key explains marks and colours of all of its
// pictures at once, so that it stands below the last one.
#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/vec.h"
#include "draw/canvas/labels.h"
#include "draw/canvas/plot.h"
#include "draw/sheet/scene_names.h"
#include "io/dataset/record_source.h"
#include "io/files/untrusted_json.h"

namespace greatx::io {

/// Names a link by the places of its ends in the lists of a channel.
struct ChannelLink {
  size_t rx = 0, tx = 0;
  friend bool operator==(const ChannelLink&, const ChannelLink&) = default;
};

/// What panels are made from: a sensor in a sequence, and the records chosen for the rows (one a row, nearest
/// in time). The records stay where they are: whoever keeps a source keeps them, too.
struct PanelSource {
  const RecordSource& records;
  uint32_t sequence;
  size_t sensor;
  std::vector<IndexRow> chosen;
  ChannelLink link{};  ///< of a channel: what is shown
  /// What names and outlines say of the scene; null: pictures have none of them.
  std::shared_ptr<const SceneFacts> scene{};
  const SensorSpec& spec() const { return records.sensors()[sensor]; }
  bool has(std::string_view array) const;
  /// Returns "DIR/sequence_0000/SENSOR", the beginning of messages.
  std::string place() const;
  /// Loads an array. Throws UserError unless the array has one of these types and this shape (-1: any extent,
  /// 0: any extent of 1 or more), and only valid numbers (find_bad_value()). The checks are needed because a
  /// data set may give any array this name.
  Array load(const IndexRow& row, const std::string& array, const std::vector<DType>& types,
             const std::vector<int64_t>& shape) const;
};

inline constexpr size_t most_key_entries = 9;

/// Draws one picture for each chosen moment.
class FramePanel {
 public:
  virtual ~FramePanel() = default;
  virtual std::string title() const = 0;
  /// Returns the height of the picture divided by its width.
  virtual double aspect() const { return 0.75; }
  /// Draws record `row` of PanelSource::chosen into `picture`, and the legend into `legend` below.
  virtual void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) = 0;
  /// What pixel (x, y) of the canvas shows of record `row` drawn into `picture`: where it is and the value
  /// there with its unit, in lines. Empty outside of the picture.
  virtual std::string value_at(const Rect& picture, size_t row, int x, int y, const SceneNames& names) = 0;
  /// Explains the colours and marks of all pictures, at most most_key_entries lines. May read all records.
  virtual std::vector<KeyEntry> key(const Theme& /*theme*/) { return {}; }
  /// Says what record `row` has none of ("no points"), if it holds nothing to draw; else empty.
  virtual std::string nothing_of(size_t /*row*/) { return {}; }
};

/// Draws one plot of the whole sequence.
class SeriesPanel {
 public:
  virtual ~SeriesPanel() = default;
  virtual std::string title() const = 0;
  /// Draws the plot, its axes and its legend inside `area`.
  virtual void draw(Canvas& canvas, const Rect& area) = 0;
  /// Marks an instant, seconds, in the plot that draw() has drawn into `area`.
  virtual void mark_time(Canvas& /*canvas*/, const Rect& /*area*/, double /*time_s*/) {}
};

/// A way to draw the records of a kind of sensor as pictures.
struct FrameKind {
  const char* name;                 ///< "depth"; unique for the kind of sensor
  std::vector<const char*> arrays;  ///< that the sensor must declare
  /// Null if the sensor's metadata do not say enough to draw it.
  std::unique_ptr<FramePanel> (*make)(const PanelSource& source);
  /// The sheet shows the first one of each group that the sensor has; null: none.
  const char* group;
};
template <typename Drawn>
std::unique_ptr<FramePanel> make_frame(const PanelSource& source) {
  return std::make_unique<Drawn>(source);
}
/// Those of a kind of sensor ("camera"), in the order of the sheet.
std::span<const FrameKind> frame_kinds(std::string_view sensor_kind);
/// Whether the sensor declares all of the arrays.
bool has_arrays(const SensorSpec& sensor, std::span<const char* const> arrays);

struct Panels {
  std::vector<std::unique_ptr<FramePanel>> frames;
  std::vector<std::unique_ptr<SeriesPanel>> series;
};

/// What of a sensor is shown.
struct PanelOptions {
  /// Of the pictures of ids "instance", "semantic" and "material" the one to show, if the sensor has it;
  /// empty: the first that it has.
  std::string ids;
  /// Of channels, "TX:RX" or "CHANNEL:TX:RX" (channel_links.h); empty: of each the strongest.
  std::vector<std::string> links;
};
/// Adds the panels of one sensor. Unknown kinds of sensors have none.
void add_panels(const PanelSource& source, Panels& panels, const PanelOptions& options = {});
/// The most frame panels that add_panels() adds for one link.
size_t count_frame_panels(const SensorSpec& sensor);
/// Returns true if sensors of the kind have panels.
bool has_panels(std::string_view kind);
/// Returns true if the sensor has arrays that a frame panel draws.
bool has_frame_panels(const SensorSpec& sensor);
/// Returns true if a record of the kind covers the time since the previous record, so that the first record
/// of a sequence is empty.
bool is_about_intervals(std::string_view kind);

// The kinds of pictures and of plots, by sensor (camera_panels.cpp, event_panels.cpp, lidar_panel.cpp,
// radar_panels.cpp, csi_panels.cpp, pose_panel.cpp).
std::vector<FrameKind> camera_frames();
std::vector<FrameKind> event_frames();
std::vector<FrameKind> lidar_frames();
std::vector<FrameKind> radar_frames();
/// Of a radar, over a camera's picture (radar_overlay_panel.cpp).
std::vector<FrameKind> radar_overlay_frames();
/// Of a channel that senses (sensing_panel.cpp).
std::vector<FrameKind> sensing_frames();
void add_csi_panels(const PanelSource& source, Panels& panels);  ///< of source.link
void add_pose_panels(const PanelSource& source, Panels& panels);
/// Of sensors that navigate (navigation_panels.cpp).
void add_imu_panels(const PanelSource& source, Panels& panels);
void add_gnss_panels(const PanelSource& source, Panels& panels);
void add_barometer_panels(const PanelSource& source, Panels& panels);
void add_magnetometer_panels(const PanelSource& source, Panels& panels);
/// Of a camera: normals, optical flow, boxes (truth_panels.cpp).
std::vector<FrameKind> truth_frames();

/// The element of a raster of `columns` x `rows` that pixel (x, y) of the canvas shows if the raster fills
/// `picture`; empty outside.
struct RasterCell {
  int column = 0, row = 0;
};
std::optional<RasterCell> cell_at(const Rect& picture, int64_t columns, int64_t rows, int x, int y);

/// Returns the colour of a motion. The hue is the direction (right: red, down: yellow-green). The saturation
/// is the length: 0 is white, 1 is fully saturated. Longer motions are darker. A motion that is not finite is
/// black.
Color flow_color(double u, double v);
/// Returns a picture of the events, summed by pixel on neutral grey: ON is red, OFF is blue, both are violet;
/// u8 [height, width, 3]. Throws UserError if an event is outside the picture.
Array event_picture(std::span<const uint16_t> x, std::span<const uint16_t> y, std::span<const uint8_t> p,
                    int64_t width, int64_t height);

/// Returns the node of a sensor: "uav" of "uav/front".
std::string node_of(const SensorSpec& sensor);
/// Returns the pose of a node in the world at a record, from the "pose" sensor. Returns nothing if the data
/// set does not contain it at this tick. Throws UserError if the poses are invalid.
std::optional<Pose> world_from_node(const PanelSource& source, const IndexRow& row, const std::string& node);
/// Returns the pose {"position_m": [3], "orientation_wxyz": [4]}. What is absent is that of the identity.
Pose pose_of(const JsonValue& json);
/// Returns the pose of a sensor in the world at a record: the pose of its node from the "pose" sensor, times
/// the mount of the sensor ("body_from_sensor" of its metadata). Returns nothing if the data set does not
/// contain the node's pose at this tick. Throws UserError if the poses or the metadata are invalid.
std::optional<Pose> world_from_sensor(const PanelSource& source, const IndexRow& row);
/// Returns "body_from_sensor" of the sensor's metadata: {"position_m": [3], "orientation_wxyz": [4]}, or the
/// identity if it is absent.
Pose mount_of(const PanelSource& source);
/// Returns the metadata of a sensor. Messages name them "DIR/dataset.json: SENSOR: metadata".
JsonDocument metadata_of(const PanelSource& source);
/// Returns the number `key` of the metadata, or `otherwise` if there is none. Throws UserError if the number
/// is not within [least, most].
double number_of(const JsonDocument& metadata, const char* key, double otherwise, double least, double most);
/// Throws UserError unless all arrays have the same number of rows.
void expect_same_rows(const PanelSource& source, std::initializer_list<const Array*> arrays);
/// Returns the names of the nodes of a "pose" sensor.
std::vector<std::string> node_names(const PanelSource& pose);

}  // namespace greatx::io
