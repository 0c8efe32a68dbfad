// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A LiDAR's sweep as a picture: azimuth from left to right, the scanner's channels from top to bottom, range
// as colour. Patterns without channels are shown over elevation.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/units.h"
#include "draw/sheet/picture_panel.h"
#include "view/panel/panel_kinds.h"

namespace greatx::view {

namespace theme = io::theme;

namespace {

constexpr int64_t most_sweep_columns = 4096, most_channels = 65536;
constexpr int64_t most_sweep_cells = int64_t{1} << 23, lines_without_channels = 64;
constexpr uint32_t empty_cell = ~0u;

io::Color range_color(double t) { return io::turbo(1.0 - t); }

class RangeImage : public Panel {
 public:
  RangeImage(const PanelChoice& choice, Records records) : Panel(choice, std::move(records)) {
    const io::JsonDocument metadata = io::metadata_of(source());
    const io::JsonValue root = metadata.root();
    const std::string pattern = root.has("pattern") ? root.at("pattern").text() : "";
    if (pattern == "spinning") {
      columns_ = root.at("azimuth_steps").integer(1, 100'000'000);
      const double start = root.at("azimuth_start_deg").number(-1e6, 1e6),
                   span = std::abs(root.at("azimuth_span_deg").number(-1e6, 1e6));
      if (span < 359.0) middle_deg_ = start + 0.5 * span, span_deg_ = std::max(span, 0.1);
      for (const io::JsonValue& elevation : root.at("elevations_deg").list(most_channels))
        elevations_deg_.push_back(elevation.number(-91.0, 91.0));
    } else if (pattern == "raster") {
      columns_ = root.at("columns").integer(1, 100'000'000);
      const std::vector<io::JsonValue> azimuth = root.at("azimuth_deg").tuple(2),
                                       elevation = root.at("elevation_deg").tuple(2);
      const double first = azimuth[0].number(-1e6, 1e6), last = azimuth[1].number(-1e6, 1e6);
      const double low = elevation[0].number(-91.0, 91.0), high = elevation[1].number(-91.0, 91.0);
      middle_deg_ = 0.5 * (first + last);
      span_deg_ = std::clamp(std::abs(last - first), 0.1, 360.0);
      const int64_t rows = root.at("rows").integer(1, most_channels);
      for (int64_t i = 0; i < rows; ++i)
        elevations_deg_.push_back(low + (high - low) * static_cast<double>(i) /
                                            static_cast<double>(std::max<int64_t>(rows - 1, 1)));
    }
    if (!source().has("ring")) elevations_deg_.clear();
    const int64_t lines = std::max<int64_t>(std::ssize(elevations_deg_), lines_without_channels);
    columns_ = std::min({columns_, most_sweep_columns, most_sweep_cells / lines});
    // Channels need not ascend; the highest goes to the top.
    line_of_ring_.resize(elevations_deg_.size());
    ring_of_line_.resize(elevations_deg_.size());
    std::iota(ring_of_line_.begin(), ring_of_line_.end(), 0u);
    std::ranges::stable_sort(ring_of_line_, std::ranges::greater(),
                             [&](uint32_t ring) { return elevations_deg_[ring]; });
    for (uint32_t line = 0; line < ring_of_line_.size(); ++line) line_of_ring_[ring_of_line_[line]] = line;
    by_ring_ = !elevations_deg_.empty();
  }
  PanelSize wanted() const override { return {640, 200}; }

