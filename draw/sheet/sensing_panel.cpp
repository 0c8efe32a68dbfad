// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws what a channel senses: power over range and velocity, and over the ground as the beams see it, with
// its detections and where its targets truly are.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "draw/sheet/channel_links.h"
#include "draw/sheet/map_marks.h"
#include "draw/sheet/panels.h"
#include "draw/sheet/polar_map.h"
#include "draw/sheet/power_maps.h"

namespace greatx::io {

namespace {

constexpr size_t most_targets = 10'000;

/// Holds the maps of the link that the source names. Detections are circles, red if they belong to a target.
/// Crosses with names are the truth, wrapped into the spans of the waveform; a target without an echo is
/// grey.
class SensingMaps : public FramePanel {
 public:
  SensingMaps(const PanelSource& source, const char* array) : source_(source) {
    read_axes();
    double top = -400.0, floor = 400.0;
    for (const IndexRow& row : source_.chosen) {
      const Array map = source_.load(row, array, {DType::f32}, {0, 0, 0, 0});
      ranges_ = map.shape[2];
      const auto cells = static_cast<size_t>(ranges_ * map.shape[3]);
      std::vector<double> sorted =
          maps_.add(map.as<float>().subspan(place_of_link(map) * cells, cells), map.shape[3]);
      std::sort(sorted.begin(), sorted.end());
      floor = std::min(floor, sorted[sorted.size() / 2]);
      top = std::max(top, sorted[sorted.size() - 1 - sorted.size() / 1000]);
      load_marks(row);
    }
    if (!source_.chosen.empty()) maps_.set_scale(floor, top);
  }

 protected:
  struct Mark {
    double range_m, velocity, azimuth;
    bool truth, strong;  ///< strong: it belongs to a target, or the target has an echo
    uint32_t instance;
    std::string name;
  };

  template <typename Place>
  std::vector<MapMark> marks_of(size_t row, const Place& place) const {
    std::vector<MapMark> marks;
    for (const Mark& mark : marks_[row]) {
      MapMark& drawn = marks.emplace_back(MapMark{
          mark.truth ? MapMark::Kind::truth : MapMark::Kind::detection, place(mark), mark.strong, {}});
      if (mark.truth) drawn.label = mark_label(mark.name, mark.range_m, mark.velocity);
    }
    return marks;
  }
  std::vector<KeyEntry> marks_key(const Theme& theme) const {
    using Kind = KeyEntry::Mark;
    std::vector<KeyEntry> entries;
    if (source_.has("detection_range")) {
      entries.push_back({Kind::ring, theme.detection, "detection of a target"});
      entries.push_back({Kind::ring, theme.false_alarm, "detection of no target"});
    }
    if (!names_.empty()) {
      entries.push_back({Kind::cross, theme.truth, "true place (grey: no echo)"});
      entries.push_back({Kind::none, {}, "labels: true range, range rate"});
    }
    return entries;
  }
  /// Begins a title: the channel, and the link if there are several.
  std::string title_with(const char* what) const {
    const ChannelEnds ends = channel_ends(source_);
    const bool several = ends.receivers.size() * ends.transmitters.size() > 1;
    return fmt::format("{} {}{}{}", source_.spec().name, what, several ? ", " : "",
                       several ? link_text(ends, source_.link) : "");
  }
  /// Returns the marks around pixel (x, y) as text, a line each.
  template <typename Place>
  std::string marks_at(size_t row, int x, int y, const Place& place, const SceneNames& names) const {
    std::string text;
    for (const Mark& mark : marks_[row]) {
      const dvec2 at = place(mark);
      if (std::hypot(x + 0.5 - at.x, y + 0.5 - at.y) > 7.0) continue;
      text += fmt::format("\n{}: {:.2f} m, {:.2f} m/s, {:.1f} deg{}", mark.truth ? mark.name : "detection",
                          mark.range_m, mark.velocity, degrees(mark.azimuth),
                          mark.truth    ? ""
                          : mark.strong ? ", " + names.instance(mark.instance)
                                        : ", of no target");
    }
    return text;
  }
  static void axis_text(Canvas& canvas, int x, int y, const std::string& text, Align align) {
    canvas.rimmed_text(x, y, text, theme::text_scale, canvas.theme().over, canvas.theme().halo, align);
  }
  /// Shows 1.3 times the range of the farthest target or detection of one; the whole map if there is none.
  int shown_ranges() const {
    const auto all = static_cast<int>(ranges_);
    if (farthest_m_ == 0.0) return all;
    return std::clamp(static_cast<int>(1.3 * farthest_m_ / range_bin_m_), std::min(all, 16), all);
  }

