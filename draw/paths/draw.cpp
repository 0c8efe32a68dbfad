// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/paths/draw.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "draw/canvas/plot.h"

namespace greatx::apps {

namespace {

using io::Canvas;
using io::Color;
namespace theme = io::theme;

constexpr double shown_range_db = 60.0;
constexpr Color halo{10, 12, 18}, paper{255, 255, 255};
constexpr Color transmitter_color{255, 92, 92}, receiver_color{96, 200, 255};

/// Describes a path in the picture.
struct DrawnPath {
  const rf::Path* path = nullptr;
  double gain_db = 0.0;
  Color color;
  double width = 2.0, opacity = 1.0;
  std::vector<Stretch> stretches;
};

/// Returns the picture darker and less saturated, so that the paths stand out.
std::vector<uint8_t> subdued(std::span<const uint8_t> rgb) {
  constexpr double saturation = 0.65, brightness = 0.8;
  std::vector<uint8_t> out(rgb.size());
  for (size_t i = 0; i + 2 < rgb.size(); i += 3) {
    const double grey = 0.2126 * rgb[i] + 0.7152 * rgb[i + 1] + 0.0722 * rgb[i + 2];
    for (size_t c = 0; c < 3; ++c)
      out[i + c] = static_cast<uint8_t>(
          std::clamp(brightness * (grey + saturation * (rgb[i + c] - grey)), 0.0, 255.0));
  }
  return out;
}

/// Draws paths, their interactions and their ends over a view.
class Painter {
 public:
  /// `finer` (0 to 1) scales the widths of lines and the sizes of markers. It is smaller if there are many
  /// paths.
  Painter(Canvas& canvas, const PictureView& view, std::span<const float> depth, const dvec3& origin,
          double finer)
      : canvas_(canvas),
        view_(view),
        depth_(depth),
        origin_(origin),
        finer_(finer),
        coverage_(static_cast<int>(view.width), static_cast<int>(view.height)) {}

  void paths(std::vector<DrawnPath>& paths);
  /// Draws the marker of an end and its name. `away` is a direction in the picture away from the paths; the
  /// name is on this side.
  void end(const dvec3& world, Color color, const std::string& name, bool transmitter, const dvec2& away);
  /// Returns the direction in the picture opposite to the paths at an end, not normalised.
  dvec2 away_from_paths(std::span<const PathLink> links, bool transmitter) const;

 private:
  void lines(const DrawnPath& path, bool hidden, double width, Color color, double opacity);
  void markers(const DrawnPath& path);
  void marker(const dvec3& pixel, rf::InteractionType type, double radius, Color color, bool hidden);
  bool hidden(const dvec3& pixel) const;