 protected:
  void load(const io::IndexRow& row) override {
    points_ = read(row, "points", {DType::f32}, {-1, 4});
    const auto count = static_cast<size_t>(points_.shape[0]);
    ranges_.resize(count);
    const float* const p = points_.as<float>().data();
    for (size_t i = 0; i < count; ++i) ranges_[i] = glm::length(vec3(p[4 * i], p[4 * i + 1], p[4 * i + 2]));
    if (source().has("range")) {
      const Array along = read(row, "range", {DType::f32}, {-1});
      io::expect_same_rows(source(), {&points_, &along});
      std::ranges::copy(along.as<float>(), ranges_.begin());
    }
    instances_ = Array();
    if (source().has("instance")) {
      instances_ = read(row, "instance", {DType::u32}, {-1});
      io::expect_same_rows(source(), {&points_, &instances_});
    }
    std::vector<uint32_t> lines = by_ring_ ? lines_by_ring(row) : lines_by_elevation();
    cells_.assign(static_cast<size_t>(columns_ * lines_), empty_cell);
    float low = std::numeric_limits<float>::infinity(), high = 0.0f;
    for (size_t i = 0; i < count; ++i) {
      const double azimuth = degrees(std::atan2(double(p[4 * i + 1]), double(p[4 * i])));
      const double from_middle = std::remainder(azimuth - middle_deg_, 360.0);
      const double share = 0.5 - from_middle / span_deg_;  // the left is on the left
      const int64_t column =
          span_deg_ < 360.0
              ? std::llround(share * static_cast<double>(columns_ - 1))
              : static_cast<int64_t>(std::floor(share * static_cast<double>(columns_) + 0.5)) % columns_;
      if (column < 0 || column >= columns_) continue;
      uint32_t& cell =
          cells_[static_cast<size_t>(lines[i]) * static_cast<size_t>(columns_) + static_cast<size_t>(column)];
      if (cell == empty_cell || ranges_[i] < ranges_[cell]) cell = static_cast<uint32_t>(i);
      low = std::min(low, ranges_[i]);
      high = std::max(high, ranges_[i]);
    }
    scale_ = low <= high ? io::scale_for(std::max(low, 0.01f), std::max(high, 0.02f), 10.0)
                         : io::Scale{1.0, 100.0, true};
  }

  void paint(io::Canvas& canvas) override {
    const int legend = canvas.height() >= 80 ? 24 : 0;
    const bool axes = canvas.width() >= 240 && canvas.height() >= 120;
    const int left = axes ? 68 : 0, bottom = legend + (axes ? theme::line_height : 0);
    picture_ = {left, 0, canvas.width() - left - (axes ? 20 : 0), canvas.height() - bottom};
    canvas.raster(picture_, picture_.width, picture_.height, [&](int x, int y) {
      const uint32_t i = nearest_below(x, y);
      if (i == empty_cell) return canvas.theme().sky;
      return range_color(scale_.at(std::max<double>(ranges_[i], 0.01)));
    });
    if (axes) draw_axes(canvas);
    if (legend > 0)
      io::draw_color_bar(canvas, {4, canvas.height() - legend + 2, canvas.width() - 8, legend - 4}, scale_,
                         range_color, scale_.logarithmic ? "m (log)" : "m");
  }

  std::string text_at(int x, int y) override {
    if (!io::cell_at(picture_, 1, 1, x, y)) return {};
    const std::string line = fmt::format(
        "azimuth {:.1f} deg, {}", middle_deg_ + span_deg_ * (0.5 - (x - picture_.x + 0.5) / picture_.width),
        line_name(static_cast<size_t>(int64_t{y - picture_.y} * lines_ / picture_.height)));
    const uint32_t i = nearest_below(x - picture_.x, y - picture_.y);
    if (i == empty_cell) return line + "\nno return";
    std::string text =
        line + fmt::format("\nrange {:.2f} m, intensity {:.3g}", ranges_[i], points_.as<float>()[4 * i + 3]);
    if (instances_.shape.empty()) return text;
    const uint32_t id = instances_.as<uint32_t>()[i];
    return text + "\n" + (id == 0 ? "fog or rain" : names().instance(id));
  }
  std::string nothing() override { return ranges_.empty() ? "no points" : ""; }

