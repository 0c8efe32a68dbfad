// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panels of inertial sensors, GNSS receivers, barometers and magnetometers: what they measure, and
// how far it is from the truth, over time.
#include <algorithm>
#include <cmath>

#include "draw/sheet/panels.h"

namespace greatx::io {

namespace {

constexpr size_t most_instants = 4000;  ///< of a line; further records are passed over evenly

/// One value over time. A value that is not finite is a gap.
struct ValueLine {
  std::string name;
  std::vector<double> values;
};

/// The lines of a plot, with their times.
struct Lines {
  std::string title, label;
  std::vector<double> times_s;
  std::vector<ValueLine> lines;
  bool from_zero = false;  ///< the axis of values begins at 0
};

/// Shows lines over time, with a line of names above.
class LinesPanel : public SeriesPanel {
 public:
  explicit LinesPanel(Lines lines) : lines_(std::move(lines)) {}
  std::string title() const override { return lines_.title; }

  void draw(Canvas& canvas, const Rect& area) override {
    if (lines_.times_s.empty()) return;
    const Rect plot = plot_in(area);
    const Scale time = times(), scale = values();
    canvas.fill(plot, canvas.theme().panel);
    draw_y_grid(canvas, plot, scale);
    canvas.clip(plot);
    for (size_t n = 0; n < lines_.lines.size(); ++n) draw_line(canvas, plot, time, scale, n);
    canvas.unclip();
    int x = area.x;
    for (size_t n = 0; n < lines_.lines.size(); ++n) {
      canvas.disc(x + 6.0, area.y + 11.0, 5.0, color_of_series(canvas.theme(), n));
      canvas.text(x + 18, area.y + 4, lines_.lines[n].name, theme::text_scale, canvas.theme().text);
      x += 32 + Canvas::text_width(lines_.lines[n].name, theme::text_scale);
    }
    canvas.frame(plot, canvas.theme().border);
    draw_x_axis(canvas, plot, time, "time s");
    draw_y_axis(canvas, plot, scale, lines_.label);
  }
  void mark_time(Canvas& canvas, const Rect& area, double time_s) override {
    if (!lines_.times_s.empty()) mark_time_in(canvas, plot_in(area), times(), time_s, canvas.theme().over);
  }

 private:
  static Rect plot_in(const Rect& area) {
    return {area.x + 92, area.y + 8 + theme::line_height, area.width - 104,
            area.height - 16 - 4 * theme::line_height};
  }
  Scale times() const { return scale_for(lines_.times_s.front(), lines_.times_s.back()); }
  Scale values() const {
    double low = lines_.from_zero ? 0.0 : 1e300, high = -1e300;
    for (const ValueLine& line : lines_.lines)
      for (const double value : line.values)
        if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
    if (!(high >= low)) return {0.0, 1.0, false};
    const double pad = std::max(0.08 * (high - low), 1e-9 * std::max(std::abs(low), std::abs(high)));
    if (pad == 0.0) return {low - 1.0, high + 1.0, false};
    return {lines_.from_zero ? 0.0 : low - pad, high + pad, false};
  }
  void draw_line(Canvas& canvas, const Rect& plot, const Scale& time, const Scale& scale, size_t n) const {
    const Color color = color_of_series(canvas.theme(), n);
    const std::vector<double>& values = lines_.lines[n].values;
    const auto place = [&](size_t i) {
      return dvec2(plot.x + time.at(lines_.times_s[i]) * plot.width,
                   plot.bottom() - scale.at(values[i]) * plot.height);
    };
    for (size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) continue;
      const dvec2 to = place(i);
      if (i > 0 && std::isfinite(values[i - 1])) {
        const dvec2 from = place(i - 1);
        canvas.line(from.x, from.y, to.x, to.y, 2.0, color);
      } else if (i + 1 == values.size() || !std::isfinite(values[i + 1])) {
        canvas.disc(to.x, to.y, 3.0, color);
      }
    }
  }

