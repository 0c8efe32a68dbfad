// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panels of event cameras.
#include <algorithm>
#include <array>
#include <cmath>

#include "draw/sheet/picture_panel.h"

namespace greatx::io {

namespace {

constexpr Color event_on{235, 45, 35}, event_off{35, 75, 240};

/// Shows the events since the previous record, summed by pixel.
class EventPanel : public FramePanel {
 public:
  EventPanel(const PanelSource& source, int64_t width, int64_t height)
      : source_(source), width_(width), height_(height) {}
  std::string title() const override { return source_.spec().name + ": ON red, OFF blue"; }
  double aspect() const override { return static_cast<double>(height_) / static_cast<double>(width_); }

  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const IndexRow& record = source_.chosen[row];
    const auto& [x, y, p] = load(row);
    try {
      canvas.picture(picture,
                     event_picture(x.as<uint16_t>(), y.as<uint16_t>(), p.as<uint8_t>(), width_, height_));
    } catch (const UserError& error) {
      throw_user_error("{}, tick {}: {}", source_.place(), record.tick, error.what());
    }
    const size_t count = p.as<uint8_t>().size();
    const auto on = static_cast<size_t>(std::count(p.as<uint8_t>().begin(), p.as<uint8_t>().end(), 1));
    std::string text = fmt::format("ON {} OFF {}", on, count - on);
    if (const double ms = interval_ms(record); ms > 0.0) text += fmt::format(" in {:.4g} ms", ms);
    canvas.text(legend.x, legend.y + 4, text, theme::text_scale, canvas.theme().dim);
  }

  std::vector<KeyEntry> key(const Theme&) override {
    return {{KeyEntry::Mark::square, event_on, "ON: brighter than before"},
            {KeyEntry::Mark::square, event_off, "OFF: darker than before"}};
  }
  std::string nothing_of(size_t row) override { return load(row).p.as<uint8_t>().empty() ? "no events" : ""; }
  std::string value_at(const Rect& picture, size_t row, int x, int y, const SceneNames&) override {
    const std::optional<RasterCell> cell = cell_at(picture, width_, height_, x, y);
    if (!cell) return {};
    const Events& events = load(row);
    const std::span<const uint16_t> xs = events.x.as<uint16_t>(), ys = events.y.as<uint16_t>();
    const std::span<const uint8_t> ps = events.p.as<uint8_t>();
    size_t counts[2] = {0, 0};
    for (size_t i = 0; i < ps.size(); ++i)
      if (xs[i] == cell->column && ys[i] == cell->row) ++counts[ps[i] != 0];
    return fmt::format("({}, {})  ON {} OFF {}", cell->column, cell->row, counts[1], counts[0]);
  }

 private:
  /// The events of the row, kept until another row's are asked for.
  struct Events {
    Array x, y, p;
  };
  const Events& load(size_t row) {
    if (kept_row_ == row) return kept_;
    kept_row_.reset();
    const IndexRow& record = source_.chosen[row];
    kept_ = {source_.load(record, "x", {DType::u16}, {-1}), source_.load(record, "y", {DType::u16}, {-1}),
             source_.load(record, "p", {DType::u8}, {-1})};
    expect_same_rows(source_, {&kept_.x, &kept_.y, &kept_.p});
    kept_row_ = row;
    return kept_;
  }
  double interval_ms(const IndexRow& record) const {
    const std::vector<IndexRow> rows = source_.records.records_of(source_.sequence, source_.sensor);
    for (size_t i = 1; i < rows.size(); ++i)
      if (rows[i].tick == record.tick)
        return 1e-6 * static_cast<double>(rows[i].time_ns - rows[i - 1].time_ns);
    return 0.0;
  }
  PanelSource source_;
  int64_t width_, height_;
  std::optional<size_t> kept_row_;
  Events kept_;
};

/// Shows the grey difference pictures as they are.
class DifferencePanel : public PicturePanel {
 public:
  explicit DifferencePanel(const PanelSource& source)
      : PicturePanel(source, "difference_picture", "differences", {DType::u8}) {}
  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const Array& grey = load(row);
    const std::span<const uint8_t> values = grey.as<uint8_t>();
    Array rgb(DType::u8, {grey.shape[0], grey.shape[1], 3});
    for (size_t i = 0; i < values.size(); ++i) std::fill_n(rgb.as<uint8_t>().begin() + 3 * i, 3, values[i]);
    canvas.picture(picture, rgb);
    caption(canvas, legend,
            fmt::format("{} brighter  {} darker", std::count(values.begin(), values.end(), 255),
                        std::count(values.begin(), values.end(), 0)));
  }

