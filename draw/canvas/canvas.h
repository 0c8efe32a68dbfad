// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A picture to draw plots on: rectangles, anti-aliased lines and circles, text in a built-in 5x7 font, colour
// maps.
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

/// Anton Mikhailov's Turbo (polynomial of degree 5 by Ruofei Du, Apache-2.0), t in 0..1.
Color turbo(double t);
/// Viridis (polynomial of degree 6 by Matt Zucker, public domain), t in 0..1.
Color viridis(double t);
/// Neighbouring numbers get distinct colours; 0 is dark grey.
Color color_of_id(uint32_t id);
/// The n-th line colour of a plot.
Color color_of_series(size_t n);

enum class Align { left, center, right };

class Canvas {
 public:
  static constexpr int glyph_width = 6, glyph_height = 8;  ///< with the space between glyphs, at scale 1

  Canvas(int width, int height, Color background);
  int width() const { return width_; }
  int height() const { return height_; }
  /// u8 [height, width, 3].
  Array image() const;

  /// Drawing outside the clip rectangle has no effect; at first it is the whole picture.
  void clip(const Rect& rect);
  void unclip() { clip({0, 0, width_, height_}); }

  void blend(int x, int y, Color color, double alpha = 1.0);
  void fill(const Rect& rect, Color color, double alpha = 1.0);
  void frame(const Rect& rect, Color color);
  void line(double x0, double y0, double x1, double y1, double thickness, Color color);
  void circle(double x, double y, double radius, double thickness, Color color);
  void disc(double x, double y, double radius, Color color);
  /// ASCII; the top left corner of the first glyph is at (x, y), or the text is centred on x or ends there.
  void text(int x, int y, std::string_view text, int scale, Color color, Align align = Align::left);
  /// Reading upwards, centred on y.
  void vertical_text(int x, int y, std::string_view text, int scale, Color color);
  static int text_width(std::string_view text, int scale) {
    return static_cast<int>(text.size()) * glyph_width * scale;
  }

  /// u8 [h, w, 3], averaged down or repeated up into `rect`.
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
