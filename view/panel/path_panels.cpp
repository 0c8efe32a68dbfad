// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The paths of one link: where they come from, when they arrive and how strong they are.
#include <algorithm>
#include <cmath>
#include <complex>

#include "core/units.h"
#include "view/panel/panel_kinds.h"

namespace greatx::view {

namespace theme = io::theme;

namespace {

constexpr double ring_db = 10.0, compass_db = 60.0, reach_px = 8.0;

/// Of InteractionType, as docs/paths.md numbers them.
constexpr const char* interaction_names[] = {"line of sight", "reflection", "transmission",
                                             "diffraction",   "scattering", "target"};

struct PathMark {
  double gain_db = 0.0;  ///< mean over pairs of ports
  std::complex<double> amplitude;
  double zenith = 0.0, azimuth = 0.0, delay_s = 0.0;
  uint8_t kind = 0;  ///< its rarest interaction: the highest number
  std::string text;
  double x = 0.0, y = 0.0;  ///< on the canvas
};

/// Panels of the columns of paths, with knobs for link and ports.
class PathPanel : public Panel {
 public:
  PathPanel(const PanelChoice& choice, Records records, const char* angles)
      : Panel(choice, std::move(records)), angles_(angles) {
    const LinkSizes sizes = link_sizes(spec());
    add_knob(
        {"receiver", "", 0.0, 0.0, static_cast<double>(std::max<int64_t>(sizes.receivers, 1) - 1), true});
    add_knob({"transmitter", "", 0.0, 0.0, static_cast<double>(std::max<int64_t>(sizes.transmitters, 1) - 1),
              true});
  }

 protected:
  void load(const io::IndexRow& row) override {
    const io::PanelSource from = source();
    const Array rx = read(row, "rx", {DType::i32}, {-1}), tx = read(row, "tx", {DType::i32}, {-1}),
                amplitude = read(row, "amplitude", {DType::complex64}, {-1, 0, 0});
    io::expect_same_rows(from, {&rx, &tx, &amplitude});
    const auto optional = [&](const char* name, DType type, const std::vector<int64_t>& shape) {
      if (!from.has(name)) return Array();
      Array array = read(row, name, {type}, shape);
      io::expect_same_rows(from, {&rx, &array});
      return array;
    };
    const Array delay = optional("delay", DType::f64, {-1}), doppler = optional("doppler", DType::f64, {-1}),
                id = optional("id", DType::u64, {-1}),
                interaction = optional("interaction", DType::u8, {-1, 0}),
                angles = angles_ ? read(row, angles_, {DType::f64}, {-1, 2}) : Array();
    if (angles_) io::expect_same_rows(from, {&rx, &angles});
    paths_.clear();
    strongest_db_ = -400.0;
    for (size_t i = 0; i < rx.as<int32_t>().size(); ++i) {
      if (rx.as<int32_t>()[i] != static_cast<int32_t>(knob("receiver")) ||
          tx.as<int32_t>()[i] != static_cast<int32_t>(knob("transmitter")))
        continue;
      PathMark& path = paths_.emplace_back();
      const auto pairs = static_cast<size_t>(amplitude.shape[1] * amplitude.shape[2]);
      const auto values = amplitude.as<std::complex<float>>().subspan(i * pairs, pairs);
      double power = 0.0;
      for (const auto& a : values) power += std::norm(std::complex<double>(a));
      path.gain_db = 10.0 * std::log10(std::max(power / static_cast<double>(pairs), 1e-40));
      path.amplitude = values[0];
      strongest_db_ = std::max(strongest_db_, path.gain_db);
      path.text = fmt::format("path {}: {:.2f} dB", i, path.gain_db);
      std::string kinds;
      const auto depth = interaction.shape.empty() ? 0 : static_cast<size_t>(interaction.shape[1]);
      for (size_t k = 0; k < depth; ++k) {
        const uint8_t type = interaction.as<uint8_t>()[i * depth + k];
        if (type == 0 || type >= std::size(interaction_names)) continue;
        path.kind = std::max(path.kind, type);
        kinds += (kinds.empty() ? "" : ", ") + std::string(interaction_names[type]);
      }
      if (depth > 0) path.text += "\n" + (kinds.empty() ? std::string(interaction_names[0]) : kinds);
      if (!delay.shape.empty()) {
        path.delay_s = delay.as<double>()[i];
        path.text += fmt::format("\ndelay {} ({})", with_prefix(path.delay_s, "s"),
                                 with_prefix(path.delay_s * speed_of_light, "m"));
      }
      if (!doppler.shape.empty()) path.text += "\nDoppler " + with_prefix(doppler.as<double>()[i], "Hz");
      if (angles_) {
        path.zenith = angles.as<double>()[2 * i];
        path.azimuth = angles.as<double>()[2 * i + 1];
        path.text += fmt::format("\nazimuth {:.2f} deg, zenith {:.2f} deg", degrees(path.azimuth),
                                 degrees(path.zenith));
      }
      if (!id.shape.empty()) path.text += fmt::format("\nid {:016x}", id.as<uint64_t>()[i]);
    }
    // The strongest are drawn last, in front.
    std::ranges::stable_sort(paths_, {}, &PathMark::gain_db);
  }
  std::string nothing() override { return paths_.empty() ? "no paths" : ""; }