  Lines lines_;
};

/// Returns the records to show: all of them, or so many that they are spread evenly.
std::vector<IndexRow> rows_to_show(const PanelSource& source) {
  const std::vector<IndexRow> rows = source.records.records_of(source.sequence, source.sensor);
  const size_t step = rows.size() / most_instants + 1;
  std::vector<IndexRow> shown;
  for (size_t i = 0; i < rows.size(); i += step) shown.push_back(rows[i]);
  return shown;
}

double seconds_of(const IndexRow& row) { return 1e-9 * static_cast<double>(row.time_ns); }

std::vector<ValueLine> axes_xyz() { return {{"x", {}}, {"y", {}}, {"z", {}}}; }

void add_lines(Panels& panels, Lines lines) {
  panels.series.push_back(std::make_unique<LinesPanel>(std::move(lines)));
}

/// Returns "car/imu: `what`".
std::string title_of(const PanelSource& source, const char* what) {
  return fmt::format("{}: {}", source.spec().name, what);
}

/// Adds the plot of an array f64 [samples, 3] of an inertial sensor.
void add_samples(const PanelSource& source, Panels& panels, const char* array, const char* title,
                 const char* label) {
  if (!source.has(array) || !source.has("time")) return;
  Lines out{title_of(source, title), label, {}, axes_xyz()};
  const std::vector<IndexRow> rows = source.records.records_of(source.sequence, source.sensor);
  const size_t step = rows.size() / most_instants + 1;
  for (size_t r = 0; r < rows.size(); r += step) {
    const Array times = source.load(rows[r], "time", {DType::i64}, {-1});
    const Array values = source.load(rows[r], array, {DType::f64}, {-1, 3});
    expect_same_rows(source, {&times, &values});
    const std::span<const int64_t> t = times.as<int64_t>();
    const std::span<const double> v = values.as<double>();
    for (size_t i = 0; i < t.size() && out.times_s.size() < 8 * most_instants; ++i) {
      out.times_s.push_back(1e-9 * static_cast<double>(t[i]));
      for (size_t axis = 0; axis < 3; ++axis) out.lines[axis].values.push_back(v[3 * i + axis]);
    }
  }
  add_lines(panels, std::move(out));
}

}  // namespace

void add_imu_panels(const PanelSource& source, Panels& panels) {
  add_samples(source, panels, "specific_force", "specific force", "m/s2");
  add_samples(source, panels, "angular_rate", "angular rate", "rad/s");
}

void add_gnss_panels(const PanelSource& source, Panels& panels) {
  if (!source.has("position") || !source.has("position_true")) return;
  Lines error{
      title_of(source, "error of position"), "error m", {}, {{"east", {}}, {"north", {}}, {"up", {}}}};
  Lines used{title_of(source, "satellites"), "satellites", {}, {{"tracked", {}}, {"direct", {}}}, true};
  const bool counted = source.has("satellite_state");
  for (const IndexRow& row : rows_to_show(source)) {
    const Array measured = source.load(row, "position", {DType::f64}, {3});
    const Array truth = source.load(row, "position_true", {DType::f64}, {3});
    error.times_s.push_back(seconds_of(row));
    for (size_t axis = 0; axis < 3; ++axis)
      error.lines[axis].values.push_back(measured.as<double>()[axis] - truth.as<double>()[axis]);
    if (!counted) continue;
    const Array states = source.load(row, "satellite_state", {DType::u8}, {-1});
    double tracked = 0.0, direct = 0.0;
    for (const uint8_t state : states.as<uint8_t>()) {
      direct += state == 1;
      tracked += state == 1 || state == 2;
    }
    used.times_s.push_back(seconds_of(row));
    used.lines[0].values.push_back(tracked);
    used.lines[1].values.push_back(direct);
  }
  add_lines(panels, std::move(error));
  if (counted) add_lines(panels, std::move(used));
}

void add_barometer_panels(const PanelSource& source, Panels& panels) {
  if (!source.has("height") || !source.has("height_true")) return;
  Lines out{title_of(source, "height"), "height m", {}, {{"measured", {}}, {"true", {}}}};
  for (const IndexRow& row : rows_to_show(source)) {
    out.times_s.push_back(seconds_of(row));
    out.lines[0].values.push_back(source.load(row, "height", {DType::f64}, {1}).as<double>()[0]);
    out.lines[1].values.push_back(source.load(row, "height_true", {DType::f64}, {1}).as<double>()[0]);
  }
  add_lines(panels, std::move(out));
}

void add_magnetometer_panels(const PanelSource& source, Panels& panels) {
  if (!source.has("field")) return;
  constexpr double microtesla = 1e6;
  Lines out{title_of(source, "magnetic field"), "field uT", {}, axes_xyz()};
  for (const IndexRow& row : rows_to_show(source)) {
    const Array field = source.load(row, "field", {DType::f64}, {3});
    out.times_s.push_back(seconds_of(row));
    for (size_t axis = 0; axis < 3; ++axis)
      out.lines[axis].values.push_back(microtesla * field.as<double>()[axis]);
  }
  add_lines(panels, std::move(out));
}

}  // namespace greatx::io
