// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panels of a channel: its impulse response and its frequency response over time.
#include <algorithm>
#include <cmath>
#include <complex>

#include "core/units.h"
#include "draw/sheet/channel_links.h"
#include "draw/sheet/csi_response.h"
#include "draw/sheet/panels.h"

namespace greatx::io {

namespace {

using Complex = std::complex<double>;
constexpr size_t most_time_columns = 600, most_cells = 1 << 22;

/// Holds one link over the sequence: H(f) of the link that the source names, of the first port of each end,
/// at the first time sample of each record.
struct Link {
  std::string sensor, ends;  ///< the channel's name; "bs to uav"
  double spacing_hz = 1.0;
  double first_time_s = 0.0, last_time_s = 0.0;
  size_t subcarriers = 0;
  std::vector<std::vector<std::complex<float>>> columns;  ///< [time][subcarrier]

  explicit Link(const PanelSource& source)
      : sensor(source.spec().name), ends(link_text(channel_ends(source), source.link)) {
    spacing_hz = number_of(metadata_of(source), "subcarrier_spacing_hz", 1.0, 1e-6, 1e15);
    const std::vector<IndexRow> rows = source.records.records_of(source.sequence, source.sensor);
    if (rows.empty()) return;
    first_time_s = 1e-9 * static_cast<double>(rows.front().time_ns);
    last_time_s = 1e-9 * static_cast<double>(rows.back().time_ns);
    size_t count = std::min(rows.size(), most_time_columns);
    for (size_t i = 0; i < count; ++i) {
      const Array cfr =
          source.load(rows[i * rows.size() / count], "cfr", {DType::complex64}, {0, 0, 0, 0, 0, 0});
      subcarriers = static_cast<size_t>(cfr.shape.back());
      if (i == 0) count = std::min(count, std::max<size_t>(2, most_cells / subcarriers));
      const auto [rx, tx] = source.link;
      const auto extent = [&](size_t axis) { return static_cast<size_t>(cfr.shape[axis]); };
      if (rx >= extent(0) || tx >= extent(2))
        throw_user_error("{}: expected a cfr of receiver {} and transmitter {}, found {} x {}",
                         source.place(), rx, tx, extent(0), extent(2));
      // [rx, rx_ant, tx, tx_ant, time, subcarrier]
      const size_t first = (rx * extent(1) * extent(2) + tx) * extent(3) * extent(4) * subcarriers;
      const auto values = cfr.as<std::complex<float>>().subspan(first, subcarriers);
      columns.emplace_back(values.begin(), values.end());
    }
  }
};

/// Shows decibels over time (columns) and over a second axis (rows, from the bottom upwards).
class DecibelPanel : public SeriesPanel {
 public:
  void draw(Canvas& canvas, const Rect& area) override {
    const Rect plot = plot_in(area);
    if (values_.empty()) return;
    const auto columns = static_cast<int>(values_.size()), rows = static_cast<int>(values_[0].size());
    canvas.raster(plot, columns, rows, [&](int x, int y) {
      return canvas.theme().power(
          color_.at(values_[static_cast<size_t>(x)][static_cast<size_t>(rows - 1 - y)]));
    });
    canvas.frame(plot, canvas.theme().border);
    draw_x_axis(canvas, plot, time_, "time s");
    draw_y_axis(canvas, plot, vertical_, vertical_label_);
    draw_color_scale(canvas, {plot.right() + 14, plot.y, 14, plot.height}, color_, canvas.theme().power,
                     "dB");
  }
  void mark_time(Canvas& canvas, const Rect& area, double time_s) override {
    mark_time_in(canvas, plot_in(area), time_, time_s, canvas.theme().over);
  }

 protected:
  static Rect plot_in(const Rect& area) {
    return {area.x + 92, area.y + 8 + theme::line_height, area.width - 92 - 92,
            area.height - 16 - 4 * theme::line_height};
  }
  void set_time(const Link& link) { time_ = scale_for(link.first_time_s, link.last_time_s); }
  void set_color(double floor_db) {
    double high = -1e300, low = 1e300;
    for (const auto& column : values_) {
      for (const double value : column) {
        high = std::max(high, value);
        low = std::min(low, value);
      }
    }
    color_ = scale_for(std::max(low, high - floor_db), high);
  }

