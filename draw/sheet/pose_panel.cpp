// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panels of poses: trajectories from above, height over time, speed over time.
#include <algorithm>
#include <cmath>

#include "draw/sheet/panels.h"

namespace greatx::io {

namespace {

constexpr size_t most_points = 2000;     ///< approximate limit for the line of one node
constexpr double largest_short_m = 2e4;  ///< larger coordinates (UTM) are shown relative to a round offset

/// Holds the motion of all nodes of a sequence, at most most_points instants.
struct NodeCourses {
  std::vector<std::string> names;
  std::vector<double> times_s;
  std::vector<std::vector<dvec3>> positions;  ///< [nodes][instants], m
  std::vector<std::vector<double>> speeds;    ///< [nodes][instants], m/s; empty: the data set has none

  explicit NodeCourses(const PanelSource& source) : names(node_names(source)) {
    const std::vector<IndexRow> rows = source.records.records_of(source.sequence, source.sensor);
    const size_t step = std::max<size_t>(1, rows.size() / most_points);
    const bool moving = source.has("velocity");
    for (size_t i = 0; i < rows.size();
         i += (i + step < rows.size() || i + 1 == rows.size() ? step : rows.size() - 1 - i)) {
      times_s.push_back(1e-9 * static_cast<double>(rows[i].time_ns));
      const Array places = source.load(rows[i], "position", {DType::f64}, {-1, 3});
      const std::span<const double> p = places.as<double>();
      if (positions.empty()) positions.resize(p.size() / 3);
      if (positions.size() != p.size() / 3)
        throw_user_error("{}, tick {}: expected the positions of {} nodes as before, found {}",
                         source.place(), rows[i].tick, positions.size(), p.size() / 3);
      for (size_t n = 0; n < positions.size(); ++n)
        positions[n].push_back({p[3 * n], p[3 * n + 1], p[3 * n + 2]});
      if (!moving) continue;
      const Array rates = source.load(rows[i], "velocity", {DType::f64}, {-1, 3});
      expect_same_rows(source, {&places, &rates});
      const std::span<const double> v = rates.as<double>();
      speeds.resize(positions.size());
      for (size_t n = 0; n < speeds.size(); ++n)
        speeds[n].push_back(glm::length(dvec3(v[3 * n], v[3 * n + 1], v[3 * n + 2])));
    }
  }
  std::string name(size_t n) const { return n < names.size() ? names[n] : fmt::format("node {}", n); }
};
using SharedCourses = std::shared_ptr<const NodeCourses>;

/// Returns the plot in an area: below a line of names, beside the numbers of the axes.
Rect plot_of_courses(const Rect& area) {
  return {area.x + 92, area.y + 8 + theme::line_height, area.width - 104,
          area.height - 16 - 4 * theme::line_height};
}

/// Draws the names of the first nodes in their colours, side by side in the line above the plot.
void draw_node_names(Canvas& canvas, const Rect& area, const NodeCourses& courses) {
  constexpr int mark = 18, space = 14, widest = 200;
  const size_t count = courses.positions.size();
  const auto more = [&](size_t shown) { return fmt::format("and {} more", count - shown); };
  const auto width_of = [](const std::string& text) { return Canvas::text_width(text, theme::text_scale); };
  const int y = area.y + 4;
  int x = area.x;
  for (size_t n = 0; n < count; ++n) {
    const std::string name = fitted(courses.name(n), widest, theme::text_scale);
    const int rest = n + 1 < count ? space + width_of(more(n + 1)) : 0;
    if (x + mark + width_of(name) + rest > area.right()) {
      canvas.text(x, y, fitted(more(n), area.right() - x, theme::text_scale), theme::text_scale,
                  canvas.theme().dim);
      return;
    }
    canvas.disc(x + 6.0, y + 7.0, 5.0, color_of_series(canvas.theme(), n));
    canvas.text(x + mark, y, name, theme::text_scale, canvas.theme().text);
    x += mark + width_of(name) + space;
  }
}

/// Shows the trajectories of the nodes from above, with north up and the same scale on both axes, over the
/// outlines of buildings.
class TrajectoryPanel : public SeriesPanel {
 public:
  TrajectoryPanel(const PanelSource& source, SharedCourses courses)
      : scene_(source.scene), courses_(std::move(courses)) {}
  std::string title() const override { return "trajectories from above"; }

