// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/canvas/canvas.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "draw/canvas/font.h"

namespace greatx::io {

Canvas::Canvas(int width, int height, Color background, const Theme& theme, int factor)
    : width_(width), height_(height), factor_(factor), theme_(&theme) {
  GREATX_CHECK(width > 0 && height > 0 && factor > 0 && factor <= most_factor, "picture of {} x {}, times {}",
               width, height, factor);
  pixels_.resize(stride() * static_cast<size_t>(height) * static_cast<size_t>(factor) * 3);
  unclip();
  fill({0, 0, width, height}, background);
}

Array Canvas::image() const {
  return Array::of<uint8_t>({int64_t{height_} * factor_, int64_t{width_} * factor_, 3}, pixels_);
}

void Canvas::clip(const Rect& rect) {
  const int x = std::max(0, rect.x), y = std::max(0, rect.y);
  clip_ = grown({x, y, std::max(0, std::min(width_, rect.right()) - x),
                 std::max(0, std::min(height_, rect.bottom()) - y)});
}

void Canvas::blend(int x, int y, Color color, double alpha) {
  if (factor_ == 1) return blend_pixel(x, y, color, alpha);
  fill({x, y, 1, 1}, color, alpha);
}

void Canvas::blend_pixel(int x, int y, Color color, double alpha) {
  if (x < clip_.x || y < clip_.y || x >= clip_.right() || y >= clip_.bottom()) return;
  uint8_t* const pixel = pixels_.data() + (static_cast<size_t>(y) * stride() + static_cast<size_t>(x)) * 3;
  const uint8_t channels[] = {color.r, color.g, color.b};
  if (alpha >= 1.0) {
    std::copy_n(channels, 3, pixel);
    return;
  }
  const double share = std::max(alpha, 0.0);
  for (int i = 0; i < 3; ++i)  // between 0 and 255, so this rounds to nearest
    pixel[i] = static_cast<uint8_t>(pixel[i] + (channels[i] - pixel[i]) * share + 0.5);
}

void Canvas::fill(const Rect& rect, Color color, double alpha) {
  const Rect all = grown(rect);
  const int left = std::max(all.x, clip_.x), right = std::min(all.right(), clip_.right());
  for (int y = std::max(all.y, clip_.y); y < std::min(all.bottom(), clip_.bottom()); ++y) {
    if (alpha < 1.0) {
      for (int x = left; x < right; ++x) blend_pixel(x, y, color, alpha);
      continue;
    }
    uint8_t* pixel = pixels_.data() + (static_cast<size_t>(y) * stride() + static_cast<size_t>(left)) * 3;
    for (int x = left; x < right; ++x, pixel += 3) pixel[0] = color.r, pixel[1] = color.g, pixel[2] = color.b;
  }
}

void Canvas::frame(const Rect& rect, Color color) {
  fill({rect.x - 1, rect.y - 1, rect.width + 2, 1}, color);
  fill({rect.x - 1, rect.bottom(), rect.width + 2, 1}, color);
  fill({rect.x - 1, rect.y, 1, rect.height}, color);
  fill({rect.right(), rect.y, 1, rect.height}, color);
}

/// Fills the area where the signed distance to a shape is below zero, with a transition of one pixel. All
/// numbers are in pixels of the raster.
void Canvas::shape(double x0, double y0, double x1, double y1, Color color, double opacity,
                   const std::function<double(double, double)>& distance) {
  const int left = std::max(clip_.x, static_cast<int>(std::floor(std::max(x0 - 1.0, -1e6))));
  const int top = std::max(clip_.y, static_cast<int>(std::floor(std::max(y0 - 1.0, -1e6))));
  const int right = std::min(clip_.right() - 1, static_cast<int>(std::ceil(std::min(x1 + 1.0, 1e6))));
  const int bottom = std::min(clip_.bottom() - 1, static_cast<int>(std::ceil(std::min(y1 + 1.0, 1e6))));
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const double alpha = 0.5 - distance(x + 0.5, y + 0.5);
      if (alpha > 0.0) blend_pixel(x, y, color, std::min(alpha, 1.0) * opacity);
    }
  }
}