  PanelSource source_;
  double range_bin_m_ = 1.0, velocity_min_ = -1.0, velocity_bin_ = 1.0, velocity_span_ = 2.0;
  double azimuth_min_ = -1.0, azimuth_max_ = 1.0, farthest_m_ = 0.0;
  int64_t ranges_ = 1;
  std::vector<std::string> names_;
  PowerMaps maps_;
  std::vector<std::vector<Mark>> marks_;  ///< one list for each row

 private:
  void read_axes() {
    const JsonDocument metadata = metadata_of(source_);
    if (metadata.root().has("sensing")) {
      const JsonValue sensing = metadata.root().at("sensing");
      const auto number = [&](const char* key, double otherwise, double least, double most) {
        return sensing.has(key) ? sensing.at(key).number(least, most) : otherwise;
      };
      range_bin_m_ = number("range_bin_m", 1.0, 1e-9, 1e12);
      velocity_min_ = number("velocity_min_m_s", -1.0, -1e12, 0.0);
      velocity_bin_ = number("velocity_bin_m_s", 1.0, 1e-12, 1e12);
      velocity_span_ =
          number("symbols", std::max(1.0, -2.0 * velocity_min_ / velocity_bin_), 1.0, 1e9) * velocity_bin_;
      azimuth_min_ = number("azimuth_min_rad", azimuth_min_, -7.0, 7.0);
      azimuth_max_ = number("azimuth_max_rad", azimuth_max_, -7.0, 7.0);
      if (azimuth_max_ <= azimuth_min_)
        sensing.at("azimuth_max_rad").fail(fmt::format("more than azimuth_min_rad, {}", azimuth_min_));
    }
    if (metadata.root().has("targets"))
      for (const JsonValue& target : metadata.root().at("targets").list(most_targets))
        names_.push_back(target.at("node").text());
  }

  /// Returns the place of the link among those of an array [rx, tx, ...].
  size_t place_of_link(const Array& array) const {
    const auto [rx, tx] = source_.link;
    if (rx >= static_cast<size_t>(array.shape[0]) || tx >= static_cast<size_t>(array.shape[1]))
      throw_user_error("{}: expected a map for receiver {} and transmitter {}, found {} x {}",
                       source_.place(), rx, tx, array.shape[0], array.shape[1]);
    return rx * static_cast<size_t>(array.shape[1]) + tx;
  }

  double wrapped(double value, double low, double span) const {
    return value - span * std::floor((value - low) / span);
  }

