// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panel of poses.
#include <algorithm>
#include <cmath>

#include "draw/sheet/panels.h"

namespace greatx::io {

namespace {

constexpr size_t most_points = 2000;  ///< approximate limit for the line of one node

/// Shows the trajectories of the nodes from above, with north up and the same scale on both axes.
class TrajectoryPanel : public SeriesPanel {
 public:
  explicit TrajectoryPanel(const PanelSource& source) : source_(source), names_(node_names(source)) {
    const std::vector<IndexRow> rows = source.records.records_of(source.sequence, source.sensor);
    const size_t step = std::max<size_t>(1, rows.size() / most_points);
    for (size_t i = 0; i < rows.size();
         i += (i + step < rows.size() || i + 1 == rows.size() ? step : rows.size() - 1 - i)) {
      const Array array = source.load(rows[i], "position", {DType::f64}, {-1, 3});
      const std::span<const double> p = array.as<double>();
      lines_.resize(p.size() / 3);
      for (size_t n = 0; n < lines_.size(); ++n) lines_[n].push_back({p[3 * n], p[3 * n + 1]});
    }
  }
  std::string title() const override { return "trajectories from above"; }

  void draw(Canvas& canvas, const Rect& area) override {
    const Rect plot{area.x + 92, area.y + 8, area.width - 104, area.height - 16 - 3 * theme::line_height};
    if (lines_.empty()) return;
    dvec2 low(1e300), high(-1e300);
    for (const auto& line : lines_) {
      for (const dvec2& point : line) {
        low = glm::min(low, point);
        high = glm::max(high, point);
      }
    }
    // Large coordinates (UTM) are shown relative to a round offset, to keep the labels short.
    dvec2 offset(0.0);
    for (int c = 0; c < 2; ++c)
      if (std::max(std::abs(low[c]), std::abs(high[c])) > 2e4)
        offset[c] = 1000.0 * std::floor(low[c] / 1000.0);
    const dvec2 middle = 0.5 * (low + high), span = glm::max(1.15 * (high - low), dvec2(4.0));
    const double metres_per_pixel = std::max(span.x / plot.width, span.y / plot.height);
    const dvec2 half = 0.5 * metres_per_pixel * dvec2(plot.width, plot.height);
    const Scale x{middle.x - half.x - offset.x, middle.x + half.x - offset.x},
        y{middle.y - half.y - offset.y, middle.y + half.y - offset.y};
    canvas.fill(plot, theme::panel);
    canvas.clip(plot);
    for (const double value : x.ticks(std::max(2, plot.width / 110)))
      canvas.fill({plot.x + static_cast<int>(x.at(value) * plot.width), plot.y, 1, plot.height}, theme::grid);
    for (const double value : y.ticks(std::max(2, plot.height / 60)))
      canvas.fill({plot.x, plot.bottom() - static_cast<int>(y.at(value) * plot.height), plot.width, 1},
                  theme::grid);
    const auto place = [&](const dvec2& point) {
      return dvec2(plot.x + x.at(point.x - offset.x) * plot.width,
                   plot.bottom() - y.at(point.y - offset.y) * plot.height);
    };
    for (size_t n = 0; n < lines_.size(); ++n) draw_line(canvas, lines_[n], color_of_series(n), place);
    canvas.unclip();
    draw_legend(canvas, plot);
    canvas.frame(plot, theme::border);
    const auto label = [](const char* text, double from) {
      return from == 0.0 ? fmt::format("{} m", text) : fmt::format("{} - {:.0f} m", text, from);
    };
    draw_x_axis(canvas, plot, x, label("east", offset.x));
    draw_y_axis(canvas, plot, y, label("north", offset.y));
  }

 private:
  template <typename Place>
  static void draw_line(Canvas& canvas, const std::vector<dvec2>& line, Color color, const Place& place) {
    dvec2 last = place(line[0]);
    for (const dvec2& point : line) {
      const dvec2 next = place(point);
      if (glm::length(next - last) < 1.5) continue;
      canvas.line(last.x, last.y, next.x, next.y, 2.5, color);
      last = next;
    }
    const dvec2 start = place(line.front()), end = place(line.back());
    if (glm::length(end - start) > 3.0) canvas.circle(start.x, start.y, 5.0, 2.0, color);
    canvas.disc(end.x, end.y, 5.5, color);
  }
  void draw_legend(Canvas& canvas, const Rect& plot) const {
    const int shown = std::min(static_cast<int>(lines_.size()), 8);
    for (int n = 0; n < shown; ++n) {
      const auto index = static_cast<size_t>(n);
      const std::string name = index < names_.size() ? names_[index] : fmt::format("node {}", n);
      const int y = plot.y + 10 + n * theme::line_height;
      canvas.fill({plot.x + 6, y - 4, Canvas::text_width(name, theme::text_scale) + 28, theme::line_height},
                  theme::panel, 0.8);
      canvas.disc(plot.x + 16, y + 7, 5.0, color_of_series(index));
      canvas.text(plot.x + 28, y, name, theme::text_scale, theme::text);
    }
  }

  PanelSource source_;
  std::vector<std::string> names_;
  std::vector<std::vector<dvec2>> lines_;  ///< [nodes][points] world x, y
};

}  // namespace

void add_pose_panels(const PanelSource& source, Panels& panels) {
  if (source.has("position")) panels.series.push_back(std::make_unique<TrajectoryPanel>(source));
}

}  // namespace greatx::io
