// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/bench/suite_output.h"
#include "draw/canvas/plot.h"

namespace greatx::apps {

namespace {

namespace theme = io::theme;

constexpr int panel_width = 560, panel_height = 380, head_height = 64;
constexpr int plot_left = 100, plot_top = 44, plot_right = 20, plot_bottom = 64;

/// A measured size: the rates of its median, slowest and fastest run.
struct CurvePoint {
  double size = 0.0, rate = 0.0, slowest = 0.0, fastest = 0.0;
};
struct Curve {
  std::string tracer;
  std::vector<CurvePoint> points;
};
struct CurvePanel {
  std::string pass, unit;
  std::vector<Curve> curves;
};

io::Color color_of_tracer(const std::string& tracer) {
  static const std::map<std::string, size_t> numbers{{"tree", 0}, {"driver", 1}, {"embree", 2}};
  const auto found = numbers.find(tracer);
  return io::color_of_series(found == numbers.end() ? 3 : found->second);
}

std::string words_of_tracer(const std::string& tracer) {
  if (tracer == "tree") return "greatx's trees";
  if (tracer == "driver") return "driver's ray queries";
  return tracer == "embree" ? "Embree" : "raster";
}

std::vector<CurvePanel> panels_of(const nlohmann::json& result, const std::string& axis) {
  std::vector<CurvePanel> panels;
  for (const nlohmann::json& row : result["rows"]) {
    if (row["axis"] != axis || row.contains("skipped")) continue;
    const std::string pass = row["pass"], tracer = row["tracer"];
    auto panel = std::ranges::find(panels, pass, &CurvePanel::pass);
    if (panel == panels.end())
      panel = panels.insert(panels.end(), {pass, row["unit"].get<std::string>(), {}});
    auto curve = std::ranges::find(panel->curves, tracer, &Curve::tracer);
    if (curve == panel->curves.end()) curve = panel->curves.insert(panel->curves.end(), {tracer, {}});
    const double units = 1e3 * row["count"].get<double>();
    const nlohmann::json& wall = row["wall_ms"];
    const auto rate = [&](const char* key) { return units / std::max(1e-6, wall[key].get<double>()); };
    curve->points.push_back({row["size"].get<double>(), rate("median"), rate("max"), rate("min")});
  }
  return panels;
}

/// Returns "1k", "20k", "10M" for the numbers along an axis.
std::string power_text(double value) {
  if (value >= 1e9) return fmt::format("{:.3g}G", value * 1e-9);
  if (value >= 1e6) return fmt::format("{:.3g}M", value * 1e-6);
  if (value >= 1e3) return fmt::format("{:.3g}k", value * 1e-3);
  return fmt::format("{:.3g}", value);
}

/// Returns a logarithmic scale of whole powers of ten around the values, at least one decade.
io::Scale decades(double low, double high) {
  const double first = std::floor(std::log10(low) + 1e-9), last = std::ceil(std::log10(high) - 1e-9);
  return {std::pow(10.0, first), std::pow(10.0, std::max(first + 1.0, last)), true};
}

struct PanelScales {
  io::Scale x, y;
};
PanelScales scales_of(const CurvePanel& panel) {
  double x_low = 1e300, x_high = 0.0, y_low = 1e300, y_high = 0.0;
  for (const Curve& curve : panel.curves)
    for (const CurvePoint& point : curve.points) {
      x_low = std::min(x_low, point.size), x_high = std::max(x_high, point.size);
      y_low = std::min(y_low, point.slowest), y_high = std::max(y_high, point.fastest);
    }
  return {decades(x_low, x_high), decades(y_low, y_high)};
}

void draw_grid(io::Canvas& canvas, const io::Rect& plot, const PanelScales& scales, const std::string& axis) {
  const auto whole_powers = [](const io::Scale& scale) {
    std::vector<double> values;
    for (double value = scale.low; value <= scale.high * 1.001; value *= 10.0) values.push_back(value);
    return values;
  };
  canvas.fill(plot, theme::panel);
  for (const double value : whole_powers(scales.x)) {
    const int x = plot.x + static_cast<int>(scales.x.at(value) * (plot.width - 1));
    canvas.fill({x, plot.y, 1, plot.height}, theme::grid);
    canvas.text(x, plot.bottom() + 8, power_text(value), theme::text_scale, theme::dim, io::Align::center);
  }
  for (const double value : whole_powers(scales.y)) {
    const int y = plot.bottom() - 1 - static_cast<int>(scales.y.at(value) * (plot.height - 1));
    canvas.fill({plot.x, y, plot.width, 1}, theme::grid);
    canvas.text(plot.x - 8, y - 7, power_text(value), theme::text_scale, theme::dim, io::Align::right);
  }
  canvas.frame(plot, theme::border);
  canvas.text(plot.x + plot.width / 2, plot.bottom() + 8 + theme::line_height, axis, theme::text_scale,
              theme::text, io::Align::center);
}

void draw_curve(io::Canvas& canvas, const io::Rect& plot, const PanelScales& scales, const Curve& curve) {
  const io::Color color = color_of_tracer(curve.tracer);
  const auto at_x = [&](double value) { return plot.x + scales.x.at(value) * (plot.width - 1); };
  const auto at_y = [&](double value) { return plot.bottom() - 1 - scales.y.at(value) * (plot.height - 1); };
  for (size_t i = 0; i < curve.points.size(); ++i) {
    const CurvePoint& point = curve.points[i];
    const double x = at_x(point.size), y = at_y(point.rate);
    canvas.line(x, at_y(point.slowest), x, at_y(point.fastest), 1.5, color);
    canvas.disc(x, y, 4.5, color);
    if (i == 0) continue;
    const CurvePoint& before = curve.points[i - 1];
    canvas.line(at_x(before.size), at_y(before.rate), x, y, 2.0, color);
  }
}

void draw_panel(io::Canvas& canvas, int left, int top, const CurvePanel& panel, const std::string& axis) {
  const io::Rect plot{left + plot_left, top + plot_top, panel_width - plot_left - plot_right,
                      panel_height - plot_top - plot_bottom};
  canvas.text(plot.x, top + 16, panel.pass, theme::text_scale, theme::text);
  canvas.text(plot.right(), top + 16, panel.unit + " per second", theme::text_scale, theme::dim,
              io::Align::right);
  const PanelScales scales = scales_of(panel);
  draw_grid(canvas, plot, scales, axis);
  for (const Curve& curve : panel.curves) draw_curve(canvas, plot, scales, curve);
}

/// Draws the device's name and, at the right, which colour is which tracer.
void draw_head(io::Canvas& canvas, const nlohmann::json& result, const std::vector<CurvePanel>& panels) {
  std::vector<std::string> tracers;
  for (const CurvePanel& panel : panels)
    for (const Curve& curve : panel.curves)
      if (std::ranges::find(tracers, curve.tracer) == tracers.end()) tracers.push_back(curve.tracer);
  canvas.text(
      20, 14,
      fmt::format("{}, {} cores", result["device"]["name"].get<std::string>(), result["cores"].get<size_t>()),
      theme::text_scale, theme::text);
  int x = 20;
  for (const std::string& tracer : tracers) {
    const std::string words = words_of_tracer(tracer);
    canvas.disc(x + 6, 14 + theme::line_height + 8, 5.0, color_of_tracer(tracer));
    canvas.text(x + 18, 14 + theme::line_height + 1, words, theme::text_scale, theme::dim);
    x += 18 + io::Canvas::text_width(words, theme::text_scale) + 26;
  }
}

}  // namespace

Array suite_curves(const nlohmann::json& result, const std::string& axis) {
  const std::vector<CurvePanel> panels = panels_of(result, axis);
  const int columns = panels.size() < 3   ? std::max<int>(1, int(panels.size()))
                      : panels.size() < 5 ? 2
                                          : 3,
            rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  io::Canvas canvas(std::max(640, columns * panel_width), head_height + std::max(1, rows) * panel_height,
                    theme::page);
  draw_head(canvas, result, panels);
  for (size_t i = 0; i < panels.size(); ++i)
    draw_panel(canvas, static_cast<int>(i) % columns * panel_width,
               head_height + static_cast<int>(i) / columns * panel_height, panels[i], axis);
  return canvas.image();
}

}  // namespace greatx::apps
