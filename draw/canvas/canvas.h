// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws plots into a picture: rectangles, anti-aliased lines and circles, text in a built-in 5x7 font.
//
//   Canvas = an RGB raster, the theme that gives its colours, and a factor. Whoever draws gives places and
//            lengths in pixels of a canvas of factor 1. A canvas of factor 2 has twice the pixels along each
//            side for the same drawing, so that a print is sharp.
//   DrawnText = a text as it was drawn. Labels find free places with their help (labels.h), and tests check
//            that none covers another.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/record.h"
#include "draw/canvas/theme.h"

namespace greatx::io {

struct Rect {
  int x = 0, y = 0, width = 0, height = 0;
  int right() const { return x + width; }
  int bottom() const { return y + height; }
  bool overlaps(const Rect& other) const {
    return x < other.right() && other.x < right() && y < other.bottom() && other.y < bottom();
  }
  bool contains(const Rect& other) const {
    return x <= other.x && y <= other.y && right() >= other.right() && bottom() >= other.bottom();
  }
};

enum class Align { left, center, right };

struct DrawnText {
  Rect rect;
  std::string text;
  bool whole = true;  ///< false: the clip rectangle or the canvas cuts it
};

/// Holds an RGB picture and draws on it. Coordinates are in pixels of factor 1 from the top left corner, x to
/// the right and y down.
class Canvas {
 public:
  static constexpr int glyph_width = 6, glyph_height = 8;  ///< with spacing, at scale 1
  static constexpr int most_factor = 4;

  /// A canvas of the dark theme.
  Canvas(int width, int height, Color background) : Canvas(width, height, background, dark_theme(), 1) {}
  /// A canvas in the colours of a theme; `factor` is 1 to most_factor. The theme must outlive it.
  Canvas(int width, int height, const Theme& theme, int factor = 1)
      : Canvas(width, height, theme.page, theme, factor) {}
  int width() const { return width_; }
  int height() const { return height_; }
  int factor() const { return factor_; }
  const Theme& theme() const { return *theme_; }
  /// Returns the picture, u8 [factor * height, factor * width, 3].
  Array image() const;

  /// Sets the clip rectangle. Drawing outside the rectangle has no effect. It is initially the whole picture.
  void clip(const Rect& rect);
  void unclip() { clip({0, 0, width_, height_}); }

  void blend(int x, int y, Color color, double alpha = 1.0);
  void fill(const Rect& rect, Color color, double alpha = 1.0);
  void frame(const Rect& rect, Color color);
  void line(double x0, double y0, double x1, double y1, double thickness, Color color, double alpha = 1.0);
  void circle(double x, double y, double radius, double thickness, Color color);
  void disc(double x, double y, double radius, Color color);
  /// Draws ASCII text with its top at y. The text begins at x, is centred on x or ends at x. Other characters
  /// appear as '?'.
  void text(int x, int y, std::string_view text, int scale, Color color, Align align = Align::left);
  /// Draws text with a rim, which can be read over any picture.
  void rimmed_text(int x, int y, std::string_view text, int scale, Color color, Color rim,
                   Align align = Align::left);
  /// Draws text that reads upwards, centred on y.
  void vertical_text(int x, int y, std::string_view text, int scale, Color color);
  static int text_width(std::string_view text, int scale) {
    return static_cast<int>(text.size()) * glyph_width * scale;
  }
  /// The texts that were drawn so far, in order.
  const std::vector<DrawnText>& texts() const { return texts_; }

  /// Draws a picture, u8 [h, w, 3], into `rect`. Pixels are averaged if the picture is larger than `rect`,
  /// and repeated if it is smaller.
  void picture(const Rect& rect, const Array& rgb);
  /// Any raster: the colour of column x, row y of `columns` x `rows`, nearest sample. `color(int x, int y)`
  /// is asked for every pixel, so it is a template parameter and not a std::function.
  template <typename ColorOf>
  void raster(const Rect& rect, int columns, int rows, const ColorOf& color) {
    const Rect all = grown(rect);
    const int left = std::max(all.x, clip_.x), right = std::min(all.right(), clip_.right());
    for (int y = std::max(all.y, clip_.y); y < std::min(all.bottom(), clip_.bottom()); ++y) {
      const int row = static_cast<int>(int64_t{y - all.y} * rows / all.height);
      uint8_t* pixel = pixels_.data() + (static_cast<size_t>(y) * stride() + static_cast<size_t>(left)) * 3;
      for (int x = left; x < right; ++x, pixel += 3) {
        const Color c = color(static_cast<int>(int64_t{x - all.x} * columns / all.width), row);
        pixel[0] = c.r;
        pixel[1] = c.g;
        pixel[2] = c.b;
      }
    }
  }
  /// Asks for the colour of every pixel of `rect` by its place: `color(double x, double y, Color&)` returns
  /// whether the pixel gets one.
  template <typename ColorAt>
  void paint(const Rect& rect, const ColorAt& color) {
    const Rect all = grown(rect);
    for (int y = std::max(all.y, clip_.y); y < std::min(all.bottom(), clip_.bottom()); ++y)
      for (int x = std::max(all.x, clip_.x); x < std::min(all.right(), clip_.right()); ++x)
        if (Color c; color(static_cast<double>(x) / factor_, static_cast<double>(y) / factor_, c)) {
          uint8_t* const pixel =
              pixels_.data() + (static_cast<size_t>(y) * stride() + static_cast<size_t>(x)) * 3;
          pixel[0] = c.r, pixel[1] = c.g, pixel[2] = c.b;
        }
  }

 private:
  Canvas(int width, int height, Color background, const Theme& theme, int factor);
  size_t stride() const { return static_cast<size_t>(width_) * static_cast<size_t>(factor_); }
  Rect grown(const Rect& rect) const {
    return {rect.x * factor_, rect.y * factor_, rect.width * factor_, rect.height * factor_};
  }
  void blend_pixel(int x, int y, Color color, double alpha);
  void glyph(char c, double left, double top, double size, bool upwards, double grow, Color color);
  void write(int x, int y, std::string_view text, int scale, double grow, Color color, bool upwards);
  void note(const Rect& rect, std::string_view text);
  void shape(double x0, double y0, double x1, double y1, Color color, double opacity,
             const std::function<double(double x, double y)>& distance);
  int width_, height_, factor_;
  const Theme* theme_;
  Rect clip_;  ///< in pixels of the raster
  std::vector<uint8_t> pixels_;
  std::vector<DrawnText> texts_;
};

/// Returns the text, or its ends around "..." if it is wider than `width`; at least its first character.
std::string fitted(std::string_view text, int width, int scale);

}  // namespace greatx::io
