// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A channel's H(f) of one link and one pair of ports: over delay and over frequency, now and over time.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>

#include "core/units.h"
#include "draw/sheet/csi_response.h"
#include "view/panel/panel_kinds.h"

namespace greatx::view {

namespace theme = io::theme;

namespace {

using Complex64 = std::complex<float>;
constexpr size_t most_lines_in_memory = 1000;

/// Panels of the array cfr, [rx, rx_ant, tx, tx_ant, time, subcarrier], with knobs for link and ports. Of
/// several time samples they show the first.
class ResponsePanel : public Panel {
 public:
  ResponsePanel(const PanelChoice& choice, Records records) : Panel(choice, std::move(records)) {
    const LinkSizes sizes = link_sizes(spec());
    const auto add = [&](const char* name, int64_t count) {
      add_knob({name, "", 0.0, 0.0, static_cast<double>(std::max<int64_t>(count, 1) - 1), true});
    };
    add("receiver", sizes.receivers);
    add("receiver port", sizes.receiver_ports);
    add("transmitter", sizes.transmitters);
    add("transmitter port", sizes.transmitter_ports);
    spacing_hz_ = io::number_of(io::metadata_of(source()), "subcarrier_spacing_hz", 1.0, 1e-6, 1e15);
  }
  PanelSize wanted() const override { return {480, 320}; }

 protected:
  std::vector<Complex64> response(const io::IndexRow& row) const {
    const Array cfr = read(row, "cfr", {DType::complex64}, {0, 0, 0, 0, 0, 0});
    const auto extent = [&](size_t axis) { return static_cast<size_t>(cfr.shape[axis]); };
    const auto chosen = [&](const char* name) { return static_cast<size_t>(knob(name)); };
    const size_t pair =
        ((chosen("receiver") * extent(1) + chosen("receiver port")) * extent(2) + chosen("transmitter")) *
            extent(3) +
        chosen("transmitter port");
    const auto values = cfr.as<Complex64>().subspan(pair * extent(4) * extent(5), extent(5));
    return {values.begin(), values.end()};
  }
  /// Of subcarrier k of n from the carrier.
  double offset_hz(size_t k, size_t n) const {
    return (static_cast<double>(k) - static_cast<double>(n / 2)) * spacing_hz_;
  }
  io::Scale frequency_scale(size_t n) const {
    const double low = -(static_cast<double>(n / 2) + 0.5) * spacing_hz_;
    return {low * 1e-6, (low + static_cast<double>(n) * spacing_hz_) * 1e-6, false};
  }
  /// What the values belong to, if there is more than one link or pair.
  std::string link_text() const {
    std::string text;
    for (const PanelKnob& k : knobs())
      if (k.most > 0.0 && k.name != "ticks") text += fmt::format("\n{} {:.0f}", k.name, k.value);
    return text;
  }
  double spacing_hz_ = 1.0;
};

/// Decibels over delay or frequency from left to right and over the stored ticks, the newest at the top.
/// Every tick has a line of the same height.
class Waterfall : public ResponsePanel {
 public:
  Waterfall(const PanelChoice& choice, Records records) : ResponsePanel(choice, std::move(records)) {
    add_knob({"ticks", "", 100.0, 2.0, static_cast<double>(most_lines_in_memory), true});
  }

 protected:
  struct Line {
    int64_t time_ns = 0;
    std::vector<float> db;
    size_t end = 0;  ///< of the cells worth seeing
  };
  virtual std::vector<double> decibels(std::span<const Complex64> cfr) const = 0;
  /// The horizontal axis for lines of `cells` cells, of which it may show the first ones only.
  struct Axis {
    io::Scale scale;
    size_t cells = 0;
    std::string label;
  };
  virtual Axis axis(size_t cells, size_t end) const = 0;
  virtual size_t end_of(std::span<const double> db) const { return db.size(); }
  virtual std::string place_text(size_t cell, size_t cells) const = 0;

  void load(const io::IndexRow&) override {
    std::array<double, 4> link{};
    for (size_t i = 0; i < link.size(); ++i) link[i] = knobs()[i].value;
    if (link != lines_link_ || sequence() != lines_sequence_) lines_.clear();
    lines_link_ = link;
    lines_sequence_ = sequence();
    const std::vector<io::IndexRow> rows = past(static_cast<size_t>(knob("ticks")));
    std::map<int64_t, Line> lines;
    for (const io::IndexRow& row : rows) {
      if (const auto known = lines_.find(row.tick); known != lines_.end()) {
        lines.insert(lines_.extract(known));
        continue;
      }
      const std::vector<double> db = decibels(response(row));
      lines.emplace(row.tick, Line{row.time_ns, {db.begin(), db.end()}, end_of(db)});
    }
    lines_ = std::move(lines);
  }