 protected:
  std::string text_of(size_t, const Array& grey, size_t i, const SceneNames&) override {
    const uint8_t value = grey.as<uint8_t>()[i];
    return value == 255 ? "brighter" : value == 0 ? "darker" : "no change";
  }
};

std::unique_ptr<FramePanel> make_events(const PanelSource& source) {
  const JsonDocument metadata = metadata_of(source);
  const JsonValue root = metadata.root();
  constexpr int64_t longest_side = 16384;
  if (!root.has("width") || !root.has("height")) return nullptr;
  return std::make_unique<EventPanel>(source, root.at("width").integer(1, longest_side),
                                      root.at("height").integer(1, longest_side));
}

}  // namespace

Array event_picture(std::span<const uint16_t> x, std::span<const uint16_t> y, std::span<const uint8_t> p,
                    int64_t width, int64_t height) {
  // The numbers of events of each pixel: ON in [0], OFF in [1].
  std::vector<std::array<uint32_t, 2>> counts(static_cast<size_t>(width * height));
  for (size_t i = 0; i < p.size(); ++i) {
    if (x[i] >= width || y[i] >= height)
      throw_user_error("event {}: at ({}, {}), outside of {} x {} pixels", i, x[i], y[i], width, height);
    ++counts[static_cast<size_t>(y[i] * width + x[i])][p[i] == 0];
  }
  // One event has 60 % of the full colour, three or more events have all of it.
  const double grey[3] = {128, 128, 128},
               red[3] = {double{event_on.r}, double{event_on.g}, double{event_on.b}},
               blue[3] = {double{event_off.r}, double{event_off.g}, double{event_off.b}};
  Array rgb(DType::u8, {height, width, 3});
  const std::span<uint8_t> out = rgb.as<uint8_t>();
  std::ranges::fill(out, uint8_t{128});
  const auto color_of = [&](uint32_t ons, uint32_t offs) {
    const uint64_t count = uint64_t{ons} + offs;
    const double strength = std::min(1.0, 0.4 + 0.2 * static_cast<double>(count));
    const double share = static_cast<double>(ons) / static_cast<double>(count);
    std::array<uint8_t, 3> color;
    for (size_t c = 0; c < 3; ++c)
      color[c] = static_cast<uint8_t>(
          std::lround(grey[c] + strength * (blue[c] + share * (red[c] - blue[c]) - grey[c])));
    return color;
  };
  // Most pixels with events have one.
  const std::array<uint8_t, 3> one_on = color_of(1, 0), one_off = color_of(0, 1);
  for (size_t i = 0; i < counts.size(); ++i) {
    const auto [on, off] = counts[i];
    if (on + off == 0) continue;
    const std::array<uint8_t, 3> color = on + off > 1 ? color_of(on, off) : on == 1 ? one_on : one_off;
    std::copy_n(color.begin(), 3, &out[3 * i]);
  }
  return rgb;
}

std::vector<FrameKind> event_frames() {
  return {{"events", {"x", "y", "p"}, make_events, "events"},
          {"differences", {"difference_picture"}, make_frame<DifferencePanel>, "differences"}};
}

}  // namespace greatx::io
