// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panels of radars: power over range and velocity, and power over the ground as the beams see it.
// Both show the detections.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/units.h"
#include "draw/sheet/companion.h"
#include "draw/sheet/map_marks.h"
#include "draw/sheet/panels.h"
#include "draw/sheet/polar_map.h"
#include "draw/sheet/power_maps.h"

namespace greatx::io {

namespace {

/// Holds the axes of the maps, from the metadata of the sensor: m, m/s and radians.
struct Axes {
  double range_bin_m = 1.0, velocity_min = -1.0, velocity_bin = 1.0, azimuth_min = -1.0, azimuth_max = 1.0;
};

Axes axes_of(const PanelSource& source) {
  const JsonDocument metadata = metadata_of(source);
  Axes axes;
  axes.range_bin_m = number_of(metadata, "range_bin_m", axes.range_bin_m, 1e-6, 1e9);
  axes.velocity_min = number_of(metadata, "velocity_min_m_s", axes.velocity_min, -1e9, 1e9);
  axes.velocity_bin = number_of(metadata, "velocity_bin_m_s", axes.velocity_bin, 1e-9, 1e9);
  axes.azimuth_min = number_of(metadata, "azimuth_min_rad", axes.azimuth_min, -7.0, 7.0);
  axes.azimuth_max = number_of(metadata, "azimuth_max_rad", axes.azimuth_max, -7.0, 7.0);
  if (axes.azimuth_max <= axes.azimuth_min)
    metadata.root()
        .at("azimuth_max_rad")
        .fail(fmt::format("more than azimuth_min_rad, {}", axes.azimuth_min));
  return axes;
}

/// Returns the level that the share `below` of the levels does not exceed.
double quantile(std::vector<double>& levels, double below) {
  const auto at = levels.begin() + static_cast<std::ptrdiff_t>(below * double(levels.size() - 1));
  std::nth_element(levels.begin(), at, levels.end());
  return *at;
}

/// Holds the maps of all rows on one scale, up to the level that one cell in a thousand exceeds.
class RadarPanel : public FramePanel {
 public:
  RadarPanel(const PanelSource& source, const char* array) : source_(source), axes_(axes_of(source)) {
    double top = -400.0;
    std::vector<double> middles;
    for (const IndexRow& row : source_.chosen) {
      const Array map = source_.load(row, array, {DType::f32}, {0, 0});
      rows_ = map.shape.at(0);
      std::vector<double> sorted = maps_.add(map.as<float>(), map.shape.at(1));
      if (!sorted.empty()) {
        middles.push_back(quantile(sorted, 0.5));
        top = std::max(top, quantile(sorted, 0.999));
      }
      load_detections(row);
    }
    if (middles.empty()) return;
    maps_.set_scale(*std::min_element(middles.begin(), middles.end()), top);
  }

 protected:
  struct Detection {
    float range, velocity, azimuth;
    uint32_t instance;
    float strength;  ///< dB or dBm
    bool real() const { return instance != 0; }
  };
  /// Returns the largest range to show: 1.2 times the range of the farthest detection, but at least a quarter
  /// of the map; the whole map if there is no detection.
  double farthest_m() const {
    double farthest = 0.0;
    for (const auto& row : detections_)
      for (const Detection& d : row) farthest = std::max(farthest, 1.2 * static_cast<double>(d.range));
    const double all = static_cast<double>(rows_) * axes_.range_bin_m;
    return farthest > 0.0 ? std::min(std::max(farthest, 0.25 * all), all) : all;
  }
  /// Returns the detections of a row as marks where `place` says. Labels are for what moves first, then for
  /// the strongest; one for each thing.
  template <typename Place>
  std::vector<MapMark> marks_of(size_t row, const Place& place) const {
    constexpr size_t most_labels = 4;
    const std::vector<Detection>& detections = detections_[row];
    std::vector<size_t> order(detections.size());
    std::iota(order.begin(), order.end(), size_t{0});
    const auto moves = [&](const Detection& d) {
      return source_.scene && source_.scene->names.moves(d.instance);
    };
    std::ranges::stable_sort(order, [&](size_t a, size_t b) {
      return std::pair(moves(detections[a]), detections[a].strength) >
             std::pair(moves(detections[b]), detections[b].strength);
    });
    std::vector<MapMark> marks;
    std::set<std::string> named;
    for (const size_t i : order) {
      const Detection& d = detections[i];
      MapMark& mark = marks.emplace_back(MapMark{MapMark::Kind::detection, place(d), d.real(), {}});
      if (!d.real() || !source_.scene || named.size() >= most_labels) continue;
      const std::string name = source_.scene->names.short_instance(d.instance);
      if (named.insert(name).second) mark.label = mark_label(name, d.range, d.velocity);
    }
    return marks;
  }
  std::vector<KeyEntry> detection_key(const Theme& theme) const {
    if (!source_.has("detections")) return {};
    using Mark = KeyEntry::Mark;
    return {{Mark::ring, theme.detection, "detection of a thing"},
            {Mark::ring, theme.false_alarm, "false alarm"},
            {Mark::none, {}, "labels: name, range, range rate"}};
  }

