// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a contact sheet is made of. A FramePanel is one picture per chosen moment (a column of the sheet), a
// SeriesPanel one plot over the whole sequence. A kind of sensor gets onto the sheet by one row in
// panels.cpp.
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
#include "io/dataset/dataset_reader.h"
#include "io/files/untrusted_json.h"

namespace greatx::io {

/// What panels are made from: a sensor in a sequence, and the records chosen for the rows (one a row, nearest
/// in time).
struct PanelSource {
  const DatasetReader& reader;
  uint32_t sequence;
  size_t sensor;
  std::vector<IndexRow> chosen;
  const SensorSpec& spec() const { return reader.sensors()[sensor]; }
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
};

class SeriesPanel {
 public:
  virtual ~SeriesPanel() = default;
  virtual std::string title() const = 0;
  /// Draws plot, axes and legend inside `area`.
  virtual void draw(Canvas& canvas, const Rect& area) = 0;
};

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

// The makers, one for each kind (camera_panels.cpp, event_panels.cpp, lidar_panel.cpp, radar_panels.cpp,
// csi_panels.cpp, pose_panel.cpp).
void add_camera_panels(const PanelSource& source, Panels& panels);
void add_event_panels(const PanelSource& source, Panels& panels);
void add_lidar_panels(const PanelSource& source, Panels& panels);
void add_radar_panels(const PanelSource& source, Panels& panels);
void add_csi_panels(const PanelSource& source, Panels& panels);
void add_pose_panels(const PanelSource& source, Panels& panels);

/// Of a camera: normals, optical flow, boxes (truth_panels.cpp); add_camera_panels calls it.
void add_truth_panels(const PanelSource& source, Panels& panels);

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
