// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes beside marks of a picture what they are, where it covers neither another text nor another mark, and
// explains marks and colours in a key.
//
//   Labels   = a rectangle of a canvas and what in it must stay free: the texts that are there already, and
//              the marks. A label takes the first free one of eight places around its mark, so that the most
//              important mark has to come first. A label without a free place is not written.
//   KeyEntry = a mark or a colour, and what it means
#pragma once

#include <span>
#include <string>
#include <vector>

#include "draw/canvas/canvas.h"

namespace greatx::io {

class Labels {
 public:
  /// Keeps the canvas's texts free that are within `area` so far.
  Labels(Canvas& canvas, const Rect& area);
  /// Keeps a mark around (x, y) free.
  void keep_free(double x, double y, double radius);
  /// Writes lines of text beside the mark of a radius at (x, y). Returns false if there is no room.
  bool write(double x, double y, double radius, std::span<const std::string> lines, Color color);

 private:
  Canvas& canvas_;
  Rect area_;
  std::vector<Rect> taken_;
};

struct KeyEntry {
  enum class Mark : uint8_t { none, square, disc, ring, cross, line } mark = Mark::none;
  Color color;
  std::string text;
};

/// Draws one entry a line, theme::line_height each, into `area`, and nothing below it. Texts that are too
/// long lose their middle.
void draw_key(Canvas& canvas, const Rect& area, std::span<const KeyEntry> entries);

}  // namespace greatx::io