  PanelSource source_;
  Axes axes_;
  int64_t rows_ = 1;
  PowerMaps maps_;
  std::vector<std::vector<Detection>> detections_;  ///< one list for each row

 private:
  void load_detections(const IndexRow& row) {
    std::vector<Detection>& list = detections_.emplace_back();
    if (!source_.has("detections")) return;
    const auto column = [&](const char* name) { return source_.load(row, name, {DType::f32}, {-1}); };
    const Array range = column("range"), velocity = column("velocity"), azimuth = column("azimuth"),
                instance = source_.load(row, "instance", {DType::u32}, {-1}),
                strength = source_.has("snr") ? column("snr") : range;
    expect_same_rows(source_, {&range, &velocity, &azimuth, &instance, &strength});
    for (size_t i = 0; i < range.as<float>().size(); ++i)
      list.push_back({range.as<float>()[i], velocity.as<float>()[i], azimuth.as<float>()[i],
                      instance.as<uint32_t>()[i], strength.as<float>()[i]});
  }
};

/// The detection whose mark is around pixel (x, y), as text; empty if there is none.
template <typename Detections, typename Place>
std::string marked_at(const Detections& detections, const Place& place, int x, int y,
                      const SceneNames& names) {
  std::string text;
  double nearest = 7.0;
  for (const auto& d : detections) {
    const dvec2 at = place(d);
    const double distance = std::hypot(x + 0.5 - at.x, y + 0.5 - at.y);
    if (distance >= nearest) continue;
    nearest = distance;
    text = fmt::format("\ndetection: {:.2f} m, {:.2f} m/s, {:.1f} deg\n{}", d.range, d.velocity,
                       degrees(d.azimuth), d.real() ? names.instance(d.instance) : "false alarm");
  }
  return text;
}

class RangeDopplerPanel : public RadarPanel {
 public:
  explicit RangeDopplerPanel(const PanelSource& source) : RadarPanel(source, "range_doppler") {}
  std::string title() const override { return source_.spec().name + " range-Doppler"; }
  std::vector<KeyEntry> key(const Theme& theme) override {
    std::vector<KeyEntry> entries = detection_key(theme);
    entries.push_back({KeyEntry::Mark::none, {}, "up: range; right: receding"});
    return entries;
  }

  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const double far_m = farthest_m();
    const int ranges = shown_ranges();
    canvas.clip(picture);
    canvas.raster(picture, static_cast<int>(maps_.columns()), ranges,
                  [&](int x, int y) { return maps_.color(row, ranges - 1 - y, x); });
    const std::vector<MapMark> marks = marks_of(row, [&](const Detection& d) { return place(picture, d); });
    draw_map_marks(canvas, marks);
    const double pixels = picture.height / far_m;
    const double step = round_down(far_m / 2.5);
    for (int i = 1; i * step * pixels < picture.height - 16; ++i)  // only labels that fit
      axis_text(canvas, picture.x + 6,
                picture.bottom() - static_cast<int>(std::lround(i * step * pixels)) - 8,
                tick_text(i * step) + " m", Align::left);
    const std::string velocity = tick_text(std::round(-10.0 * axes_.velocity_min) / 10.0);
    const int y = picture.bottom() - 20;
    axis_text(canvas, picture.x + 6, y, "-" + velocity, Align::left);
    axis_text(canvas, picture.x + picture.width / 2, y, "0", Align::center);
    axis_text(canvas, picture.right() - 6, y, "+" + velocity + " m/s", Align::right);
    label_map_marks(canvas, picture, marks);
    canvas.unclip();
    maps_.draw_scale(canvas, legend);
  }
  std::string value_at(const Rect& picture, size_t row, int x, int y, const SceneNames& names) override {
    const int ranges = shown_ranges();
    const std::optional<RasterCell> cell = cell_at(picture, maps_.columns(), ranges, x, y);
    if (!cell) return {};
    const int range = ranges - 1 - cell->row;
    return fmt::format("{:.2f} m, {:.2f} m/s: {:.1f} dBm", range * axes_.range_bin_m,
                       axes_.velocity_min + cell->column * axes_.velocity_bin,
                       maps_.level(row, range, cell->column)) +
           marked_at(
               detections_[row], [&](const Detection& d) { return place(picture, d); }, x, y, names);
  }