 private:
  std::vector<uint32_t> lines_by_ring(const io::IndexRow& row) {
    const Array rings = read(row, "ring", {DType::u16}, {-1});
    io::expect_same_rows(source(), {&points_, &rings});
    lines_ = std::ssize(line_of_ring_);
    std::vector<uint32_t> lines;
    for (const uint16_t ring : rings.as<uint16_t>()) {
      if (ring >= line_of_ring_.size())
        throw_user_error("{}, tick {}: ring: expected 0 to {}, found {}", source().place(), row.tick,
                         line_of_ring_.size() - 1, ring);
      lines.push_back(line_of_ring_[ring]);
    }
    return lines;
  }
  std::vector<uint32_t> lines_by_elevation() {
    lines_ = lines_without_channels;
    const float* const p = points_.as<float>().data();
    std::vector<double> elevations;
    low_deg_ = 90.0, high_deg_ = -90.0;
    for (size_t i = 0; i < ranges_.size(); ++i) {
      elevations.push_back(
          degrees(std::atan2(double(p[4 * i + 2]), std::hypot(double(p[4 * i]), double(p[4 * i + 1])))));
      low_deg_ = std::min(low_deg_, elevations.back());
      high_deg_ = std::max(high_deg_, elevations.back());
    }
    if (high_deg_ - low_deg_ < 0.1) low_deg_ -= 0.05, high_deg_ += 0.05;
    std::vector<uint32_t> lines;
    for (const double elevation : elevations)
      lines.push_back(static_cast<uint32_t>(
          std::lround((high_deg_ - elevation) / (high_deg_ - low_deg_) * static_cast<double>(lines_ - 1))));
    return lines;
  }
  double elevation_of(size_t line) const {
    if (by_ring_) return elevations_deg_[ring_of_line_[line]];
    return high_deg_ - (high_deg_ - low_deg_) * static_cast<double>(line) / static_cast<double>(lines_ - 1);
  }
  std::string line_name(size_t line) const {
    const std::string elevation = fmt::format("elevation {:.1f} deg", elevation_of(line));
    return by_ring_ ? fmt::format("ring {}, {}", ring_of_line_[line], elevation) : elevation;
  }
  /// The nearest return below pixel (x, y) of the picture on the canvas.
  uint32_t nearest_below(int x, int y) const {
    const int64_t x0 = x * columns_ / picture_.width, y0 = y * lines_ / picture_.height,
                  x1 = std::max(x0 + 1, (x + 1) * columns_ / picture_.width);
    uint32_t found = empty_cell;
    for (int64_t u = x0; u < x1; ++u) {
      const uint32_t i = cells_[static_cast<size_t>(y0 * columns_ + u)];
      if (i != empty_cell && (found == empty_cell || ranges_[i] < ranges_[found])) found = i;
    }
    return found;
  }
  void draw_axes(io::Canvas& canvas) const {
    canvas.frame(picture_, theme::border);
    const io::Scale azimuth{-0.5 * span_deg_, 0.5 * span_deg_, false};
    for (const double value : azimuth.ticks(std::max(2, picture_.width / 110))) {
      const int x =
          picture_.x + static_cast<int>(std::lround((1.0 - azimuth.at(value)) * (picture_.width - 1)));
      canvas.fill({x, picture_.bottom(), 1, 4}, theme::dim);
      canvas.text(x, picture_.bottom() + 6, io::tick_text(middle_deg_ + value) + (value == 0.0 ? " deg" : ""),
                  theme::text_scale, theme::dim, io::Align::center);
    }
    const int labels = std::max(2, picture_.height / 50);
    for (int k = 0; k < labels; ++k) {
      const auto line = static_cast<size_t>(int64_t{k} * (lines_ - 1) / std::max(1, labels - 1));
      const int y =
          std::min(static_cast<int>((2 * static_cast<int64_t>(line) + 1) * picture_.height / (2 * lines_)),
                   picture_.height - 15);
      canvas.text(picture_.x - 6, picture_.y + std::max(0, y - 7), fmt::format("{:.1f}", elevation_of(line)),
                  theme::text_scale, theme::dim, io::Align::right);
    }
  }

  int64_t columns_ = 720, lines_ = 1;
  double middle_deg_ = 0.0, span_deg_ = 360.0;
  std::vector<double> elevations_deg_;  ///< by ring; empty: the pattern has no channels
  std::vector<uint32_t> line_of_ring_, ring_of_line_;
  bool by_ring_ = false;
  double low_deg_ = -1.0, high_deg_ = 1.0;  ///< of elevations, without channels
  Array points_, instances_;
  std::vector<float> ranges_;
  std::vector<uint32_t> cells_;  ///< [line][column] the nearest return
  io::Scale scale_;
  io::Rect picture_;
};

}  // namespace

std::vector<PanelKind> range_image_kinds() {
  return {{"lidar", "range image", {"points"}, make_view_panel<RangeImage>}};
}

}  // namespace greatx::view