  void draw(Canvas& canvas, const Rect& area) override {
    if (courses_->positions.empty()) return;
    const Map map = map_of(area);
    canvas.fill(map.plot, canvas.theme().panel);
    canvas.clip(map.plot);
    draw_x_grid(canvas, map.plot, map.x);
    draw_y_grid(canvas, map.plot, map.y);
    if (scene_)
      for (const OutlineLine& line : scene_->outlines) {
        const dvec2 from = map.place(line.from), to = map.place(line.to);
        canvas.line(from.x, from.y, to.x, to.y, 1.3, canvas.theme().outline);
      }
    for (size_t n = 0; n < courses_->positions.size(); ++n)
      draw_course(canvas, courses_->positions[n], color_of_series(canvas.theme(), n), map);
    canvas.unclip();
    draw_node_names(canvas, area, *courses_);
    canvas.frame(map.plot, canvas.theme().border);
    const auto label = [](const char* text, double from) {
      return from == 0.0 ? fmt::format("{} m", text) : fmt::format("{} - {:.0f} m", text, from);
    };
    draw_x_axis(canvas, map.plot, map.x, label("east", map.offset.x));
    draw_y_axis(canvas, map.plot, map.y, label("north", map.offset.y));
  }
  /// Marks where the nodes are.
  void mark_time(Canvas& canvas, const Rect& area, double time_s) override {
    if (courses_->positions.empty()) return;
    const Map map = map_of(area);
    const auto next = std::ranges::lower_bound(courses_->times_s, time_s - 1e-9);
    const auto i =
        std::min(static_cast<size_t>(next - courses_->times_s.begin()), courses_->times_s.size() - 1);
    canvas.clip(map.plot);
    for (size_t n = 0; n < courses_->positions.size(); ++n) {
      const dvec2 at = map.place(courses_->positions[n][i]);
      canvas.disc(at.x, at.y, 8.0, canvas.theme().text);
      canvas.disc(at.x, at.y, 5.5, color_of_series(canvas.theme(), n));
    }
    canvas.unclip();
  }

 private:
  struct Map {
    Rect plot;
    Scale x, y;
    dvec2 offset{0.0};
    dvec2 place(const dvec3& at) const {
      return {plot.x + x.at(at.x - offset.x) * plot.width,
              plot.bottom() - y.at(at.y - offset.y) * plot.height};
    }
  };
  Map map_of(const Rect& area) const {
    Map map;
    map.plot = plot_of_courses(area);
    dvec2 low(1e300), high(-1e300);
    for (const auto& line : courses_->positions)
      for (const dvec3& point : line) low = glm::min(low, dvec2(point)), high = glm::max(high, dvec2(point));
    for (int c = 0; c < 2; ++c)
      if (std::max(std::abs(low[c]), std::abs(high[c])) > largest_short_m)
        map.offset[c] = 1000.0 * std::floor(low[c] / 1000.0);
    const dvec2 middle = 0.5 * (low + high), span = glm::max(1.15 * (high - low), dvec2(4.0));
    const double metres_per_pixel = std::max(span.x / map.plot.width, span.y / map.plot.height);
    const dvec2 half = 0.5 * metres_per_pixel * dvec2(map.plot.width, map.plot.height);
    map.x = {middle.x - half.x - map.offset.x, middle.x + half.x - map.offset.x};
    map.y = {middle.y - half.y - map.offset.y, middle.y + half.y - map.offset.y};
    return map;
  }
  static void draw_course(Canvas& canvas, const std::vector<dvec3>& line, Color color, const Map& map) {
    dvec2 last = map.place(line[0]);
    for (const dvec3& point : line) {
      const dvec2 next = map.place(point);
      if (glm::length(next - last) < 1.5) continue;
      canvas.line(last.x, last.y, next.x, next.y, 2.5, color);
      last = next;
    }
    const dvec2 start = map.place(line.front()), end = map.place(line.back());
    if (glm::length(end - start) > 3.0) canvas.circle(start.x, start.y, 5.0, 2.0, color);
    canvas.disc(end.x, end.y, 5.5, color);
  }

