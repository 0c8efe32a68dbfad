// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws plots into a picture: rectangles, anti-aliased lines and circles, text in a built-in 5x7 font. It
// also defines colour maps.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "core/record.h"

namespace greatx::io {

struct Color {
  uint8_t r = 0, g = 0, b = 0;
};

struct Rect {
  int x = 0, y = 0, width = 0, height = 0;
  int right() const { return x + width; }
  int bottom() const { return y + height; }
};

/// Returns a colour of Turbo by Anton Mikhailov (polynomial of degree 5 by Ruofei Du, Apache-2.0); t in 0..1.
Color turbo(double t);
/// Returns a colour of Viridis (polynomial of degree 6 by Matt Zucker, public domain); t in 0..1.
Color viridis(double t);
/// Returns the colour of an id. Successive ids have clearly different colours; 0 is dark grey.
Color color_of_id(uint32_t id);
/// Returns the colour of the n-th line of a plot. The colours repeat after eight lines.
Color color_of_series(size_t n);

enum class Align { left, center, right };

/// Holds an RGB picture and draws on it. Coordinates are in pixels from the top left corner, x to the right
/// and y down.
class Canvas {
 public:
  static constexpr int glyph_width = 6, glyph_height = 8;  ///< with spacing, at scale 1

  Canvas(int width, int height, Color background);
  int width() const { return width_; }
  int height() const { return height_; }
  /// Returns the picture, u8 [height, width, 3].
  Array image() const;

  /// Sets the clip rectangle. Drawing outside the rectangle has no effect. It is initially the whole picture.
  void clip(const Rect& rect);
  void unclip() { clip({0, 0, width_, height_}); }

  void blend(int x, int y, Color color, double alpha = 1.0);
  void fill(const Rect& rect, Color color, double alpha = 1.0);
  void frame(const Rect& rect, Color color);
  void line(double x0, double y0, double x1, double y1, double thickness, Color color);
  void circle(double x, double y, double radius, double thickness, Color color);
  void disc(double x, double y, double radius, Color color);
  /// Draws ASCII text with its top at y. The text begins at x, is centred on x or ends at x. Other characters
  /// appear as '?'.
  void text(int x, int y, std::string_view text, int scale, Color color, Align align = Align::left);
  /// Draws text that reads upwards, centred on y.
  void vertical_text(int x, int y, std::string_view text, int scale, Color color);
  static int text_width(std::string_view text, int scale) {
    return static_cast<int>(text.size()) * glyph_width * scale;
  }

  /// Draws a picture, u8 [h, w, 3], into `rect`. Pixels are averaged if the picture is larger than `rect`,
  /// and repeated if it is smaller.
  void picture(const Rect& rect, const Array& rgb);
  /// Any raster: the colour of column x, row y of `columns` x `rows`, nearest sample. `color(int x, int y)`
  /// is asked for every pixel, so it is a template parameter and not a std::function.
  template <typename ColorOf>
  void raster(const Rect& rect, int columns, int rows, const ColorOf& color) {
    const int left = std::max(rect.x, clip_.x), right = std::min(rect.right(), clip_.right());
    for (int y = std::max(rect.y, clip_.y); y < std::min(rect.bottom(), clip_.bottom()); ++y) {
      const int row = static_cast<int>(int64_t{y - rect.y} * rows / rect.height);
      uint8_t* pixel = pixels_.data() + (static_cast<size_t>(y) * static_cast<size_t>(width_) + left) * 3;
      for (int x = left; x < right; ++x, pixel += 3) {
        const Color c = color(static_cast<int>(int64_t{x - rect.x} * columns / rect.width), row);
        pixel[0] = c.r;
        pixel[1] = c.g;
        pixel[2] = c.b;
      }
    }
  }

 private:
  void glyph(char c, const std::function<void(int column, int row)>& dot) const;
  void shape(double x0, double y0, double x1, double y1, Color color,
             const std::function<double(double x, double y)>& distance);
  int width_, height_;
  Rect clip_;
  std::vector<uint8_t> pixels_;
};

}  // namespace greatx::io