  std::vector<std::vector<double>> values_;  ///< [time][row], dB
  Scale time_, vertical_, color_;
  std::string vertical_label_;
};

/// |h(tau)|, see impulse_response_db().
class ImpulsePanel : public DecibelPanel {
 public:
  explicit ImpulsePanel(const Link& link)
      : title_(fmt::format("{} |h| over delay, {}", link.sensor, link.ends)) {
    if (link.columns.empty()) return;
    const size_t size = impulse_size(link.subcarriers);
    std::vector<double> peak(size, -1e300);
    for (const auto& column : link.columns) {
      values_.push_back(impulse_response_db(column));
      for (size_t i = 0; i < size; ++i) peak[i] = std::max(peak[i], values_.back()[i]);
    }
    // Cut off the delays behind the last echo worth seeing.
    const double threshold = *std::max_element(peak.begin(), peak.end()) - 0.9 * csi_range_db;
    size_t last = 0;
    for (size_t i = 0; i < 9 * size / 10; ++i)
      if (peak[i] > threshold) last = i;
    const size_t kept = std::min(size, std::max<size_t>(last + last / 8, 16));
    for (auto& column : values_) column.resize(kept);
    const double longest_s = static_cast<double>(kept) / (static_cast<double>(size) * link.spacing_hz);
    const bool micro = longest_s > 2e-6;
    vertical_ = {0.0, longest_s * (micro ? 1e6 : 1e9), false};
    vertical_label_ = micro ? "delay us" : "delay ns";
    set_time(link);
    set_color(csi_range_db);
  }
  std::string title() const override { return title_; }

 private:
  std::string title_;
};

/// Shows |H(f)|.
class FrequencyPanel : public DecibelPanel {
 public:
  explicit FrequencyPanel(const Link& link)
      : title_(fmt::format("{} |H| over frequency, {}", link.sensor, link.ends)) {
    for (const auto& column : link.columns) values_.push_back(magnitudes_db(column));
    // Subcarrier k lies at (k - floor(N/2)) * spacing from the carrier; each takes one spacing of the axis.
    const double low = -(static_cast<double>(link.subcarriers / 2) + 0.5) * link.spacing_hz;
    vertical_ = {low * 1e-6, (low + static_cast<double>(link.subcarriers) * link.spacing_hz) * 1e-6, false};
    vertical_label_ = "f - fc MHz";
    set_time(link);
    set_color(csi_range_db);
  }
  std::string title() const override { return title_; }

 private:
  std::string title_;
};

/// In place, radix 2, e^{+j}: x[n] = sum_k X[k] e^{+j 2 pi k n / N}.
void inverse_fft(std::vector<Complex>& x) {
  const size_t n = x.size();
  for (size_t i = 1, j = 0; i < n; ++i) {
    size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (size_t length = 2; length <= n; length <<= 1) {
    for (size_t k = 0; k < length / 2; ++k) {
      const Complex turn = std::polar(1.0, 2.0 * pi * static_cast<double>(k) / static_cast<double>(length));
      for (size_t start = 0; start < n; start += length) {
        const Complex a = x[start + k], b = x[start + k + length / 2] * turn;
        x[start + k] = a + b;
        x[start + k + length / 2] = a - b;
      }
    }
  }
}

}  // namespace

size_t impulse_size(size_t subcarriers) {
  size_t size = 1;
  while (size < 4 * subcarriers) size <<= 1;
  return size;
}

double decibels_of(double magnitude) { return 20.0 * std::log10(std::max(magnitude, 1e-20)); }

std::vector<double> impulse_response_db(std::span<const std::complex<float>> cfr) {
  const size_t n = cfr.size();
  std::vector<Complex> x(impulse_size(n));
  double sum = 0.0;
  for (size_t k = 0; k < n; ++k) {
    const double window =
        0.5 - 0.5 * std::cos(2.0 * pi * (static_cast<double>(k) + 0.5) / static_cast<double>(n));
    x[k] = Complex(cfr[k]) * window;
    sum += window;
  }
  inverse_fft(x);
  std::vector<double> db;
  for (const Complex& value : x) db.push_back(decibels_of(std::abs(value) / sum));
  return db;
}

std::vector<double> magnitudes_db(std::span<const std::complex<float>> cfr) {
  std::vector<double> db;
  for (const std::complex<float>& value : cfr) db.push_back(decibels_of(std::abs(Complex(value))));
  return db;
}

void add_csi_panels(const PanelSource& source, Panels& panels) {
  if (!source.has("cfr")) return;
  const Link link(source);
  if (link.columns.empty()) return;
  panels.series.push_back(std::make_unique<ImpulsePanel>(link));
  panels.series.push_back(std::make_unique<FrequencyPanel>(link));
}

}  // namespace greatx::io
