// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a contact sheet is made of. A FramePanel is one picture per chosen moment (a column of the sheet), a
// SeriesPanel one plot over the whole sequence. A kind of sensor gets onto the sheet by one row in
// panels.cpp. The viewer draws the FramePanels too, one record at a time, and asks them for the value under
// the cursor.
#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/vec.h"
#include "draw/canvas/plot.h"
#include "draw/sheet/scene_names.h"
#include "io/dataset/record_source.h"
#include "io/files/untrusted_json.h"

namespace greatx::io {

/// What panels are made from: a sensor in a sequence, and the records chosen for the rows (one a row, nearest
/// in time). The records stay where they are: whoever keeps a source keeps them, too.
struct PanelSource {
  const RecordSource& records;
  uint32_t sequence;
  size_t sensor;
  std::vector<IndexRow> chosen;
  const SensorSpec& spec() const { return records.sensors()[sensor]; }
  bool has(std::string_view array) const;
  /// "DIR/sequence_0000/SENSOR", as messages begin.
  std::string place() const;
  /// An array as panels need it, whatever the data set makes of its name: of one of these types and this
  /// shape (-1: any extent, 0: any from 1 on), without numbers that must not be there. Throws UserError.
  Array load(const IndexRow& row, const std::string& array, const std::vector<DType>& types,
             const std::vector<int64_t>& shape) const;
};

class FramePanel {
 public:
  virtual ~FramePanel() = default;
  virtual std::string title() const = 0;
  /// Height over width of the picture, e.g. 0.75.
  virtual double aspect() const { return 0.75; }
  /// Draws record `row` of PanelSource::chosen: into `picture`, and its legend into `legend` below it.
  virtual void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) = 0;
  /// What pixel (x, y) of the canvas shows of record `row` drawn into `picture`: where it is and the value
  /// there with its unit, in lines. Empty outside of the picture.
  virtual std::string value_at(const Rect& picture, size_t row, int x, int y, const SceneNames& names) = 0;
  /// Says what record `row` has none of ("no points"), if it holds nothing to draw; else empty.
  virtual std::string nothing_of(size_t /*row*/) { return {}; }
};

class SeriesPanel {
 public:
  virtual ~SeriesPanel() = default;
  virtual std::string title() const = 0;
  /// Draws plot, axes and legend inside `area`.
  virtual void draw(Canvas& canvas, const Rect& area) = 0;
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

/// Adds the panels of one sensor; kinds that nothing is known about add none.
void add_panels(const PanelSource& source, Panels& panels);
/// Whether sensors of the kind have panels at all.
bool has_panels(std::string_view kind);
/// Whether sensors of the kind are drawn moment by moment.
bool has_frame_panels(std::string_view kind);
/// Whether a record of the kind is about the time since the record before, so that the first one of a
/// sequence is empty.
bool is_about_intervals(std::string_view kind);

// The kinds of pictures and of plots, by sensor (camera_panels.cpp, event_panels.cpp, lidar_panel.cpp,
// radar_panels.cpp, csi_panels.cpp, pose_panel.cpp).
std::vector<FrameKind> camera_frames();
std::vector<FrameKind> event_frames();
std::vector<FrameKind> lidar_frames();
std::vector<FrameKind> radar_frames();
void add_csi_panels(const PanelSource& source, Panels& panels);
void add_pose_panels(const PanelSource& source, Panels& panels);
/// Of a camera: normals, optical flow, boxes (truth_panels.cpp).
std::vector<FrameKind> truth_frames();

/// The element of a raster of `columns` x `rows` that pixel (x, y) of the canvas shows if the raster fills
/// `picture`; empty outside.
struct RasterCell {
  int column = 0, row = 0;
};
std::optional<RasterCell> cell_at(const Rect& picture, int64_t columns, int64_t rows, int x, int y);

/// A motion as a colour: direction as hue (right: red, down: yellow-green), length as saturation: white 0,
/// full 1, darker beyond. NaN: black.
Color flow_color(double u, double v);
/// Events summed by pixel on neutral grey, ON red, OFF blue, both violet: u8 [height, width, 3]. Throws
/// UserError if one lies outside.
Array event_picture(std::span<const uint16_t> x, std::span<const uint16_t> y, std::span<const uint8_t> p,
                    int64_t width, int64_t height);

/// A sensor's pose in the world at a record: that of its node from the "pose" sensor, times its mount
/// ("body_from_sensor" of its metadata). Empty if the data set does not say.
std::optional<Pose> world_from_sensor(const PanelSource& source, const IndexRow& row);
/// A sensor's metadata, in messages "DIR/dataset.json: SENSOR: metadata".
JsonDocument metadata_of(const PanelSource& source);
/// A number of them if it is there. Throws UserError.
double number_of(const JsonDocument& metadata, const char* key, double otherwise, double least, double most);
/// Throws UserError unless all have as many rows.
void expect_same_rows(const PanelSource& source, std::initializer_list<const Array*> arrays);
/// The names of the nodes of a "pose" sensor.
std::vector<std::string> node_names(const PanelSource& pose);

}  // namespace greatx::io
