// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Marks of detections and of true places over the maps of radars and of channels that sense, and what they
// say: rings for detections, crosses for true places, labels for the most important ones.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "draw/sheet/panels.h"

namespace greatx::io {

/// A mark of a map. A real detection belongs to something; a true place is real if an echo comes from there.
/// The sensor itself is a disc without a label.
struct MapMark {
  enum class Kind : uint8_t { detection, truth, sensor } kind = Kind::detection;
  dvec2 at{0.0};  ///< pixels
  bool real = true;
  std::vector<std::string> label;  ///< lines; empty: none is wished
};

/// Draws the marks. Numbers of axes come next, so that no mark covers them, and then the labels.
void draw_map_marks(Canvas& canvas, const std::vector<MapMark>& marks);
/// Writes the labels of the marks, in their order, where they cover neither texts nor marks.
void label_map_marks(Canvas& canvas, const Rect& picture, const std::vector<MapMark>& marks);
/// Returns the lines of a label: "van", "23.4 m -4.2 m/s".
std::vector<std::string> mark_label(const std::string& name, double range_m, double velocity_m_s);

/// Draws outlines of the scene as a map over range and azimuth of a sensor sees them: `place` returns the
/// pixel of a range (m) and an azimuth (rad, positive to the left). Ranges are those in space, so that a wall
/// lies where its echoes do.
template <typename Place>
void draw_outlines(Canvas& canvas, const std::vector<OutlineLine>& lines, const Pose& world_from_sensor,
                   double far_m, double azimuth_min, double azimuth_max, const Place& place) {
  constexpr double step_m = 2.0;  // the picture of a straight wall is bent
  const Pose sensor_from_world = world_from_sensor.inverse();
  for (const OutlineLine& line : lines) {
    const dvec3 from = sensor_from_world.apply(line.from), to = sensor_from_world.apply(line.to);
    const double length = glm::length(to - from);
    if (0.5 * glm::length(from + to) - 0.5 * length > far_m) continue;
    const int steps = std::max(1, static_cast<int>(std::min(1e4, std::ceil(length / step_m))));
    std::optional<dvec2> last;
    for (int i = 0; i <= steps; ++i) {
      const dvec3 at = from + (to - from) * (static_cast<double>(i) / steps);
      const double range = glm::length(at), azimuth = std::atan2(at.y, at.x);
      std::optional<dvec2> next;
      if (range <= far_m && azimuth >= azimuth_min && azimuth <= azimuth_max) next = place(range, azimuth);
      if (last && next) canvas.line(last->x, last->y, next->x, next->y, 1.3, canvas.theme().outline);
      last = next;
    }
  }
}

}  // namespace greatx::io