  static constexpr ivec2 offset_{0, picture_head};
  Canvas& canvas_;
  const PictureView& view_;
  std::span<const float> depth_;
  dvec3 origin_;
  double finer_;
  ShapeCoverage coverage_;
};

void Painter::lines(const DrawnPath& path, bool hidden, double width, Color color, double opacity) {
  for (const Stretch& run : path.stretches)
    if (run.hidden == hidden) coverage_.line(run.a, run.b, width);
  coverage_.paint(canvas_, offset_, color, opacity);
}

void Painter::paths(std::vector<DrawnPath>& paths) {
  for (DrawnPath& path : paths)
    for (size_t i = 0; i + 1 < path.path->vertices.size(); ++i)
      for (const Stretch& run :
           stretches_of(view_, depth_, path.path->vertices[i], path.path->vertices[i + 1]))
        path.stretches.push_back(run);
  for (const DrawnPath& path : paths)
    lines(path, true, 1.4 * finer_, path.color, 0.5 * finer_ * path.opacity);
  for (const DrawnPath& path : paths) {
    lines(path, false, (path.width + 2.4) * finer_, halo, 0.55 * path.opacity);
    lines(path, false, path.width * finer_, path.color, path.opacity);
  }
  for (const DrawnPath& path : paths) markers(path);
}

bool Painter::hidden(const dvec3& pixel) const {
  const auto x = static_cast<int64_t>(std::floor(pixel.x)), y = static_cast<int64_t>(std::floor(pixel.y));
  if (x < 0 || y < 0 || x >= view_.width || y >= view_.height) return true;
  return is_hidden(pixel.z, depth_[static_cast<size_t>(y) * view_.width + static_cast<size_t>(x)]);
}

void Painter::marker(const dvec3& pixel, rf::InteractionType type, double radius, Color color,
                     bool is_behind) {
  const auto draw = [&](double grown, Color fill, double opacity) {
    const double reach = 1.6 * radius + grown;
    coverage_.shape(dvec2(pixel) - reach, dvec2(pixel) + reach,
                    [&](const dvec2& p) { return marker_distance(type, p - dvec2(pixel), radius) - grown; });
    coverage_.paint(canvas_, offset_, fill, opacity);
  };
  draw(1.6 * finer_, halo, is_behind ? 0.35 : 0.8);
  draw(0.0, color, is_behind ? 0.45 : 1.0);
}

void Painter::markers(const DrawnPath& path) {
  for (size_t i = 0; i < path.path->interactions.size(); ++i) {
    const dvec3 pixel = view_.project(path.path->vertices[i + 1]);
    if (pixel.z < view_.near_m) continue;
    const bool behind = hidden(pixel);
    marker(pixel, path.path->interactions[i].type, finer_ * (behind ? 2.6 : 3.6), paper, behind);
  }
}

dvec2 Painter::away_from_paths(std::span<const PathLink> links, bool transmitter) const {
  dvec2 sum(0.0);
  for (const PathLink& link : links)
    for (const rf::Path& path : link.paths) {
      const size_t last = path.vertices.size() - 1;
      const dvec3 from = view_.project(path.vertices[transmitter ? 0 : last]),
                  to = view_.project(path.vertices[transmitter ? 1 : last - 1]);
      const dvec2 along(to - from);
      if (from.z < view_.near_m || to.z < view_.near_m || glm::length(along) < 1.0) continue;
      sum -= glm::normalize(along);
    }
  return sum;
}

void Painter::end(const dvec3& world, Color color, const std::string& name, bool transmitter,
                  const dvec2& away) {
  const dvec3 pixel = view_.project(world - origin_);
  if (pixel.z < view_.near_m || pixel.x < 0.0 || pixel.x > view_.width || pixel.y < 0.0 ||
      pixel.y > view_.height)
    return;
  // The marker is drawn even if the end is hidden, because the picture is useless without its ends.
  marker(pixel, transmitter ? rf::InteractionType::diffraction : rf::InteractionType::reflection,
         transmitter ? 8.0 : 6.5 * finer_, color, false);
  if (name.empty()) return;
  const int width = Canvas::text_width(name, theme::text_scale);
  const int x = std::clamp(static_cast<int>(std::lround(pixel.x)) - width / 2, 6,
                           std::max(6, static_cast<int>(view_.width) - width - 6));
  int y = static_cast<int>(std::lround(pixel.y)) + offset_.y + (away.y > 0.0 ? 18 : -34);
  y = std::clamp(y, offset_.y + 6, offset_.y + static_cast<int>(view_.height) - 24);
  canvas_.fill({x - 5, y - 4, width + 8, 23}, halo, 0.65);
  canvas_.text(x, y, name, theme::text_scale, color);
}

std::vector<DrawnPath> drawn_paths(std::span<const PathLink> links, double carrier_hz, PathColors colors,
                                   const GainScale& scale) {
  std::vector<DrawnPath> paths;
  for (const PathLink& link : links)
    for (const rf::Path& path : link.paths) {
      DrawnPath drawn;
      drawn.path = &path;
      drawn.gain_db = gain_db(path_gain(path, carrier_hz));
      drawn.color =
          colors == PathColors::gain ? color_of_gain(scale, drawn.gain_db) : color_of_kind(kind_of(path));
      paths.push_back(std::move(drawn));
    }
  // The strongest paths are drawn last, above the others.
  std::stable_sort(paths.begin(), paths.end(),
                   [](const DrawnPath& a, const DrawnPath& b) { return a.gain_db < b.gain_db; });
  for (DrawnPath& path : paths) {
    const double weakness =
        std::min(1.0, (paths.back().gain_db - path.gain_db) / (scale.high_db - scale.low_db));
    path.width = 4.0 - 2.0 * weakness;
    // Colours of kinds do not show the gain, so weak paths are more transparent.
    if (colors == PathColors::kind) path.opacity = 1.0 - 0.65 * weakness;
  }
  return paths;
}

void draw_head(Canvas& canvas, const PictureText& text, std::span<const PathLink> links, double carrier_hz) {
  canvas.text(16, 10, text.title, theme::text_scale, theme::text);
  canvas.text(canvas.width() - 16, 10, text.moment, theme::text_scale, theme::dim, io::Align::right);
  size_t paths = 0;
  for (const PathLink& link : links) paths += link.paths.size();
  std::string line = text.transmitter + " -> ";
  if (links.size() == 1) {
    const LinkFigures figures = figures_of(links[0], carrier_hz);
    line += fmt::format("{}, {:.1f} m: {} paths", links[0].name, links[0].distance_m, paths);
    if (figures.gain > 0.0) line += fmt::format(", gain {:.1f} dB", gain_db(figures.gain));
  } else {
    line += fmt::format("{} receivers: {} paths", links.size(), paths);
  }
  canvas.text(16, 34, line, theme::text_scale, theme::dim);
}

/// Draws a bar of colours with ticks below. Returns the x at which the bar and its unit end.
int draw_gain_bar(Canvas& canvas, int x, int y, const GainScale& scale) {
  constexpr int width = 360, height = 14;
  canvas.text(x, y + 3, "path gain", theme::text_scale, theme::dim);
  const int left = x + Canvas::text_width("path gain ", theme::text_scale) + 8;
  const io::Rect bar{left, y + 2, width, height};
  canvas.raster(bar, width, 1, [&](int column, int) {
    return color_of_gain(scale, scale.low_db + (scale.high_db - scale.low_db) * column / (width - 1.0));
  });
  canvas.frame(bar, theme::border);
  const int steps = static_cast<int>(std::lround((scale.high_db - scale.low_db) / 10.0));
  const int stride = steps > 4 ? 2 : 1;  // counted from the strong end
  for (int i = steps; i >= 0; i -= stride) {
    const int tick = left + (width - 1) * i / steps;
    canvas.fill({tick, bar.bottom() + 1, 1, 4}, theme::dim);
    const bool last = i < stride;
    canvas.text(tick, bar.bottom() + 8,
                fmt::format("{}{:.0f}", last && scale.weaker ? "<" : "", scale.low_db + 10.0 * i),
                theme::text_scale, theme::dim, io::Align::center);
  }
  canvas.text(bar.right() + 14, y + 3, "dB", theme::text_scale, theme::dim);
  return bar.right() + 14 + Canvas::text_width("dB   ", theme::text_scale);
}

/// Draws a legend of the kinds of paths with their numbers. Returns the x at which the legend ends.
int draw_kind_lines(Canvas& canvas, int x, int y, const std::array<size_t, path_kinds.size()>& counts) {
  for (size_t i = 0; i < path_kinds.size(); ++i) {
    if (counts[i] == 0) continue;
    canvas.line(x, y + 10, x + 26, y + 10, 3.0, color_of_kind(path_kinds[i]));
    const std::string name = fmt::format("{} ({})", kind_name(path_kinds[i]), counts[i]);
    canvas.text(x + 34, y + 3, name, theme::text_scale, theme::dim);
    x += 34 + Canvas::text_width(name, theme::text_scale) + 24;
  }
  return x;
}

/// Draws a legend of the markers that occur in the picture. `right` is the x at which the line ends.
void draw_marker_legend(Canvas& canvas, int right, int y, std::span<const PathLink> links) {
  std::array<bool, path_kinds.size()> there{};
  for (const PathLink& link : links)
    for (const rf::Path& path : link.paths)
      for (const rf::Interaction& interaction : path.interactions)
        there[static_cast<size_t>(interaction.type)] = true;
  int x = right;
  for (size_t i = path_kinds.size(); i-- > 1;) {
    if (!there[i]) continue;
    const std::string name = kind_name(path_kinds[i]);
    x -= Canvas::text_width(name, theme::text_scale);
    canvas.text(x, y + 3, name, theme::text_scale, theme::dim);
    x -= 14;
    ShapeCoverage coverage(24, 24);
    coverage.shape({0, 0}, {24, 24},
                   [&](const dvec2& p) { return marker_distance(path_kinds[i], p - dvec2(12.0), 5.0); });
    coverage.paint(canvas, {x - 12, y - 2}, paper, 1.0);
    x -= 34;
  }
}

}  // namespace

double GainScale::at(double gain_db) const {
  return std::clamp((gain_db - low_db) / (high_db - low_db), 0.0, 1.0);
}

GainScale gain_scale(std::span<const PathLink> links, double carrier_hz) {
  GainScale scale;
  double low = 1e300, high = -1e300;
  for (const PathLink& link : links)
    for (const rf::Path& path : link.paths) {
      const double path_gain_db = gain_db(path_gain(path, carrier_hz));
      if (!std::isfinite(path_gain_db)) {  // no power at all
        scale.weaker = true;
        continue;
      }
      low = std::min(low, path_gain_db);
      high = std::max(high, path_gain_db);
    }
  if (low > high) return scale;
  scale.high_db = 10.0 * std::ceil(high / 10.0);
  scale.low_db = std::min(10.0 * std::floor(low / 10.0), scale.high_db - 20.0);
  scale.weaker |= low < scale.high_db - shown_range_db;
  scale.low_db = std::max(scale.low_db, scale.high_db - shown_range_db);
  return scale;
}

io::Color color_of_gain(const GainScale& scale, double gain_db) {
  return io::turbo(0.12 + 0.8 * scale.at(gain_db));  // without the ends of Turbo, which are very dark
}

io::Color color_of_kind(rf::InteractionType kind) {
  constexpr Color colors[] = {{120, 235, 130}, {255, 176, 64},  {90, 190, 255},
                              {255, 110, 170}, {190, 150, 255}, {255, 240, 100}};
  return colors[static_cast<size_t>(kind)];
}

Array draw_paths(const PictureView& view, std::span<const uint8_t> rgb, std::span<const float> depth,
                 std::span<const PathLink> links, const PathScene& scene, PathColors colors,
                 const PictureText& text) {
  const auto width = static_cast<int>(view.width), height = static_cast<int>(view.height);
  Canvas canvas(width, height + picture_head + picture_foot, theme::page);
  const io::Rect area{0, picture_head, width, height};
  canvas.picture(area, Array::of<uint8_t>({height, width, 3}, subdued(rgb)));

  const GainScale scale = gain_scale(links, scene.carrier_hz);
  canvas.clip(area);
  std::vector<DrawnPath> paths = drawn_paths(links, scene.carrier_hz, colors, scale);
  constexpr double many = 80.0;
  const double finer =
      std::clamp(std::sqrt(many / std::max<double>(1.0, static_cast<double>(paths.size()))), 0.45, 1.0);
  Painter painter(canvas, view, depth, scene.scene->origin, finer);
  painter.paths(paths);
  // The names of many receivers would cover the picture.
  constexpr size_t most_names = 12;
  for (const PathLink& link : links)
    painter.end(link.receiver_m, receiver_color, links.size() <= most_names ? link.name : "", false,
                painter.away_from_paths(std::span(&link, 1), false));
  if (!links.empty())
    painter.end(links[0].transmitter_m, transmitter_color, text.transmitter, true,
                painter.away_from_paths(links, true));
  canvas.unclip();

  draw_head(canvas, text, links, scene.carrier_hz);
  const int y = picture_head + height + 12;
  if (colors == PathColors::gain) {
    draw_gain_bar(canvas, 16, y, scale);
  } else {
    std::array<size_t, path_kinds.size()> counts{};
    for (const DrawnPath& path : paths) ++counts[static_cast<size_t>(kind_of(*path.path))];
    draw_kind_lines(canvas, 16, y, counts);
  }
  draw_marker_legend(canvas, width - 16, y, links);
  return canvas.image();
}

}  // namespace greatx::apps
