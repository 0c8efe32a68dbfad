// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Speeds and heights of all nodes over the stored ticks.
#include <algorithm>
#include <cmath>
#include <map>

#include "view/panel/panel_kinds.h"

namespace greatx::view {

namespace theme = io::theme;

namespace {

constexpr size_t most_samples = 4096;

class MotionPlot : public Panel {
 public:
  MotionPlot(const PanelChoice& choice, Records records, const char* array, const char* label,
             const char* unit)
      : Panel(choice, std::move(records)),
        array_(array),
        label_(label),
        unit_(unit),
        nodes_(io::node_names(source())) {}
  PanelSize wanted() const override { return {480, 300}; }

 protected:
  virtual double value_of(const dvec3& v) const = 0;

  void load(const io::IndexRow&) override {
    if (sequence() != samples_sequence_) samples_.clear();
    samples_sequence_ = sequence();
    std::map<int64_t, Sample> samples;
    for (const io::IndexRow& row : past(most_samples)) {
      if (const auto known = samples_.find(row.tick); known != samples_.end()) {
        samples.insert(samples_.extract(known));
        continue;
      }
      const Array array = read(row, array_, {DType::f64}, {-1, 3});
      const std::span<const double> v = array.as<double>();
      Sample sample{1e-9 * static_cast<double>(row.time_ns), {}};
      for (size_t n = 0; n + 2 < v.size(); n += 3)
        sample.values.push_back(value_of({v[n], v[n + 1], v[n + 2]}));
      samples.emplace(row.tick, std::move(sample));
    }
    samples_ = std::move(samples);
    line_.clear();
    count_ = 0;
    for (const auto& [tick, sample] : samples_) {
      line_.push_back(&sample);
      count_ = std::max(count_, sample.values.size());
    }
  }

  void paint(io::Canvas& canvas) override {
    const auto [plot, axes] = place_plot(canvas, false);
    plot_ = plot;
    canvas.fill(plot, theme::panel);
    if (count_ == 0) return;
    double low = 1e300, high = -1e300;
    for (const Sample* sample : line_)
      for (const double value : sample->values) low = std::min(low, value), high = std::max(high, value);
    const double pad = std::max(0.05 * (high - low), 0.01);
    values_ = {low - pad, high + pad, false};
    time_ = io::scale_for(line_.front()->time_s, line_.back()->time_s);
    canvas.clip(plot);
    io::draw_y_grid(canvas, plot, values_);
    for (size_t n = 0; n < count_; ++n) draw_node(canvas, n);
    canvas.unclip();
    if (!axes) return;
    canvas.frame(plot, theme::border);
    io::draw_x_axis(canvas, plot, time_, "time s");
    io::draw_y_axis(canvas, plot, values_, fmt::format("{} {}", label_, unit_));
    const size_t named = std::min(count_, static_cast<size_t>(plot.height / theme::line_height / 2));
    for (size_t n = 0; n < std::min<size_t>(named, 6); ++n)
      canvas.text(plot.x + 6, plot.y + 6 + static_cast<int>(n) * 11, name_of(n), 1, io::color_of_series(n));
  }

  std::string text_at(int x, int y) override {
    if (!io::cell_at(plot_, 1, 1, x, y) || count_ == 0) return {};
    const double time_s = value_at_pixel(time_, plot_.x, plot_.width, x);
    const Sample& sample = **std::ranges::min_element(
        line_, {}, [&](const Sample* candidate) { return std::abs(candidate->time_s - time_s); });
    if (sample.values.empty()) return {};
    const auto nearest = std::ranges::min_element(
        sample.values, {}, [&](double value) { return std::abs(place(0.0, value).y - y - 0.5); });
    return fmt::format("{:.4f} s, {}: {} {:.3f} {}", sample.time_s,
                       name_of(static_cast<size_t>(nearest - sample.values.begin())), label_, *nearest,
                       unit_);
  }
  std::string nothing() override { return count_ == 0 ? "no nodes" : ""; }

 private:
  struct Sample {
    double time_s = 0.0;
    std::vector<double> values;  ///< by node
  };
  dvec2 place(double time_s, double value) const {
    return {plot_.x + time_.at(time_s) * plot_.width, plot_.bottom() - values_.at(value) * plot_.height};
  }
  std::string name_of(size_t node) const {
    return node < nodes_.size() ? nodes_[node] : fmt::format("node {}", node);
  }
  void draw_node(io::Canvas& canvas, size_t node) const {
    const io::Color color = io::color_of_series(node);
    bool begun = false;
    dvec2 last{0.0};
    for (const Sample* sample : line_) {
      if (node >= sample->values.size()) continue;
      const dvec2 next = place(sample->time_s, sample->values[node]);
      if (!begun) canvas.disc(next.x, next.y, 1.5, color);
      if (begun && sample != line_.back() && glm::length(next - last) < 1.5) continue;
      if (begun) canvas.line(last.x, last.y, next.x, next.y, 1.6, color);
      begun = true;
      last = next;
    }
    if (begun) canvas.disc(last.x, last.y, 3.0, color);
  }

  const char *array_, *label_, *unit_;
  std::vector<std::string> nodes_;
  std::map<int64_t, Sample> samples_;  ///< by tick
  uint32_t samples_sequence_ = 0;
  std::vector<const Sample*> line_;  ///< in order of time
  size_t count_ = 0;                 ///< of nodes
  io::Scale time_, values_;
  io::Rect plot_;
};

class SpeedPlot : public MotionPlot {
 public:
  SpeedPlot(const PanelChoice& choice, Records records)
      : MotionPlot(choice, std::move(records), "velocity", "speed", "m/s") {}

 protected:
  double value_of(const dvec3& v) const override { return glm::length(v); }
};

class HeightPlot : public MotionPlot {
 public:
  HeightPlot(const PanelChoice& choice, Records records)
      : MotionPlot(choice, std::move(records), "position", "height", "m") {}

 protected:
  double value_of(const dvec3& v) const override { return v.z; }
};

}  // namespace

std::vector<PanelKind> motion_kinds() {
  return {{"pose", "speeds", {"velocity"}, make_view_panel<SpeedPlot>},
          {"pose", "heights", {"position"}, make_view_panel<HeightPlot>}};
}

}  // namespace greatx::view
