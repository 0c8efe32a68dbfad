// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/canvas/canvas.h"

#include <algorithm>
#include <cmath>

#include "draw/canvas/font.h"

namespace greatx::io {

namespace {

/// Rounds as std::lround() does, without a call: this is done for every pixel.
uint8_t to_byte(double value) { return static_cast<uint8_t>(255.0 * std::clamp(value, 0.0, 1.0) + 0.5); }

/// Evaluates c[0] + c[1] t + ..., one polynomial for each channel.
template <size_t N>
Color polynomial(const double (&c)[N][3], double t) {
  t = std::clamp(t, 0.0, 1.0);
  double value[3] = {0, 0, 0};
  for (size_t i = N; i-- > 0;)
    for (int k = 0; k < 3; ++k) value[k] = value[k] * t + c[i][k];
  return {to_byte(value[0]), to_byte(value[1]), to_byte(value[2])};
}

Color from_hsv(double hue, double saturation, double value) {
  const auto channel = [&](double n) {
    const double k = std::fmod(n + 6.0 * hue, 6.0);
    return to_byte(value * (1.0 - saturation * std::max(0.0, std::min({k, 4.0 - k, 1.0}))));
  };
  return {channel(5.0), channel(3.0), channel(1.0)};
}

}  // namespace

Color turbo(double t) {
  static constexpr double c[6][3] = {
      {0.13572138, 0.09140261, 0.10667330},      {4.61539260, 2.19418839, 12.64194608},
      {-42.66032258, 4.84296658, -60.58204836},  {132.13108234, -14.18503333, 110.36276771},
      {-152.94239396, 4.27729857, -89.90310912}, {59.28637943, 2.82956604, 27.34824973}};
  return polynomial(c, t);
}

Color viridis(double t) {
  static constexpr double c[7][3] = {
      {0.2777273272, 0.0054073445, 0.3340998053},   {0.1050930431, 1.4046135299, 1.3845901626},
      {-0.3308618287, 0.2148475595, 0.0950951630},  {-4.6342304990, -5.7991009734, -19.3324409563},
      {6.2282699363, 14.1799333668, 56.6905526007}, {4.7763849977, -13.7451453777, -65.3530326334},
      {-5.4354558559, 4.6458526122, 26.3124352496}};
  return polynomial(c, t);
}

Color color_of_id(uint32_t id) {
  if (id == 0) return {40, 43, 50};
  // Steps of the golden ratio around the circle of hues separate the hues of successive ids. Saturation and
  // value vary slowly.
  const double hue = std::fmod(id * 0.6180339887498949, 1.0);
  return from_hsv(hue, 0.45 + 0.15 * ((id / 3) % 3), 0.95 - 0.18 * ((id / 7) % 3));
}

Color color_of_series(size_t n) {
  static constexpr Color colors[] = {{255, 166, 64},  {86, 180, 233}, {120, 220, 130}, {240, 110, 150},
                                     {190, 150, 255}, {240, 228, 90}, {110, 220, 215}, {215, 140, 100}};
  return colors[n % std::size(colors)];
}

Canvas::Canvas(int width, int height, Color background)
    : width_(width),
      height_(height),
      clip_{0, 0, width, height},
      pixels_(static_cast<size_t>(width) * height * 3) {
  GREATX_CHECK(width > 0 && height > 0, "picture of {} x {}", width, height);
  fill(clip_, background);
}

Array Canvas::image() const { return Array::of<uint8_t>({height_, width_, 3}, pixels_); }

void Canvas::clip(const Rect& rect) {
  const int x = std::max(0, rect.x), y = std::max(0, rect.y);
  clip_ = {x, y, std::max(0, std::min(width_, rect.right()) - x),
           std::max(0, std::min(height_, rect.bottom()) - y)};
}

void Canvas::blend(int x, int y, Color color, double alpha) {
  if (x < clip_.x || y < clip_.y || x >= clip_.right() || y >= clip_.bottom()) return;
  uint8_t* const pixel = pixels_.data() + (static_cast<size_t>(y) * width_ + x) * 3;
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
  const int left = std::max(rect.x, clip_.x), right = std::min(rect.right(), clip_.right());
  for (int y = std::max(rect.y, clip_.y); y < std::min(rect.bottom(), clip_.bottom()); ++y) {
    if (alpha < 1.0) {
      for (int x = left; x < right; ++x) blend(x, y, color, alpha);
      continue;
    }
    uint8_t* pixel = pixels_.data() + (static_cast<size_t>(y) * static_cast<size_t>(width_) + left) * 3;
    for (int x = left; x < right; ++x, pixel += 3) pixel[0] = color.r, pixel[1] = color.g, pixel[2] = color.b;
  }
}

void Canvas::frame(const Rect& rect, Color color) {
  fill({rect.x - 1, rect.y - 1, rect.width + 2, 1}, color);
  fill({rect.x - 1, rect.bottom(), rect.width + 2, 1}, color);
  fill({rect.x - 1, rect.y, 1, rect.height}, color);
  fill({rect.right(), rect.y, 1, rect.height}, color);
}

/// Fills the area where the signed distance to a shape is below zero, with a transition of one pixel.
void Canvas::shape(double x0, double y0, double x1, double y1, Color color,
                   const std::function<double(double, double)>& distance) {
  const int left = std::max(clip_.x, static_cast<int>(std::floor(std::max(x0 - 1.0, -1e6))));
  const int top = std::max(clip_.y, static_cast<int>(std::floor(std::max(y0 - 1.0, -1e6))));
  const int right = std::min(clip_.right() - 1, static_cast<int>(std::ceil(std::min(x1 + 1.0, 1e6))));
  const int bottom = std::min(clip_.bottom() - 1, static_cast<int>(std::ceil(std::min(y1 + 1.0, 1e6))));
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const double alpha = 0.5 - distance(x + 0.5, y + 0.5);
      if (alpha > 0.0) blend(x, y, color, alpha);
    }
  }
}