  static io::Color color_of(const PathMark& path) {
    return path.kind == 0 ? io::Color{120, 220, 130}
                          : io::color_of_series(path.kind == 2 ? 4u : path.kind - 1u);
  }
  static void mark(io::Canvas& canvas, const PathMark& path) {
    canvas.disc(path.x, path.y, 4.0, color_of(path));
    canvas.circle(path.x, path.y, 4.5, 1.0, theme::page);
  }
  /// The text of the mark next to the pixel; null if none is near.
  const PathMark* mark_at(int x, int y) const {
    const PathMark* found = nullptr;
    double nearest = reach_px;
    for (const PathMark& path : paths_)
      if (const double d = std::hypot(path.x - x - 0.5, path.y - y - 0.5); d <= nearest)
        nearest = d, found = &path;
    return found;
  }

  const char* angles_;  ///< array, or null
  std::vector<PathMark> paths_;
  double strongest_db_ = -400.0;
};

/// Azimuths as directions on a map, north up, the gain as the distance from the rim: the strongest path lies
/// within the outermost ring.
class Compass : public PathPanel {
 public:
  Compass(const PanelChoice& choice, Records records, const char* angles)
      : PathPanel(choice, std::move(records), angles) {}
  PanelSize wanted() const override { return {320, 320}; }