namespace {

/// The signed distance to a line with round ends.
struct Capsule {
  double x0, y0, dx, dy, square, half;
  Capsule(double from_x, double from_y, double to_x, double to_y, double thickness)
      : x0(from_x),
        y0(from_y),
        dx(to_x - from_x),
        dy(to_y - from_y),
        square(dx * dx + dy * dy),
        half(0.5 * thickness) {}
  double operator()(double x, double y) const {
    const double t = square > 0.0 ? std::clamp(((x - x0) * dx + (y - y0) * dy) / square, 0.0, 1.0) : 0.0;
    return std::hypot(x - x0 - t * dx, y - y0 - t * dy) - half;
  }
};

}  // namespace

void Canvas::line(double x0, double y0, double x1, double y1, double thickness, Color color, double alpha) {
  const double f = factor_, half = 0.5 * thickness * f;
  shape(f * std::min(x0, x1) - half, f * std::min(y0, y1) - half, f * std::max(x0, x1) + half,
        f * std::max(y0, y1) + half, color, alpha, Capsule(f * x0, f * y0, f * x1, f * y1, f * thickness));
}

void Canvas::circle(double x, double y, double radius, double thickness, Color color) {
  const double cx = x * factor_, cy = y * factor_, r = radius * factor_, wide = thickness * factor_;
  const double reach = r + wide;
  shape(cx - reach, cy - reach, cx + reach, cy + reach, color, 1.0,
        [=](double px, double py) { return std::abs(std::hypot(px - cx, py - cy) - r) - 0.5 * wide; });
}

void Canvas::disc(double x, double y, double radius, Color color) {
  const double cx = x * factor_, cy = y * factor_, r = radius * factor_;
  shape(cx - r, cy - r, cx + r, cy + r, color, 1.0,
        [=](double px, double py) { return std::hypot(px - cx, py - cy) - r; });
}

/// Draws a character whose dots have `size` pixels of the raster. Small dots are squares. Larger ones are
/// joined to strokes with round ends, which read better in print. `grow` pixels more on each side make a rim.
void Canvas::glyph(char c, double left, double top, double size, bool upwards, double grow, Color color) {
  const auto code = static_cast<unsigned char>(c);
  const uint8_t* const columns = font_5x7[code >= 32 && code < 127 ? code - 32 : '?' - 32];
  const auto lit = [&](int column, int row) {
    return column >= 0 && column < 5 && row < 8 && (columns[column] >> row & 1) != 0;
  };
  const auto place = [&](double column, double row) {
    return upwards ? std::pair(left + (row + 0.5) * size, top - (column + 0.5) * size)
                   : std::pair(left + (column + 0.5) * size, top + (row + 0.5) * size);
  };
  const auto stroke = [&](int c0, int r0, int c1, int r1) {
    const auto [x0, y0] = place(c0, r0);
    const auto [x1, y1] = place(c1, r1);
    const double half = 0.5 * size + grow;
    shape(std::min(x0, x1) - half, std::min(y0, y1) - half, std::max(x0, x1) + half, std::max(y0, y1) + half,
          color, 1.0, Capsule(x0, y0, x1, y1, 2.0 * half));
  };
  for (int column = 0; column < 5; ++column)
    for (int row = 0; row < 8; ++row) {
      if (!lit(column, row)) continue;
      if (size < 4.0) {
        const auto [x, y] = place(column, row);
        const double half = 0.5 * size + grow;
        for (int py = static_cast<int>(std::lround(y - half)); py < std::lround(y + half); ++py)
          for (int px = static_cast<int>(std::lround(x - half)); px < std::lround(x + half); ++px)
            blend_pixel(px, py, color, 1.0);
        continue;
      }
      stroke(column, row, column, row);
      if (lit(column + 1, row)) stroke(column, row, column + 1, row);
      if (lit(column, row + 1)) stroke(column, row, column, row + 1);
      for (const int side : {-1, 1})
        if (lit(column + side, row + 1) && !lit(column + side, row) && !lit(column, row + 1))
          stroke(column, row, column + side, row + 1);
    }
}