void Canvas::line(double x0, double y0, double x1, double y1, double thickness, Color color) {
  const double dx = x1 - x0, dy = y1 - y0, square = dx * dx + dy * dy, half = 0.5 * thickness;
  shape(std::min(x0, x1) - half, std::min(y0, y1) - half, std::max(x0, x1) + half, std::max(y0, y1) + half,
        color, [=](double x, double y) {
          const double t =
              square > 0.0 ? std::clamp(((x - x0) * dx + (y - y0) * dy) / square, 0.0, 1.0) : 0.0;
          return std::hypot(x - x0 - t * dx, y - y0 - t * dy) - half;
        });
}

void Canvas::circle(double cx, double cy, double radius, double thickness, Color color) {
  const double r = radius + thickness;
  shape(cx - r, cy - r, cx + r, cy + r, color,
        [=](double x, double y) { return std::abs(std::hypot(x - cx, y - cy) - radius) - 0.5 * thickness; });
}

void Canvas::disc(double cx, double cy, double radius, Color color) {
  shape(cx - radius, cy - radius, cx + radius, cy + radius, color,
        [=](double x, double y) { return std::hypot(x - cx, y - cy) - radius; });
}

void Canvas::glyph(char c, const std::function<void(int, int)>& dot) const {
  const auto code = static_cast<unsigned char>(c);
  const uint8_t* const columns = font_5x7[code >= 32 && code < 127 ? code - 32 : '?' - 32];
  for (int column = 0; column < 5; ++column)
    for (int row = 0; row < 8; ++row)
      if (columns[column] >> row & 1) dot(column, row);
}

void Canvas::text(int x, int y, std::string_view text, int scale, Color color, Align align) {
  const int width = text_width(text, scale) - scale;
  x -= align == Align::center ? width / 2 : align == Align::right ? width : 0;
  for (const char c : text) {
    glyph(c, [&](int column, int row) { fill({x + column * scale, y + row * scale, scale, scale}, color); });
    x += glyph_width * scale;
  }
}

void Canvas::vertical_text(int x, int y, std::string_view text, int scale, Color color) {
  y += (text_width(text, scale) - scale) / 2;
  for (const char c : text) {
    glyph(c, [&](int column, int row) {
      fill({x + row * scale, y - (column + 1) * scale, scale, scale}, color);
    });
    y -= glyph_width * scale;
  }
}

void Canvas::picture(const Rect& rect, const Array& rgb) {
  const std::span<const uint8_t> in = rgb.as<uint8_t>();
  const auto rows = static_cast<int>(rgb.shape[0]), columns = static_cast<int>(rgb.shape[1]);
  for (int y = 0; y < rect.height; ++y) {
    const int y0 = y * rows / rect.height, y1 = std::max(y0 + 1, (y + 1) * rows / rect.height);
    for (int x = 0; x < rect.width; ++x) {
      const int x0 = x * columns / rect.width, x1 = std::max(x0 + 1, (x + 1) * columns / rect.width);
      int sum[3] = {0, 0, 0};
      for (int v = y0; v < y1; ++v)
        for (int u = x0; u < x1; ++u)
          for (int c = 0; c < 3; ++c) sum[c] += in[(static_cast<size_t>(v) * columns + u) * 3 + c];
      const int count = (y1 - y0) * (x1 - x0);
      blend(rect.x + x, rect.y + y,
            {static_cast<uint8_t>(sum[0] / count), static_cast<uint8_t>(sum[1] / count),
             static_cast<uint8_t>(sum[2] / count)});
    }
  }
}

}  // namespace greatx::io