 protected:
  void paint(io::Canvas& canvas) override {
    const int room = canvas.width() >= 160 && canvas.height() >= 160 ? theme::line_height : 4;
    center_ = {0.5 * canvas.width(), 0.5 * canvas.height()};
    radius_ = std::max(1.0, 0.5 * std::min(canvas.width(), canvas.height()) - room);
    rim_db_ = paths_.empty() ? 0.0 : ring_db * std::ceil(strongest_db_ / ring_db - 1e-3);
    for (double db = 0.0; db < compass_db; db += 2.0 * ring_db)
      canvas.circle(center_.x, center_.y, radius_ * (1.0 - db / compass_db), 1.0, theme::border);
    for (int k = 0; k < 12; ++k) {
      const double angle = radians(30.0 * k);
      canvas.line(center_.x, center_.y, center_.x + radius_ * std::cos(angle),
                  center_.y - radius_ * std::sin(angle), k % 3 == 0 ? 1.0 : 0.5, theme::border);
    }
    for (PathMark& path : paths_) {
      const double length = radius_ * std::clamp(1.0 - (rim_db_ - path.gain_db) / compass_db, 0.0, 1.0);
      path.x = center_.x + length * std::cos(path.azimuth);
      path.y = center_.y - length * std::sin(path.azimuth);
      canvas.line(center_.x, center_.y, path.x, path.y, 1.2, color_of(path));
    }
    for (const PathMark& path : paths_) mark(canvas, path);
    if (room < theme::line_height) return;
    const int x = static_cast<int>(center_.x), y = static_cast<int>(center_.y),
              r = static_cast<int>(radius_) + 4;
    canvas.text(x, y - r - 14, "N", theme::text_scale, theme::text, io::Align::center);
    canvas.text(x, y + r, "S", theme::text_scale, theme::text, io::Align::center);
    canvas.text(x + r + 2, y - 7, "E", theme::text_scale, theme::text);
    canvas.text(x - r - 2, y - 7, "W", theme::text_scale, theme::text, io::Align::right);
    if (paths_.empty()) return;
    for (double db = 0.0; db < compass_db; db += 2.0 * ring_db)
      canvas.text(x + 3, y - static_cast<int>(radius_ * (1.0 - db / compass_db)) + 3,
                  fmt::format("{:.0f}{}", rim_db_ - db, db == 0.0 ? " dB" : ""), 1, theme::dim);
  }
  std::string text_at(int x, int y) override {
    if (const PathMark* const path = mark_at(x, y)) return path->text;
    const double right = x + 0.5 - center_.x, up = center_.y - y - 0.5, length = std::hypot(right, up);
    if (length > radius_ || paths_.empty()) return {};
    return fmt::format("azimuth {:.1f} deg, {:.1f} dB", degrees(std::atan2(up, right)),
                       rim_db_ - compass_db * (1.0 - length / radius_));
  }

 private:
  dvec2 center_{0.0};
  double radius_ = 1.0, rim_db_ = 0.0;
};

class ArrivalCompass : public Compass {
 public:
  ArrivalCompass(const PanelChoice& choice, Records records)
      : Compass(choice, std::move(records), "arrival") {}
};
class DepartureCompass : public Compass {
 public:
  DepartureCompass(const PanelChoice& choice, Records records)
      : Compass(choice, std::move(records), "departure") {}
};

/// Delay against gain.
class DelayGain : public PathPanel {
 public:
  DelayGain(const PanelChoice& choice, Records records) : PathPanel(choice, std::move(records), nullptr) {}

 protected:
  void paint(io::Canvas& canvas) override {
    const auto [plot, axes] = place_plot(canvas, false);
    plot_ = plot;
    canvas.fill(plot, theme::panel);
    double low_s = 1e300, high_s = -1e300, low_db = 1e300;
    for (const PathMark& path : paths_) {
      low_s = std::min(low_s, path.delay_s);
      high_s = std::max(high_s, path.delay_s);
      low_db = std::min(low_db, path.gain_db);
    }
    if (paths_.empty()) low_s = 0.0, high_s = 1e-6, low_db = -100.0;
    const double pad_s = std::max(0.05 * (high_s - low_s), 1e-9);
    low_s = std::max(0.0, low_s - pad_s);
    high_s += pad_s;
    factor_ = high_s > 2e-6 ? 1e6 : 1e9;
    delay_ = {low_s * factor_, high_s * factor_, false};
    const double top_db = paths_.empty() ? -60.0 : strongest_db_;
    gain_ = {std::max(low_db, top_db - 2.0 * compass_db) - 3.0, top_db + 3.0, false};
    canvas.clip(plot);
    io::draw_y_grid(canvas, plot, gain_);
    for (PathMark& path : paths_) {
      path.x = plot.x + delay_.at(path.delay_s * factor_) * plot.width;
      path.y = plot.bottom() - gain_.at(path.gain_db) * plot.height;
      canvas.line(path.x, plot.bottom(), path.x, path.y, 1.0, color_of(path));
    }
    for (const PathMark& path : paths_) mark(canvas, path);
    canvas.unclip();
    if (!axes) return;
    canvas.frame(plot, theme::border);
    io::draw_x_axis(canvas, plot, delay_, factor_ == 1e6 ? "delay us" : "delay ns");
    io::draw_y_axis(canvas, plot, gain_, "gain dB");
  }
  std::string text_at(int x, int y) override {
    if (!io::cell_at(plot_, 1, 1, x, y)) return {};
    if (const PathMark* const path = mark_at(x, y)) return path->text;
    if (paths_.empty()) return {};
    return fmt::format("delay {}, {:.1f} dB",
                       with_prefix(value_at_pixel(delay_, plot_.x, plot_.width, x) / factor_, "s"),
                       gain_.high + gain_.low - value_at_pixel(gain_, plot_.y, plot_.height, y));
  }