  void load_marks(const IndexRow& row) {
    std::vector<Mark>& marks = marks_.emplace_back();
    if (source_.has("target_range") && !names_.empty()) {
      const auto count = static_cast<int64_t>(names_.size());
      const auto truth = [&](const char* name) {
        return source_.load(row, name, {DType::f64}, {0, 0, count});
      };
      const Array range = truth("target_range"), velocity = truth("target_velocity"),
                  azimuth = truth("target_azimuth"), power = truth("target_power");
      const size_t first = place_of_link(range) * names_.size();
      for (size_t i = 0; i < names_.size(); ++i)
        marks.push_back(
            {wrapped(range.as<double>()[first + i], 0.0, static_cast<double>(ranges_) * range_bin_m_),
             wrapped(velocity.as<double>()[first + i], velocity_min_, velocity_span_),
             azimuth.as<double>()[first + i], true, std::isfinite(power.as<double>()[first + i]), 0,
             names_[i]});
    }
    if (source_.has("detection_range")) {
      const auto column = [&](const char* name, DType type) { return source_.load(row, name, {type}, {-1}); };
      const Array range = column("detection_range", DType::f32),
                  velocity = column("detection_velocity", DType::f32),
                  azimuth = column("detection_azimuth", DType::f32), rx = column("detection_rx", DType::i32),
                  tx = column("detection_tx", DType::i32),
                  instance = column("detection_instance", DType::u32);
      expect_same_rows(source_, {&range, &velocity, &azimuth, &rx, &tx, &instance});
      for (size_t i = 0; i < range.as<float>().size(); ++i)
        if (std::cmp_equal(rx.as<int32_t>()[i], source_.link.rx) &&
            std::cmp_equal(tx.as<int32_t>()[i], source_.link.tx))
          marks.push_back({range.as<float>()[i], velocity.as<float>()[i], azimuth.as<float>()[i], false,
                           instance.as<uint32_t>()[i] != 0, instance.as<uint32_t>()[i], ""});
    }
    for (const Mark& mark : marks)
      if (mark.strong) farthest_m_ = std::max(farthest_m_, mark.range_m);
  }
};

/// Shows power over range and velocity.
class SensingPanel : public SensingMaps {
 public:
  explicit SensingPanel(const PanelSource& source) : SensingMaps(source, "range_doppler") {}
  std::string title() const override { return title_with("range-Doppler"); }
  std::vector<KeyEntry> key(const Theme& theme) override {
    std::vector<KeyEntry> entries = marks_key(theme);
    entries.push_back({KeyEntry::Mark::none, {}, "up: range; right: receding"});
    return entries;
  }

  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const int shown = shown_ranges();
    canvas.clip(picture);
    canvas.raster(picture, static_cast<int>(maps_.columns()), shown,
                  [&](int x, int y) { return maps_.color(row, shown - 1 - y, x); });
    const std::vector<MapMark> marks =
        marks_of(row, [&](const Mark& mark) { return place(picture, mark.range_m, mark.velocity); });
    draw_map_marks(canvas, marks);
    const double step = 100.0 * std::max(1.0, std::round(shown * range_bin_m_ / 400.0));
    for (int i = 1; i * step < (shown - 1) * range_bin_m_; ++i)
      axis_text(canvas, picture.x + 6, static_cast<int>(place(picture, i * step, velocity_min_).y) - 8,
                fmt::format("{:g} m", i * step), Align::left);
    axis_text(canvas, picture.x + 6, picture.bottom() - 20, fmt::format("{:.1f}", velocity_min_),
              Align::left);
    axis_text(canvas, picture.right() - 6, picture.bottom() - 20, fmt::format("+{:.1f} m/s", -velocity_min_),
              Align::right);
    label_map_marks(canvas, picture, marks);
    canvas.unclip();
    maps_.draw_scale(canvas, legend);
  }

  std::string value_at(const Rect& picture, size_t row, int x, int y, const SceneNames& names) override {
    const int shown = shown_ranges();
    const std::optional<RasterCell> cell = cell_at(picture, maps_.columns(), shown, x, y);
    if (!cell) return {};
    const int range = shown - 1 - cell->row;
    const std::string text =
        fmt::format("{:.2f} m, {:.2f} m/s: {:.1f} dBm", range * range_bin_m_,
                    velocity_min_ + cell->column * velocity_bin_, maps_.level(row, range, cell->column));
    return text + marks_at(
                      row, x, y,
                      [&](const Mark& mark) { return place(picture, mark.range_m, mark.velocity); }, names);
  }