  void paint(io::Canvas& canvas) override {
    const auto [plot, axes] = place_plot(canvas, true);
    plot_ = plot;
    shown_.clear();
    for (auto line = lines_.rbegin(); line != lines_.rend(); ++line) shown_.push_back(&line->second);
    slots_ = std::min(static_cast<int>(knob("ticks")), plot.height);
    shown_.resize(std::min(shown_.size(), static_cast<size_t>(slots_)));
    canvas.fill(plot, theme::panel);
    if (shown_.empty()) return;
    float low = 1e30f, high = -1e30f;
    size_t end = 0;
    for (const Line* line : shown_) end = std::max(end, line->end);
    axis_ = axis(shown_[0]->db.size(), end);
    for (const Line* line : shown_)
      for (const float db : line->db) low = std::min(low, db), high = std::max(high, db);
    const io::Scale color = io::scale_for(std::max<double>(low, high - io::csi_range_db), high);
    // A line may take several rows of pixels, which are the same.
    std::vector<io::Color> colors(static_cast<size_t>(plot.width));
    for (int slot = 0; slot < std::ssize(shown_); ++slot) {
      for (int x = 0; x < plot.width; ++x)
        colors[static_cast<size_t>(x)] =
            io::viridis(color.at(strongest(*shown_[static_cast<size_t>(slot)], x)));
      const int top = first_pixel(slot), bottom = first_pixel(slot + 1);
      canvas.raster({plot.x, plot.y + top, plot.width, bottom - top}, plot.width, 1,
                    [&](int x, int) { return colors[static_cast<size_t>(x)]; });
    }
    if (!axes) return;
    canvas.frame(plot, theme::border);
    io::draw_x_axis(canvas, plot, axis_.scale, axis_.label);
    draw_times(canvas);
    io::draw_color_scale(canvas, {plot.right() + 14, plot.y, 14, plot.height}, color, io::viridis, "dB");
  }

  std::string text_at(int x, int y) override {
    if (!io::cell_at(plot_, 1, 1, x, y) || shown_.empty()) return {};
    const int slot = slot_of(y - plot_.y);
    if (slot >= std::ssize(shown_)) return {};
    const Line& line = *shown_[static_cast<size_t>(slot)];
    const size_t cell = strongest_cell(line, x - plot_.x);
    return fmt::format("{:.4f} s, {}: {:.2f} dB", 1e-9 * static_cast<double>(line.time_ns),
                       place_text(cell, line.db.size()), line.db[cell]) +
           link_text();
  }

 private:
  int first_pixel(int slot) const {
    return static_cast<int>((int64_t{slot} * plot_.height + slots_ - 1) / slots_);
  }
  int slot_of(int y) const { return static_cast<int>(int64_t{y} * slots_ / plot_.height); }
  /// Of the cells below column x of the plot: a narrow peak is not lost in a narrow plot.
  size_t strongest_cell(const Line& line, int x) const {
    const size_t cells = std::min(axis_.cells, line.db.size()), width = static_cast<size_t>(plot_.width),
                 first = static_cast<size_t>(x) * cells / width,
                 last = std::max(first + 1, (static_cast<size_t>(x) + 1) * cells / width);
    return static_cast<size_t>(std::max_element(line.db.begin() + static_cast<std::ptrdiff_t>(first),
                                                line.db.begin() + static_cast<std::ptrdiff_t>(last)) -
                               line.db.begin());
  }
  float strongest(const Line& line, int x) const { return line.db[strongest_cell(line, x)]; }
  void draw_times(io::Canvas& canvas) const {
    const int labels = std::max(2, plot_.height / 60);
    for (int k = 0; k < labels; ++k) {
      const int slot = k * (slots_ - 1) / (labels - 1);
      if (slot >= std::ssize(shown_)) break;
      const int y = plot_.y + (first_pixel(slot) + first_pixel(slot + 1)) / 2;
      canvas.fill({plot_.x - 6, y, 5, 1}, theme::dim);
      canvas.text(
          plot_.x - 10, std::max(plot_.y, y - 7),
          fmt::format("{:.4g}", 1e-9 * static_cast<double>(shown_[static_cast<size_t>(slot)]->time_ns)),
          theme::text_scale, theme::dim, io::Align::right);
    }
    canvas.text(plot_.x - 10, plot_.bottom() + 9, "s", theme::text_scale, theme::text, io::Align::right);
  }

  std::map<int64_t, Line> lines_;  ///< by tick
  std::array<double, 4> lines_link_{};
  uint32_t lines_sequence_ = 0;
  std::vector<const Line*> shown_;  ///< newest first
  int slots_ = 1;                   ///< lines that there is room for
  Axis axis_;
  io::Rect plot_;
};

/// The power-delay profile. The axis ends behind the last echo worth seeing, at a round number, so that it
/// stays while little changes.
class DelayWaterfall : public Waterfall {
 public:
  using Waterfall::Waterfall;