 private:
  io::Rect plot_;
  io::Scale delay_, gain_;
  double factor_ = 1e9;
};

/// The complex amplitudes between the first ports, over the strongest of them.
class AmplitudePlane : public PathPanel {
 public:
  AmplitudePlane(const PanelChoice& choice, Records records)
      : PathPanel(choice, std::move(records), nullptr) {}
  PanelSize wanted() const override { return {320, 320}; }

 protected:
  void paint(io::Canvas& canvas) override {
    center_ = {0.5 * canvas.width(), 0.5 * canvas.height()};
    radius_ = std::max(1.0, 0.46 * std::min(canvas.width(), canvas.height()));
    full_ = 0.0;
    for (const PathMark& path : paths_) full_ = std::max(full_, std::abs(path.amplitude));
    canvas.fill({0, static_cast<int>(center_.y), canvas.width(), 1}, theme::border);
    canvas.fill({static_cast<int>(center_.x), 0, 1, canvas.height()}, theme::border);
    for (const double share : {0.5, 1.0})
      canvas.circle(center_.x, center_.y, share * radius_, 1.0, theme::border);
    for (PathMark& path : paths_) {
      const std::complex<double> at = full_ > 0.0 ? path.amplitude / full_ : 0.0;
      path.x = center_.x + radius_ * at.real();
      path.y = center_.y - radius_ * at.imag();
      canvas.line(center_.x, center_.y, path.x, path.y, 1.0, color_of(path));
    }
    for (const PathMark& path : paths_) mark(canvas, path);
    if (canvas.width() < 200 || paths_.empty()) return;
    canvas.text(canvas.width() - 4, static_cast<int>(center_.y) + 5, "Re", theme::text_scale, theme::dim,
                io::Align::right);
    canvas.text(static_cast<int>(center_.x) + 5, 4, "Im", theme::text_scale, theme::dim);
    canvas.text(4, canvas.height() - 20, fmt::format("rim {:.3g}", full_), theme::text_scale, theme::dim);
  }
  std::string text_at(int x, int y) override {
    const PathMark* const path = mark_at(x, y);
    if (path == nullptr) return {};
    return fmt::format("amplitude {:.4g} {:+.4g} j, phase {:.1f} deg\n", path->amplitude.real(),
                       path->amplitude.imag(), degrees(std::arg(path->amplitude))) +
           path->text;
  }

 private:
  dvec2 center_{0.0};
  double radius_ = 1.0, full_ = 0.0;
};

}  // namespace

std::vector<PanelKind> path_kinds() {
  return {
      {"csi", "arrivals", {"rx", "tx", "amplitude", "arrival"}, make_view_panel<ArrivalCompass>},
      {"csi", "departures", {"rx", "tx", "amplitude", "departure"}, make_view_panel<DepartureCompass>},
      {"csi", "delay and gain of paths", {"rx", "tx", "amplitude", "delay"}, make_view_panel<DelayGain>},
      {"csi", "amplitudes of paths", {"rx", "tx", "amplitude"}, make_view_panel<AmplitudePlane>},
  };
}

}  // namespace greatx::view