 private:
  dvec2 place(const Rect& picture, double range_m, double velocity) const {
    return {picture.x + ((velocity - velocity_min_) / velocity_bin_ + 0.5) * picture.width /
                            static_cast<double>(maps_.columns()),
            picture.bottom() - (range_m / range_bin_m_ + 0.5) * picture.height / shown_ranges()};
  }
};

/// Shows power over the ground from above, in the frame of the receiving antenna: forward up, the radius half
/// of the way.
class SensingAzimuthPanel : public SensingMaps {
 public:
  explicit SensingAzimuthPanel(const PanelSource& source) : SensingMaps(source, "range_azimuth") {
    for (size_t row = 0; row < source_.chosen.size(); ++row) outlined_ |= antenna_pose(row).has_value();
  }
  std::string title() const override { return title_with("from above"); }
  std::vector<KeyEntry> key(const Theme& theme) override {
    std::vector<KeyEntry> entries = marks_key(theme);
    if (outlined_) entries.push_back({KeyEntry::Mark::line, theme.outline, "outlines of buildings"});
    entries.push_back({KeyEntry::Mark::disc, theme.text, "the antenna; forward is up"});
    return entries;
  }

  void draw(Canvas& canvas, const Rect& picture, const Rect& legend, size_t row) override {
    const PolarMap map = polar();
    canvas.clip(picture);
    map.draw_cells(canvas, picture,
                   [&](int64_t range, int64_t azimuth) { return maps_.color(row, range, azimuth); });
    if (const std::optional<Pose> pose = antenna_pose(row))
      draw_outlines(canvas, source_.scene->outlines, *pose, shown_ranges() * range_bin_m_, azimuth_min_,
                    azimuth_max_,
                    [&](double range, double azimuth) { return map.place(picture, range, azimuth); });
    std::vector<MapMark> marks =
        marks_of(row, [&](const Mark& mark) { return map.place(picture, mark.range_m, mark.azimuth); });
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
    return text + marks_at(
                      row, x, y,
                      [&](const Mark& mark) { return map.place(picture, mark.range_m, mark.azimuth); },
                      names);
  }

 private:
  /// Returns the pose of the receiving antenna in the world, if the outlines can be drawn: the transmitter is
  /// on the same node, so that half of the way is a distance.
  std::optional<Pose> antenna_pose(size_t row) const {
    if (!source_.scene || source_.scene->outlines.empty()) return std::nullopt;
    const ChannelEnds ends = channel_ends(source_);
    const JsonDocument metadata = metadata_of(source_);
    if (!metadata.root().has("receivers") || source_.link.rx >= ends.receivers.size() ||
        source_.link.tx >= ends.transmitters.size())
      return std::nullopt;
    const std::string& name = ends.receivers[source_.link.rx];
    const std::string node = name.substr(0, name.find('/'));
    const std::string& other = ends.transmitters[source_.link.tx];
    if (other.substr(0, other.find('/')) != node) return std::nullopt;
    const std::optional<Pose> body = world_from_node(source_, source_.chosen[row], node);
    const JsonValue antenna = metadata.root().at("receivers").list(ends.receivers.size())[source_.link.rx];
    if (!body) return std::nullopt;
    return antenna.has("body_from_antenna") ? *body * pose_of(antenna.at("body_from_antenna")) : *body;
  }
  PolarMap polar() const {
    return {{range_bin_m_, azimuth_min_, azimuth_max_, ranges_, maps_.columns()},
            shown_ranges() * range_bin_m_};
  }
  bool outlined_ = false;
};

}  // namespace

std::vector<FrameKind> sensing_frames() {
  return {{"range-Doppler", {"range_doppler"}, make_frame<SensingPanel>, "sensing"},
          {"range-azimuth", {"range_azimuth"}, make_frame<SensingAzimuthPanel>, "sensing_azimuth"}};
}

}  // namespace greatx::io
