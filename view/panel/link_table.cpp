// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The statistics of one link as a table: every array [rx, tx] of the channel.
#include <algorithm>
#include <cmath>
#include <complex>

#include "core/array_numbers.h"
#include "core/units.h"
#include "view/panel/panel_kinds.h"

namespace greatx::view {

namespace theme = io::theme;

namespace {

/// Returns element i as a number; the magnitude of a complex one.
double number_in(const Array& array, size_t i) {
  return array.dtype == DType::complex64 ? std::abs(std::complex<double>(array.as<std::complex<float>>()[i]))
                                         : number_at(array, i);
}

std::string value_text(const ArraySpec& spec, double value) {
  const bool fraction = spec.dtype == DType::f32 || spec.dtype == DType::f64;
  if (!fraction) return fmt::format("{:.0f}", value);
  if (spec.unit == "s" || spec.unit == "Hz") return with_prefix(value, spec.unit.c_str());
  if (std::isnan(value)) return "none";
  if (spec.unit == "rad") return fmt::format("{:.2f} deg", degrees(value));
  if (spec.unit == "dBm" || spec.unit == "dB") return fmt::format("{:.2f} {}", value, spec.unit);
  // Gains and ratios of power.
  if (spec.unit == "1" && (spec.name == "path_gain" || spec.name == "k_factor"))
    return fmt::format("{:.2f} dB", 10.0 * std::log10(value));
  return fmt::format("{:.4g}{}", value, spec.unit == "1" ? "" : " " + spec.unit);
}

class LinkTable : public Panel {
 public:
  LinkTable(const PanelChoice& choice, Records records) : Panel(choice, std::move(records)) {
    const LinkSizes sizes = link_sizes(spec());
    add_knob(
        {"receiver", "", 0.0, 0.0, static_cast<double>(std::max<int64_t>(sizes.receivers, 1) - 1), true});
    add_knob({"transmitter", "", 0.0, 0.0, static_cast<double>(std::max<int64_t>(sizes.transmitters, 1) - 1),
              true});
  }
  PanelSize wanted() const override { return {480, 360}; }

 protected:
  void load(const io::IndexRow& row) override {
    rows_.clear();
    for (const ArraySpec& spec_of : spec().arrays) {
      if (spec_of.shape.size() != 2 || spec_of.shape[0] <= 0 || spec_of.dtype == DType::complex64) continue;
      const Array array = read(row, spec_of.name.c_str(), {spec_of.dtype}, {0, 0});
      const auto rx = static_cast<int64_t>(knob("receiver")), tx = static_cast<int64_t>(knob("transmitter"));
      if (rx >= array.shape[0] || tx >= array.shape[1])
        throw_user_error("{}: expected {} of receiver {}, transmitter {}, found [{}, {}]", source().place(),
                         spec_of.name, rx, tx, array.shape[0], array.shape[1]);
      std::string name = spec_of.name;
      std::ranges::replace(name, '_', ' ');
      rows_.push_back({std::move(name),
                       value_text(spec_of, number_in(array, static_cast<size_t>(rx * array.shape[1] + tx))),
                       spec_of.description});
    }
  }
  void paint(io::Canvas& canvas) override {
    const auto rows = static_cast<int>(rows_.size());
    scale_ = rows * theme::line_height <= canvas.height() && canvas.width() >= 440 ? theme::text_scale : 1;
    line_height_ = scale_ == 1 ? 11 : theme::line_height;
    shown_ = std::min(rows, canvas.height() / line_height_);
    for (int i = 0; i < shown_; ++i) {
      const int y = i * line_height_;
      if (i % 2 == 1) canvas.fill({0, y, canvas.width(), line_height_}, theme::panel);
      const bool rest = i == shown_ - 1 && shown_ < rows;
      const Row& row = rows_[static_cast<size_t>(i)];
      canvas.text(4, y + 2, rest ? fmt::format("... {} more", rows - i) : row.name, scale_, theme::dim);
      if (!rest) canvas.text(canvas.width() - 4, y + 2, row.value, scale_, theme::text, io::Align::right);
    }
    if (shown_ < rows && shown_ > 0) --shown_;
  }
  std::string text_at(int, int y) override {
    const int i = y / line_height_;
    if (i >= shown_) return {};
    const Row& row = rows_[static_cast<size_t>(i)];
    return fmt::format("{}: {}\n{}", row.name, row.value, row.description);
  }

 private:
  struct Row {
    std::string name, value, description;
  };
  std::vector<Row> rows_;
  int scale_ = 1, line_height_ = 11, shown_ = 0;
};

}  // namespace

std::vector<PanelKind> link_kinds() {
  return {{"csi", "link", {"path_count", "path_gain"}, make_view_panel<LinkTable>}};
}

}  // namespace greatx::view
