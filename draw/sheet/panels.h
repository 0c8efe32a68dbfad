// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the panels of a contact sheet. A FramePanel draws one picture for each chosen moment (a column of
// the sheet); a SeriesPanel draws one plot of the whole sequence. One entry of the table in panels.cpp adds a
// kind of sensor to the sheet.
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

/// Describes the data of a panel: a sensor, a sequence, and one record for each row of the sheet, the one
/// nearest in time.
struct PanelSource {
  const DatasetReader& reader;
  uint32_t sequence;
  size_t sensor;
  std::vector<IndexRow> chosen;
  const SensorSpec& spec() const { return reader.sensors()[sensor]; }
  /// Returns true if the sensor has an array of this name.
  bool has(std::string_view array) const;
  /// Returns "DIR/sequence_0000/SENSOR", the beginning of messages.
  std::string place() const;
  /// Loads an array. Throws UserError unless the array has one of these types and this shape (-1: any extent,
  /// 0: any extent of 1 or more), and only valid numbers (find_bad_value()). The checks are needed because a
  /// data set may give any array this name.
  Array load(const IndexRow& row, const std::string& array, const std::vector<DType>& types,
             const std::vector<int64_t>& shape) const;
};

/// Draws one picture for each chosen moment.
class FramePanel {
 public:
  virtual ~FramePanel() = default;
  virtual std::string title() const = 0;
  /// Returns the height of the picture divided by its width.
  virtual double aspect() const { return 0.75; }
  /// Draws record `row` of PanelSource::chosen into `picture`, and the legend into `legend` below.
  virtual void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) = 0;
};

/// Draws one plot of the whole sequence.
class SeriesPanel {
 public:
  virtual ~SeriesPanel() = default;
  virtual std::string title() const = 0;
  /// Draws the plot, its axes and its legend inside `area`.
  virtual void draw(Canvas& canvas, const Rect& area) = 0;
};

struct Panels {
  std::vector<std::unique_ptr<FramePanel>> frames;
  std::vector<std::unique_ptr<SeriesPanel>> series;
};

/// Adds the panels of one sensor. Unknown kinds of sensors have none.
void add_panels(const PanelSource& source, Panels& panels);
/// Returns true if sensors of the kind have panels.
bool has_panels(std::string_view kind);
/// Returns true if sensors of the kind have frame panels.
bool has_frame_panels(std::string_view kind);
/// Returns true if a record of the kind covers the time since the previous record, so that the first record
/// of a sequence is empty.
bool is_about_intervals(std::string_view kind);

// These functions add the panels of one kind of sensor each (camera_panels.cpp, event_panels.cpp,
// lidar_panel.cpp, radar_panels.cpp, csi_panels.cpp, pose_panel.cpp).
void add_camera_panels(const PanelSource& source, Panels& panels);
void add_event_panels(const PanelSource& source, Panels& panels);
void add_lidar_panels(const PanelSource& source, Panels& panels);
void add_radar_panels(const PanelSource& source, Panels& panels);
void add_csi_panels(const PanelSource& source, Panels& panels);
void add_pose_panels(const PanelSource& source, Panels& panels);

/// Adds the panels of a camera's normals, optical flow and boxes (truth_panels.cpp). add_camera_panels()
/// calls this function.
void add_truth_panels(const PanelSource& source, Panels& panels);

/// Returns the colour of a motion. The hue is the direction (right: red, down: yellow-green). The saturation
/// is the length: 0 is white, 1 is fully saturated. Longer motions are darker. A motion that is not finite is
/// black.
Color flow_color(double u, double v);
/// Returns a picture of the events, summed by pixel on neutral grey: ON is red, OFF is blue, both are violet;
/// u8 [height, width, 3]. Throws UserError if an event is outside the picture.
Array event_picture(std::span<const uint16_t> x, std::span<const uint16_t> y, std::span<const uint8_t> p,
                    int64_t width, int64_t height);

/// Returns the pose of a sensor in the world at a record: the pose of its node from the "pose" sensor, times
/// the mount of the sensor ("body_from_sensor" of its metadata). Returns nothing if the data set does not
/// contain the node's pose at this tick. Throws UserError if the poses or the metadata are invalid.
std::optional<Pose> world_from_sensor(const PanelSource& source, const IndexRow& row);
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