 private:
  static void axis_text(Canvas& canvas, int x, int y, const std::string& text, Align align) {
    canvas.rimmed_text(x, y, text, theme::text_scale, canvas.theme().over, canvas.theme().halo, align);
  }
  int shown_ranges() const {
    return std::max(1, static_cast<int>(std::lround(farthest_m() / axes_.range_bin_m)));
  }
  dvec2 place(const Rect& picture, const Detection& d) const {
    return {picture.x + ((d.velocity - axes_.velocity_min) / axes_.velocity_bin + 0.5) * picture.width /
                            static_cast<double>(maps_.columns()),
            picture.bottom() - d.range * (picture.height / farthest_m())};
  }
};

/// Shows the range-azimuth map over the ground from above, forward up. Under the marks are the outlines of
/// the scene's buildings, in the range and azimuth of the radar; in a data set that has none, the points that
/// a LiDAR of the same node has at the same tick.
class RangeAzimuthPanel : public RadarPanel {
 public:
  explicit RangeAzimuthPanel(const PanelSource& source) : RadarPanel(source, "range_azimuth") {
    points_.resize(source_.chosen.size());
    if (has_outlines()) return;
    const std::optional<Companion> lidar = companion(source_, "lidar", {"points"});
    if (!lidar) return;
    const Pose radar_from_lidar = lidar->from_first.inverse();
    for (size_t row = 0; row < points_.size(); ++row) {
      if (!lidar->rows[row]) continue;
      const Array points = lidar->source.load(*lidar->rows[row], "points", {DType::f32}, {-1, 4});
      const std::span<const float> p = points.as<float>();
      for (size_t i = 0; i + 3 < p.size(); i += 4) {
        const dvec3 at = radar_from_lidar.apply(dvec3(p[i], p[i + 1], p[i + 2]));
        const double azimuth = std::atan2(at.y, at.x), range = glm::length(at);
        if (azimuth >= axes_.azimuth_min && azimuth <= axes_.azimuth_max)
          points_[row].push_back(range * dvec2(std::cos(azimuth), std::sin(azimuth)));
      }
    }
  }
  std::string title() const override { return source_.spec().name + " from above"; }
  std::vector<KeyEntry> key(const Theme& theme) override {
    std::vector<KeyEntry> entries = detection_key(theme);
    const bool points = std::ranges::any_of(points_, [](const auto& row) { return !row.empty(); });
    if (has_outlines())
      entries.push_back({KeyEntry::Mark::line, theme.outline, "outlines of buildings"});
    else if (points)
      entries.push_back({KeyEntry::Mark::disc, theme.dim, "points of the LiDAR"});
    entries.push_back({KeyEntry::Mark::disc, theme.text, "the radar; forward is up"});
    return entries;
  }

  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const PolarMap map = polar();
    canvas.clip(picture);
    map.draw_cells(canvas, picture,
                   [&](int64_t range, int64_t azimuth) { return maps_.color(row, range, azimuth); });
    const double far_m = farthest_m();
    for (const dvec2& point : points_[row]) {
      if (glm::length(point) > far_m) continue;
      const dvec2 at = map.pixel_of(picture, point.x, point.y);
      canvas.blend(static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y)),
                   canvas.theme().over, 0.2);
    }
    if (has_outlines())
      if (const std::optional<Pose> pose = world_from_sensor(source_, source_.chosen[row]))
        draw_outlines(canvas, source_.scene->outlines, *pose, far_m, axes_.azimuth_min, axes_.azimuth_max,
                      [&](double range, double azimuth) { return map.place(picture, range, azimuth); });
    std::vector<MapMark> marks =
        marks_of(row, [&](const Detection& d) { return map.place(picture, d.range, d.azimuth); });
    marks.push_back({MapMark::Kind::sensor, map.place(picture, 0.0, 0.0), true, {}});
    map.draw_rings(canvas, picture);
    draw_map_marks(canvas, marks);
    map.draw_ring_ranges(canvas, picture);
    label_map_marks(canvas, picture, marks);
    canvas.unclip();
    maps_.draw_scale(canvas, legend);
  }
  std::string value_at(const Rect& picture, size_t row, int x, int y, const SceneNames& names) override {
    const PolarMap map = polar();
    const std::string text = map.text_at(
        picture, x, y, [&](int64_t range, int64_t azimuth) { return maps_.level(row, range, azimuth); });
    if (text.empty()) return {};
    return text + marked_at(
                      detections_[row],
                      [&](const Detection& d) { return map.place(picture, d.range, d.azimuth); }, x, y,
                      names);
  }

 private:
  bool has_outlines() const { return source_.scene && !source_.scene->outlines.empty(); }
  PolarMap polar() const {
    return {{axes_.range_bin_m, axes_.azimuth_min, axes_.azimuth_max, rows_, maps_.columns()}, farthest_m()};
  }

  std::vector<std::vector<dvec2>> points_;  ///< metres ahead and to the left, for each row
};

}  // namespace

std::vector<FrameKind> radar_frames() {
  std::vector<FrameKind> kinds{
      {"range-Doppler", {"range_doppler"}, make_frame<RangeDopplerPanel>, "range_doppler"},
      {"range-azimuth", {"range_azimuth"}, make_frame<RangeAzimuthPanel>, "range_azimuth"}};
  for (FrameKind& kind : radar_overlay_frames()) kinds.push_back(std::move(kind));
  return kinds;
}

}  // namespace greatx::io
