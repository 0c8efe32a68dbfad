// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What overlays draw into the main view, as shapes in the world. The shapes come from records alone, so that
// a live run and a data set show the same, and nothing is traced twice. view/app projects and draws them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/vec.h"
#include "draw/canvas/canvas.h"

namespace greatx::view {

/// What is under the cursor when a shape is: the row of a table, for a tooltip.
struct ShapeRow {
  std::string text;      ///< lines
  uint64_t id = 0;       ///< that stays the same from tick to tick (a path's identity); 0: none
  bool is_path = false;  ///< of a channel: the Paths tab lists it
};

struct LineShape {
  dvec3 a{0.0}, b{0.0};  ///< world, m
  io::Color color;
  float width_px = 1.5f;
  uint32_t row = ~0u;   ///< into Shapes::rows; ~0: none
  bool arrow = false;   ///< a head at b
  bool always = false;  ///< drawn in front of everything, never hidden by the scene
};

struct PointShape {
  enum class Mark : uint8_t { dot, circle, square, diamond, cross, triangle };
  dvec3 at{0.0};  ///< world, m
  io::Color color;
  float size_px = 2.0f;
  Mark mark = Mark::dot;
  uint32_t row = ~0u;
  bool always = false;
};

struct LabelShape {
  dvec3 at{0.0};  ///< world, m
  std::string text;
  io::Color color;
};

/// A rectangle of a camera's picture, drawn while one looks through that camera. Coordinates are pixels of
/// its record: pixel i reaches from i to i + 1.
struct PictureShape {
  dvec2 low{0.0}, high{0.0};
  io::Color color;
  bool filled = false;
  uint32_t row = ~0u;
};

struct Shapes {
  std::vector<LineShape> lines;
  std::vector<PointShape> points;
  std::vector<LabelShape> labels;
  std::vector<PictureShape> picture;
  double picture_width = 0.0;  ///< of the camera's record, pixels; 0: there is nothing in `picture`
  std::vector<ShapeRow> rows;
  /// A legend for the corner of the view: texts with their colours.
  std::vector<std::pair<std::string, io::Color>> legend;

  bool empty() const { return lines.empty() && points.empty() && labels.empty() && picture.empty(); }
  /// Adds everything of `other`. Its rows come behind those that are there. Pictures must be of one width.
  void append(const Shapes& other);
  /// Adds a row and returns its number, for LineShape::row and PointShape::row.
  uint32_t add_row(std::string text, uint64_t id = 0);
  /// Adds a line of the legend in the colour of plain text.
  void note(std::string text);
};

}  // namespace greatx::view
