// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The time surface of an event camera: exp(-(t - t_last) / tau) of the newest event of each pixel (X. Lagorce
// et al., "HOTS: A Hierarchy of Event-Based Time-Surfaces for Pattern Recognition", TPAMI 39, 2017, eq. 3).
#include <algorithm>
#include <cmath>
#include <limits>

#include "draw/sheet/sheet_tiles.h"
#include "view/panel/panel_kinds.h"

namespace greatx::view {

namespace theme = io::theme;

namespace {

constexpr int64_t no_event = std::numeric_limits<int64_t>::min();
/// Older events are darker than a step of a byte.
constexpr double taus_seen = 6.0;
/// A jump in time reads no more.
constexpr size_t most_event_records = 1024;

class TimeSurface : public Panel {
 public:
  TimeSurface(const PanelChoice& choice, Records records) : Panel(choice, std::move(records)) {
    const io::JsonDocument metadata = io::metadata_of(source());
    constexpr int64_t longest_side = 16384;
    width_ = metadata.root().at("width").integer(1, longest_side);
    height_ = metadata.root().at("height").integer(1, longest_side);
    constexpr int64_t most_pixels = int64_t{1} << 26;
    if (width_ * height_ > most_pixels)
      throw_user_error("{}: expected at most {} pixels, found {} x {}", spec().name, most_pixels, width_,
                       height_);
    add_knob({"tau", "ms", 30.0, 0.01, 10'000.0, false});
  }

 protected:
  void load(const io::IndexRow& row) override {
    const double tau_ms = tau_ms_ = knob("tau");
    std::vector<io::IndexRow> rows = past(most_event_records);
    if (done_ && done_sequence_ == sequence() && done_tick_ <= row.tick && tau_ms <= done_tau_ms_) {
      std::erase_if(rows, [&](const io::IndexRow& r) { return r.tick <= done_tick_; });
    } else {
      newest_.assign(static_cast<size_t>(width_ * height_), no_event);
      brighter_.assign(newest_.size(), 0);
      const auto oldest_ns = row.time_ns - static_cast<int64_t>(1e6 * taus_seen * tau_ms);
      std::erase_if(rows, [&](const io::IndexRow& r) { return r.time_ns < oldest_ns; });
      done_tau_ms_ = tau_ms;
    }
    done_ = false;  // until all of them are in
    for (const io::IndexRow& r : rows) add_events(r);
    done_ = true;
    done_sequence_ = sequence();
    done_tick_ = row.tick;
    now_ns_ = row.time_ns;
  }

  void paint(io::Canvas& canvas) override {
    const int legend = canvas.height() >= 4 * io::sheet::legend_height ? io::sheet::legend_height : 0;
    const io::Rect tile{0, 0, canvas.width(), canvas.height() - legend};
    canvas.fill(tile, theme::panel);
    picture_ = io::fit(tile, static_cast<double>(height_) / static_cast<double>(width_));
    seen_ = false;
    // Each pixel of the canvas shows the newest event of the pixels below it, so that none is lost.
    canvas.raster(picture_, picture_.width, picture_.height, [&](int x, int y) {
      const size_t i = newest_below(x, y);
      if (newest_[i] == no_event) return io::Color{128, 128, 128};
      const double share = decay(i);
      seen_ = seen_ || share > 0.0;
      const double full[2][3] = {{35, 75, 240}, {235, 45, 35}};
      const auto mixed = [&](int c) {
        return static_cast<uint8_t>(128.0 + share * (full[brighter_[i]][c] - 128.0) + 0.5);
      };
      return io::Color{mixed(0), mixed(1), mixed(2)};
    });
    if (legend > 0)
      canvas.text(4, tile.bottom() + 6, fmt::format("ON red OFF blue, tau {:.4g} ms", knob("tau")),
                  theme::text_scale, theme::dim);
  }

  std::string text_at(int x, int y) override {
    if (!io::cell_at(picture_, 1, 1, x, y)) return {};
    const size_t i = newest_below(x - picture_.x, y - picture_.y);
    const std::string place =
        fmt::format("({}, {})  ", i % static_cast<size_t>(width_), i / static_cast<size_t>(width_));
    if (newest_[i] == no_event || decay(i) == 0.0) return place + "no event";
    return place + fmt::format("{} {:.4g} ms ago: {:.4f}", brighter_[i] ? "ON" : "OFF",
                               1e-6 * static_cast<double>(now_ns_ - newest_[i]), decay(i));
  }
  std::string nothing() override { return seen_ ? "" : "no events"; }

 private:
  void add_events(const io::IndexRow& row) {
    const Array t = read(row, "t", {DType::i64}, {-1}), x = read(row, "x", {DType::u16}, {-1}),
                y = read(row, "y", {DType::u16}, {-1}), p = read(row, "p", {DType::u8}, {-1});
    io::expect_same_rows(source(), {&t, &x, &y, &p});
    const std::span<const int64_t> times = t.as<int64_t>();
    const std::span<const uint16_t> columns = x.as<uint16_t>(), lines = y.as<uint16_t>();
    const std::span<const uint8_t> signs = p.as<uint8_t>();
    for (size_t i = 0; i < signs.size(); ++i) {
      const uint16_t column = columns[i], line = lines[i];
      if (column >= width_ || line >= height_)
        throw_user_error("{}, tick {}: event {}: at ({}, {}), outside of {} x {} pixels", source().place(),
                         row.tick, i, column, line, width_, height_);
      const auto at = static_cast<size_t>(line * width_ + column);
      if (times[i] < newest_[at]) continue;
      newest_[at] = times[i];
      brighter_[at] = signs[i] != 0;
    }
  }
  double decay(size_t i) const {
    const double age = 1e-6 * static_cast<double>(now_ns_ - newest_[i]) / tau_ms_;
    return age > taus_seen ? 0.0 : std::exp(-std::max(age, 0.0));
  }
  /// The pixel with the newest event below pixel (x, y) of the picture on the canvas.
  size_t newest_below(int x, int y) const {
    const int64_t x0 = x * width_ / picture_.width, y0 = y * height_ / picture_.height,
                  x1 = std::max(x0 + 1, (x + 1) * width_ / picture_.width),
                  y1 = std::max(y0 + 1, (y + 1) * height_ / picture_.height);
    auto found = static_cast<size_t>(y0 * width_ + x0);
    for (int64_t v = y0; v < y1; ++v)
      for (int64_t u = x0; u < x1; ++u)
        if (const auto i = static_cast<size_t>(v * width_ + u); newest_[i] > newest_[found]) found = i;
    return found;
  }

  int64_t width_ = 1, height_ = 1;
  std::vector<int64_t> newest_;    ///< ns, by pixel
  std::vector<uint8_t> brighter_;  ///< whether that event is ON
  bool done_ = false, seen_ = false;
  uint32_t done_sequence_ = 0;  ///< the newest record whose events are in
  int64_t done_tick_ = 0, now_ns_ = 0;
  double tau_ms_ = 1.0, done_tau_ms_ = 0.0;  ///< events are there for so long
  io::Rect picture_;
};

}  // namespace

std::vector<PanelKind> time_surface_kinds() {
  return {{"event_camera", "time surface", {"t", "x", "y", "p"}, make_view_panel<TimeSurface>}};
}

}  // namespace greatx::view
