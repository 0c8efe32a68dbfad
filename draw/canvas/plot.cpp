// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/canvas/plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace greatx::io {

namespace {
constexpr int glyph = Canvas::glyph_width * theme::text_scale;
constexpr int text_height = 7 * theme::text_scale;

int pixel(int start, int extent, double t) { return start + static_cast<int>(std::lround(t * (extent - 1))); }

/// Returns the ticks of an axis below a plot, and of one at its side. Grid lines stand at the same values.
std::vector<double> ticks_below(const Rect& plot, const Scale& scale) {
  return scale.ticks(std::max(2, plot.width / 110));
}
std::vector<double> ticks_beside(const Rect& plot, const Scale& scale) {
  return scale.ticks(std::max(2, plot.height / 60));
}
}  // namespace

double Scale::at(double value) const {
  if (logarithmic) return std::log(value / low) / std::log(high / low);
  return (value - low) / (high - low);
}

double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double mantissa = value / power * (1.0 + 1e-9);
  return power * (mantissa >= 5.0 ? 5.0 : mantissa >= 2.0 ? 2.0 : 1.0);
}

std::vector<double> Scale::ticks(int count) const {
  std::vector<double> values;
  if (logarithmic) {
    const int first = static_cast<int>(std::floor(std::log10(low))),
              last = static_cast<int>(std::ceil(std::log10(high)));
    for (int power = first; power <= last; ++power) {
      for (const double mantissa : {1.0, 2.0, 5.0}) {
        const double value = mantissa * std::pow(10.0, power);
        if (value < low || value > high || (mantissa > 1.0 && last - first > 3)) continue;
        values.push_back(value);
      }
    }
    return values;
  }
  double step = round_down((high - low) / count);
  if ((high - low) / step > 1.6 * count) step = round_down(step * 2.5);
  const auto first = static_cast<int64_t>(std::ceil(low / step - 1e-9));
  for (int64_t i = first; static_cast<double>(i) * step <= high + 1e-9 * step && values.size() < 100; ++i)
    values.push_back(static_cast<double>(i) * step);
  return values;
}

Scale scale_for(double low, double high, double log_above) {
  if (!(high > low)) {
    const double pad = std::max(std::abs(low) * 0.05, 1e-12);
    return {low - pad, high + pad, false};
  }
  return {low, high, low > 0.0 && high / low > log_above};
}

std::string tick_text(double value) {
  if (std::abs(value) < 1e-12) return "0";
  return fmt::format("{:.4g}", value);
}

void draw_x_grid(Canvas& canvas, const Rect& plot, const Scale& scale) {
  for (const double value : ticks_below(plot, scale))
    canvas.fill({pixel(plot.x, plot.width, scale.at(value)), plot.y, 1, plot.height}, canvas.theme().grid);
}

void draw_y_grid(Canvas& canvas, const Rect& plot, const Scale& scale) {
  for (const double value : ticks_beside(plot, scale))
    canvas.fill({plot.x, pixel(plot.y, plot.height, 1.0 - scale.at(value)), plot.width, 1},
                canvas.theme().grid);
}

void draw_x_axis(Canvas& canvas, const Rect& plot, const Scale& scale, const std::string& label) {
  int taken = std::numeric_limits<int>::min();  // by numbers; one that has no room is left out
  for (const double value : ticks_below(plot, scale)) {
    const int x = pixel(plot.x, plot.width, scale.at(value));
    canvas.fill({x, plot.bottom(), 1, 5}, canvas.theme().dim);
    const std::string text = tick_text(value);
    const int width = Canvas::text_width(text, theme::text_scale);
    if (x - width / 2 < taken) continue;
    taken = x + width / 2 + glyph / 2;
    canvas.text(x, plot.bottom() + 9, text, theme::text_scale, canvas.theme().dim, Align::center);
  }
  canvas.text(plot.x + plot.width / 2, plot.bottom() + 9 + theme::line_height, label, theme::text_scale,
              canvas.theme().text, Align::center);
}

void draw_y_axis(Canvas& canvas, const Rect& plot, const Scale& scale, const std::string& label) {
  size_t longest = 0;
  for (const double value : ticks_beside(plot, scale)) {
    const int y = pixel(plot.y, plot.height, 1.0 - scale.at(value));
    const std::string text = tick_text(value);
    longest = std::max(longest, text.size());
    canvas.fill({plot.x - 6, y, 5, 1}, canvas.theme().dim);
    canvas.text(plot.x - 10, y - text_height / 2, text, theme::text_scale, canvas.theme().dim, Align::right);
  }
  canvas.vertical_text(plot.x - 16 - static_cast<int>(longest) * glyph - text_height,
                       plot.y + plot.height / 2, label, theme::text_scale, canvas.theme().text);
}

void mark_time_in(Canvas& canvas, const Rect& plot, const Scale& time, double time_s, Color color) {
  const double t = time.at(time_s);
  if (!(t >= 0.0 && t <= 1.0)) return;
  const int x = pixel(plot.x, plot.width, t);
  canvas.fill({x - 1, plot.y, 3, plot.height}, canvas.theme().halo, 0.6);
  canvas.fill({x, plot.y, 1, plot.height}, color);
}

void draw_color_bar(Canvas& canvas, const Rect& rect, const Scale& scale, ColorMap map,
                    const std::string& unit) {
  const auto end_text = [&](double value) {
    if (std::abs(value) < 1e-3 * (scale.high - scale.low)) return std::string("0");
    return std::abs(value) >= 100.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
  };
  const std::string low = end_text(scale.low), high = end_text(scale.high) + " " + unit;
  const int text_y = rect.y + (rect.height - text_height) / 2;
  canvas.text(rect.x, text_y, low, theme::text_scale, canvas.theme().dim);
  canvas.text(rect.right(), text_y, high, theme::text_scale, canvas.theme().dim, Align::right);
  const int left = rect.x + static_cast<int>(low.size()) * glyph + 6;
  const Rect bar{left, rect.y + 4, rect.right() - static_cast<int>(high.size()) * glyph - 6 - left,
                 rect.height - 8};
  if (bar.width < 20) return;
  canvas.raster(bar, bar.width, 1, [&](int x, int) { return map(x / (bar.width - 1.0)); });
  for (const double value : scale.ticks(5)) {
    const double t = scale.at(value);
    if (t <= 0.02 || t >= 0.98) continue;
    canvas.fill({pixel(bar.x, bar.width, t), bar.bottom() - 4, 1, 4}, canvas.theme().page);
  }
}

void draw_color_scale(Canvas& canvas, const Rect& bar, const Scale& scale, ColorMap map,
                      const std::string& label) {
  canvas.raster(bar, 1, bar.height, [&](int, int y) { return map(1.0 - y / (bar.height - 1.0)); });
  canvas.frame(bar, canvas.theme().border);
  for (const double value : ticks_beside(bar, scale)) {
    const int y = pixel(bar.y, bar.height, 1.0 - scale.at(value));
    canvas.fill({bar.right() + 1, y, 4, 1}, canvas.theme().dim);
    canvas.text(bar.right() + 8, y - text_height / 2, tick_text(value), theme::text_scale,
                canvas.theme().dim);
  }
  canvas.text(bar.x, bar.y - theme::line_height, label, theme::text_scale, canvas.theme().dim);
}

}  // namespace greatx::io