void Canvas::write(int x, int y, std::string_view text, int scale, double grow, Color color, bool upwards) {
  const double size = static_cast<double>(scale) * factor_;
  double left = static_cast<double>(x) * factor_, top = static_cast<double>(y) * factor_;
  for (const char c : text) {
    glyph(c, left, top, size, upwards, grow * factor_, color);
    (upwards ? top : left) += (upwards ? -1.0 : 1.0) * glyph_width * size;
  }
}

void Canvas::note(const Rect& rect, std::string_view text) {
  const Rect clip{clip_.x / factor_, clip_.y / factor_, clip_.width / factor_, clip_.height / factor_};
  texts_.push_back({rect, std::string(text), clip.contains(rect)});
}

void Canvas::text(int x, int y, std::string_view text, int scale, Color color, Align align) {
  const int width = text_width(text, scale) - scale;
  x -= align == Align::center ? width / 2 : align == Align::right ? width : 0;
  write(x, y, text, scale, 0.0, color, false);
  if (!text.empty()) note({x, y, width, (glyph_height - 1) * scale}, text);
}

void Canvas::rimmed_text(int x, int y, std::string_view text, int scale, Color color, Color rim,
                         Align align) {
  const int width = text_width(text, scale) - scale;
  const int left = x - (align == Align::center ? width / 2 : align == Align::right ? width : 0);
  write(left, y, text, scale, 1.0, rim, false);
  this->text(left, y, text, scale, color);
}

void Canvas::vertical_text(int x, int y, std::string_view text, int scale, Color color) {
  const int width = text_width(text, scale) - scale, bottom = y + width / 2;
  write(x, bottom, text, scale, 0.0, color, true);
  if (!text.empty()) note({x, bottom - width, (glyph_height - 1) * scale, width}, text);
}

std::string fitted(std::string_view text, int width, int scale) {
  const auto room = static_cast<size_t>(std::max(1, (width + scale) / (Canvas::glyph_width * scale)));
  if (text.size() <= room) return std::string(text);
  if (room < 6) return std::string(text.substr(0, room));
  const size_t kept = room - 3, front = (kept + 1) / 2;
  return fmt::format("{}...{}", text.substr(0, front), text.substr(text.size() - (kept - front)));
}

void Canvas::picture(const Rect& rect, const Array& rgb) {
  const std::span<const uint8_t> in = rgb.as<uint8_t>();
  const auto rows = static_cast<int>(rgb.shape[0]), columns = static_cast<int>(rgb.shape[1]);
  const Rect all = grown(rect);
  for (int y = 0; y < all.height; ++y) {
    const int y0 = y * rows / all.height, y1 = std::max(y0 + 1, (y + 1) * rows / all.height);
    for (int x = 0; x < all.width; ++x) {
      const int x0 = x * columns / all.width, x1 = std::max(x0 + 1, (x + 1) * columns / all.width);
      int sum[3] = {0, 0, 0};
      for (int v = y0; v < y1; ++v)
        for (int u = x0; u < x1; ++u)
          for (int c = 0; c < 3; ++c) sum[c] += in[(static_cast<size_t>(v) * columns + u) * 3 + c];
      const int count = (y1 - y0) * (x1 - x0);
      blend_pixel(all.x + x, all.y + y,
                  {static_cast<uint8_t>(sum[0] / count), static_cast<uint8_t>(sum[1] / count),
                   static_cast<uint8_t>(sum[2] / count)},
                  1.0);
    }
  }
}

}  // namespace greatx::io