 protected:
  std::vector<double> decibels(std::span<const Complex64> cfr) const override {
    return io::impulse_response_db(cfr);
  }
  size_t end_of(std::span<const double> db) const override {
    const double threshold = *std::ranges::max_element(db) - 0.9 * io::csi_range_db;
    // The last tenth is what the window spreads to negative delays.
    for (size_t i = 9 * db.size() / 10; i > 16; --i)
      if (db[i - 1] > threshold) return i;
    return 16;
  }
  Axis axis(size_t cells, size_t end) const override {
    const double cell_s = 1.0 / (static_cast<double>(cells) * spacing_hz_);
    const double wanted_s = 1.125 * static_cast<double>(end) * cell_s;
    double round_s = io::round_down(wanted_s);
    while (round_s < wanted_s) round_s = io::round_down(round_s * 2.6);
    const auto kept = std::min(cells, static_cast<size_t>(std::ceil(round_s / cell_s)));
    const double longest_s = static_cast<double>(kept) * cell_s;
    const bool micro = longest_s > 2e-6;
    return {{0.0, longest_s * (micro ? 1e6 : 1e9), false}, kept, micro ? "delay us" : "delay ns"};
  }
  std::string place_text(size_t cell, size_t cells) const override {
    const double delay_s = static_cast<double>(cell) / (static_cast<double>(cells) * spacing_hz_);
    return fmt::format("{} ({})", with_prefix(delay_s, "s"), with_prefix(delay_s * speed_of_light, "m"));
  }
};

class FrequencyWaterfall : public Waterfall {
 public:
  using Waterfall::Waterfall;

 protected:
  std::vector<double> decibels(std::span<const Complex64> cfr) const override {
    return io::magnitudes_db(cfr);
  }
  Axis axis(size_t cells, size_t) const override { return {frequency_scale(cells), cells, "f - fc MHz"}; }
  std::string place_text(size_t cell, size_t cells) const override {
    return "fc + " + with_prefix(offset_hz(cell, cells), "Hz");
  }
};

/// |H(f)| of the newest record.
class ResponsePlot : public ResponsePanel {
 public:
  using ResponsePanel::ResponsePanel;

 protected:
  void load(const io::IndexRow& row) override {
    response_ = response(row);
    db_ = io::magnitudes_db(response_);
    const auto [low, high] = std::ranges::minmax(db_);
    vertical_ = io::scale_for(std::max(low, high - io::csi_range_db) - 1.0, high + 1.0);
  }
  void paint(io::Canvas& canvas) override {
    const auto [plot, axes] = place_plot(canvas, false);
    plot_ = plot;
    canvas.fill(plot, theme::panel);
    const io::Scale frequency = frequency_scale(db_.size());
    canvas.clip(plot);
    io::draw_y_grid(canvas, plot, vertical_);
    // Where many subcarriers share a column of pixels: from the weakest to the strongest.
    const size_t width = static_cast<size_t>(plot.width);
    double before_x = 0.0, before_y = 0.0;
    for (size_t x = 0; x < std::min(width, db_.size()); ++x) {
      const size_t steps = std::min(width, db_.size()), first = x * db_.size() / steps,
                   last = std::max(first + 1, (x + 1) * db_.size() / steps);
      const auto [low, high] = std::minmax_element(db_.begin() + static_cast<std::ptrdiff_t>(first),
                                                   db_.begin() + static_cast<std::ptrdiff_t>(last));
      const double at = plot.x + (static_cast<double>(x) + 0.5) * plot.width / static_cast<double>(steps);
      const double top = plot.y + pixel_of(*high), bottom = plot.y + pixel_of(*low);
      if (x > 0) canvas.line(before_x, before_y, at, top, 1.6, io::color_of_series(0));
      if (bottom > top) canvas.line(at, top, at, bottom, 1.6, io::color_of_series(0));
      before_x = at;
      before_y = bottom;
    }
    canvas.unclip();
    if (!axes) return;
    canvas.frame(plot, theme::border);
    io::draw_x_axis(canvas, plot, frequency, "f - fc MHz");
    io::draw_y_axis(canvas, plot, vertical_, "|H| dB");
  }
  std::string text_at(int x, int y) override {
    const auto cell = io::cell_at(plot_, std::ssize(db_), 1, x, y);
    if (!cell) return {};
    const auto k = static_cast<size_t>(cell->column);
    return fmt::format("fc + {}, subcarrier {}: {:.2f} dB, phase {:.1f} deg",
                       with_prefix(offset_hz(k, db_.size()), "Hz"), k, db_[k],
                       degrees(std::arg(std::complex<double>(response_[k])))) +
           link_text();
  }

 private:
  int pixel_of(double db) const {
    return static_cast<int>(std::lround((1.0 - vertical_.at(db)) * (plot_.height - 1)));
  }
  std::vector<Complex64> response_;
  std::vector<double> db_;
  io::Scale vertical_;
  io::Rect plot_;
};

}  // namespace

std::vector<PanelKind> channel_kinds() {
  return {{"csi", "delay over time", {"cfr"}, make_view_panel<DelayWaterfall>},
          {"csi", "|H| over frequency", {"cfr"}, make_view_panel<ResponsePlot>},
          {"csi", "|H| over frequency and time", {"cfr"}, make_view_panel<FrequencyWaterfall>}};
}

}  // namespace greatx::view