  std::shared_ptr<const SceneFacts> scene_;
  SharedCourses courses_;
};

/// Shows a value of each node over time.
class CoursePanel : public SeriesPanel {
 public:
  enum class Value : uint8_t { height, speed };
  CoursePanel(SharedCourses courses, Value value) : courses_(std::move(courses)), value_(value) {}
  std::string title() const override {
    return value_ == Value::height ? "height of the nodes over time" : "speed of the nodes over time";
  }
  void draw(Canvas& canvas, const Rect& area) override {
    if (courses_->positions.empty() || courses_->times_s.empty()) return;
    const Rect plot = plot_of_courses(area);
    const Scale time = times(), scale = values();
    canvas.fill(plot, canvas.theme().panel);
    draw_y_grid(canvas, plot, scale);
    canvas.clip(plot);
    for (size_t n = 0; n < courses_->positions.size(); ++n) {
      const auto place = [&](size_t i) {
        return dvec2(plot.x + time.at(courses_->times_s[i]) * plot.width,
                     plot.bottom() - scale.at(value(n, i)) * plot.height);
      };
      const Color color = color_of_series(canvas.theme(), n);
      for (size_t i = 1; i < courses_->times_s.size(); ++i) {
        const dvec2 from = place(i - 1), to = place(i);
        canvas.line(from.x, from.y, to.x, to.y, 2.5, color);
      }
      if (courses_->times_s.size() == 1) canvas.disc(place(0).x, place(0).y, 5.0, color);
    }
    canvas.unclip();
    draw_node_names(canvas, area, *courses_);
    canvas.frame(plot, canvas.theme().border);
    draw_x_axis(canvas, plot, time, "time s");
    draw_y_axis(canvas, plot, scale, value_ == Value::height ? "height z m" : "speed m/s");
  }
  void mark_time(Canvas& canvas, const Rect& area, double time_s) override {
    mark_time_in(canvas, plot_of_courses(area), times(), time_s, canvas.theme().over);
  }

 private:
  double value(size_t node, size_t i) const {
    return value_ == Value::height ? courses_->positions[node][i].z : courses_->speeds[node][i];
  }
  Scale times() const { return scale_for(courses_->times_s.front(), courses_->times_s.back()); }
  Scale values() const {
    double low = value_ == Value::speed ? 0.0 : 1e300, high = -1e300;
    for (size_t n = 0; n < courses_->positions.size(); ++n)
      for (size_t i = 0; i < courses_->times_s.size(); ++i)
        low = std::min(low, value(n, i)), high = std::max(high, value(n, i));
    const double pad = std::max(0.08 * (high - low), 0.5);
    return {value_ == Value::speed ? 0.0 : low - pad, high + pad, false};
  }

  SharedCourses courses_;
  Value value_;
};

}  // namespace

void add_pose_panels(const PanelSource& source, Panels& panels) {
  if (!source.has("position")) return;
  const auto courses = std::make_shared<const NodeCourses>(source);
  panels.series.push_back(std::make_unique<TrajectoryPanel>(source, courses));
  panels.series.push_back(std::make_unique<CoursePanel>(courses, CoursePanel::Value::height));
  if (!courses->speeds.empty())
    panels.series.push_back(std::make_unique<CoursePanel>(courses, CoursePanel::Value::speed));
}

}  // namespace greatx::io
