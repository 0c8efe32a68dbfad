// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/map/draw.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "draw/paths/stroke.h"

namespace greatx::apps {

namespace {

using io::Canvas;
using io::Color;
using io::Rect;
namespace theme = io::theme;

constexpr Color nothing_color{58, 58, 64}, halo{10, 12, 18}, marker_color{255, 92, 92};
constexpr double outline_jump_m = 2.0, outline_opacity = 0.6;

constexpr int glyph = Canvas::glyph_width * theme::text_scale;

/// Returns the background in muted colours. Its grey levels are stretched to a fixed range, so that the
/// result does not depend on the lighting. Pixels that see nothing have the colour of a panel.
std::vector<uint8_t> subdued(const MapBackground& background) {
  constexpr double saturation = 0.4, dark = 0.28, light = 0.92;
  std::vector<double> greys;
  const auto grey_of = [&](size_t pixel) {
    const uint8_t* c = &background.rgb[3 * pixel];
    return (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) / 255.0;
  };
  for (size_t i = 0; i < background.z_m.size(); ++i)
    if (std::isfinite(background.z_m[i])) greys.push_back(grey_of(i));
  std::vector<uint8_t> out(background.rgb.size(), 0);
  if (greys.empty()) greys = {0.0, 1.0};
  const auto quantile = [&](double q) {
    const auto at = greys.begin() + static_cast<ptrdiff_t>(q * static_cast<double>(greys.size() - 1));
    std::nth_element(greys.begin(), at, greys.end());
    return *at;
  };
  const double low = quantile(0.02), high = std::max(quantile(0.98), low + 0.05);
  for (size_t i = 0; i < background.z_m.size(); ++i) {
    const uint8_t page[] = {theme::panel.r, theme::panel.g, theme::panel.b};
    const double grey = grey_of(i), level = dark + (light - dark) * (grey - low) / (high - low);
    for (size_t c = 0; c < 3; ++c) {
      const double tint = saturation * (background.rgb[3 * i + c] / 255.0 - grey);
      out[3 * i + c] = std::isfinite(background.z_m[i])
                           ? static_cast<uint8_t>(std::clamp(255.0 * (level + tint), 0.0, 255.0))
                           : page[c];
    }
  }
  return out;
}

bool has_value(double value) { return !std::isnan(value) && value != -INFINITY; }

/// Returns the map in the pixels of the background, without axes, markers and texts.
Array composed(const MapStage& stage, const MapLayer& layer, const MapScale& scale) {
  const MapBackground& background = stage.background;
  const sim::MapGrid& grid = stage.cells->grid;
  const auto width = background.pixels.width, height = background.pixels.height;
  std::vector<uint8_t> rgb = subdued(background);
  const auto z = [&](uint32_t x, uint32_t y) { return background.z_m[size_t{y} * width + x]; };
  const auto jump = [&](uint32_t x, uint32_t y, uint32_t u, uint32_t v) {
    return u < width && v < height && std::abs(z(x, y) - z(u, v)) > outline_jump_m;
  };
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      // This is the cell at the centre of the pixel. Rows of pixels begin in the north, rows of cells in the
      // south.
      const auto column = static_cast<uint32_t>((x + 0.5) * grid.columns / width),
                 row = grid.rows - 1 - static_cast<uint32_t>((y + 0.5) * grid.rows / height);
      const size_t cell = size_t{row} * grid.columns + column;
      uint8_t* out = &rgb[3 * (size_t{y} * width + x)];
      if (stage.cells->solved(cell)) {
        const Color color = color_of_cell(layer, scale, layer.values[cell]);
        out[0] = color.r, out[1] = color.g, out[2] = color.b;
      }
      if (!jump(x, y, x + 1, y) && !jump(x, y, x, y + 1)) continue;
      const uint8_t line[] = {halo.r, halo.g, halo.b};
      for (size_t c = 0; c < 3; ++c)
        out[c] = static_cast<uint8_t>(std::lround(out[c] + outline_opacity * (line[c] - out[c])));
    }
  return Array::of<uint8_t>({height, width, 3}, rgb);
}

void draw_markers(Canvas& canvas, const Rect& area, const MapStage& stage) {
  const MapPixels& pixels = stage.background.pixels;
  canvas.clip(area);
  for (const MapMarker& marker : stage.transmitters) {
    const dvec2 p =
        pixels.at(marker.position_m) / dvec2(pixels.width, pixels.height) * dvec2(area.width, area.height);
    if (p.x < 0.0 || p.y < 0.0 || p.x > area.width || p.y > area.height) continue;
    ShapeCoverage coverage(area.width, area.height);
    for (const double grown : {3.0, 0.0}) {
      const double reach = 20.0;
      coverage.shape(p - reach, p + reach, [&](const dvec2& q) {
        return marker_distance(rf::InteractionType::diffraction, q - p, 8.0) - grown;
      });
      coverage.paint(canvas, {area.x, area.y}, grown > 0.0 ? halo : marker_color, 1.0);
    }
    const int width = Canvas::text_width(marker.name, theme::text_scale);
    const int x = std::clamp(area.x + static_cast<int>(p.x) - width / 2, area.x + 8,
                             std::max(area.x + 8, area.right() - width - 8));
    const int above = area.y + static_cast<int>(p.y) - 36;
    const int y = above < area.y + 4 ? above + 52 : above;
    canvas.fill({x - 5, y - 4, width + 8, 23}, halo, 0.7);
    canvas.text(x, y, marker.name, theme::text_scale, {255, 200, 200});
  }
  canvas.unclip();
}

/// Draws a scale bar of a round length.
void draw_compass(Canvas& canvas, int x, int y, double pixels_per_m, double extent_m) {
  const double length = io::round_down(0.3 * extent_m);
  const int width = static_cast<int>(std::lround(length * pixels_per_m));
  canvas.fill({x, y + 6, width, 4}, theme::text);
  canvas.fill({x, y, 2, 16}, theme::text);
  canvas.fill({x + width - 2, y, 2, 16}, theme::text);
  canvas.text(x + width + 12, y + 1,
              length >= 1000.0 ? fmt::format("{:g} km", 1e-3 * length) : fmt::format("{:g} m", length),
              theme::text_scale, theme::text);
}

void draw_north(Canvas& canvas, int x, int y) {
  canvas.line(x, y + 26, x, y + 3, 2.5, theme::text);
  canvas.line(x, y + 2, x - 6, y + 12, 2.5, theme::text);
  canvas.line(x, y + 2, x + 6, y + 12, 2.5, theme::text);
  canvas.text(x + 12, y + 8, "N", theme::text_scale, theme::text);
}

int draw_swatch(Canvas& canvas, int x, int y, Color color, const std::string& text) {
  canvas.fill({x, y, 16, 16}, color);
  canvas.frame({x, y, 16, 16}, theme::border);
  canvas.text(x + 24, y + 1, text, theme::text_scale, theme::dim);
  return x + 24 + Canvas::text_width(text, theme::text_scale) + 20;
}

/// Draws the legend at the right of a map: the names of the classes below each other, or a bar of colours.
void draw_colors(Canvas& canvas, const Rect& map, int x, const MapLayer& layer, const MapScale& scale) {
  if (!layer.classes.empty()) {
    for (size_t i = 0; i < layer.classes.size(); ++i)
      draw_swatch(canvas, x, map.y + 4 + theme::line_height * static_cast<int>(i),
                  color_of_cell(layer, scale, static_cast<double>(i)), layer.classes[i]);
    return;
  }
  const Rect bar{x, map.y + 28, 22, std::min(map.height - 36, 460)};
  io::draw_color_scale(canvas, bar, scale.scale, io::viridis, layer.unit);
}

/// Returns the width of the legend of colours, pixels.
int color_room(const MapLayer& layer) {
  size_t longest = 8;
  for (const std::string& name : layer.classes) longest = std::max(longest, name.size() + 2);
  return 30 + static_cast<int>(longest) * glyph;
}

std::string clipping(const MapScale& scale) {
  const char* which = scale.clipped_low && scale.clipped_high ? "lowest and the highest"
                      : scale.clipped_low                     ? "lowest"
                                                              : "highest";
  return scale.clipped_low || scale.clipped_high
             ? fmt::format("the {} 1 % of the cells lie beyond the colours' range", which)
             : "";
}

/// Returns the unit in which a quantity is shown (dB, degrees, nanoseconds), and the conversion to this unit.
std::pair<std::string, double (*)(double)> shown(const sim::MapQuantity& quantity) {
  if (quantity.name == "path_gain" || quantity.name == "beam_gain" || quantity.name == "k_factor")
    return {"dB", [](double v) { return decibels(v); }};
  if (quantity.unit == "s") return {"ns", [](double v) { return 1e9 * v; }};
  if (quantity.unit == "rad") return {"deg", [](double v) { return degrees(v); }};
  return {quantity.unit, [](double v) { return v; }};
}

std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  if (name == "rss") return "received power";
  if (name == "sinr") return "SINR";
  return name == "k factor" ? "K-factor" : name;
}

}  // namespace

Color color_of_cell(const MapLayer& layer, const MapScale& scale, double value) {
  if (!has_value(value)) return nothing_color;
  if (!layer.classes.empty())
    return layer.classes.size() == 2 && layer.unit.empty() ? io::viridis(value > 0.5 ? 0.9 : 0.25)
                                                           : io::color_of_series(static_cast<size_t>(value));
  return io::viridis(std::clamp(scale.scale.at(value), 0.0, 1.0));
}

MapScale map_scale(std::span<const double> values) {
  std::vector<double> sorted;
  for (const double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  MapScale result;
  if (sorted.empty()) return result;
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&](double q) {
    return sorted[static_cast<size_t>(std::lround(q * static_cast<double>(sorted.size() - 1)))];
  };
  double low = sorted.front(), high = sorted.back();
  const double most = quantile(0.99), least = quantile(0.01);
  if (high - most > (most - least) / 3.0) high = most, result.clipped_high = true;
  if (least - low > (most - least) / 3.0) low = least, result.clipped_low = true;
  const double room = 1e-9 * std::max({std::abs(low), std::abs(high), 1e-3});
  result.scale = {low, high > low + room ? high : low + std::max(room, 1.0)};
  return result;
}

MapLayer map_layer(const sim::RadioMap& map, const sim::MapQuantity& quantity,
                   std::optional<size_t> transmitter, const std::vector<MapMarker>& transmitters) {
  MapLayer layer;
  layer.title = words(quantity.name);
  const auto [unit, convert] = shown(quantity);
  if (transmitter && quantity.per_transmitter) {
    const Array all = sim::map_array(map, quantity);
    const size_t cells = map.cells->grid.cells();
    for (size_t cell = 0; cell < cells; ++cell) {
      const size_t at = *transmitter * cells + cell;
      layer.values.push_back(quantity.dtype == DType::f64   ? all.as<double>()[at]
                             : quantity.dtype == DType::i32 ? all.as<int32_t>()[at]
                                                            : all.as<uint8_t>()[at]);
      if (map.links[cell * map.transmitters() + *transmitter].paths == 0) layer.values.back() = NAN;
    }
    layer.title += fmt::format(" of {}", transmitters[*transmitter].name);
  } else {
    layer.values = sim::map_at_best_server(map, quantity);
    if (quantity.per_transmitter && map.transmitters() > 1) layer.title += " of the best server";
  }
  for (double& value : layer.values) value = convert(value);
  layer.unit = unit == "1" ? "" : unit;
  if (quantity.name == "best_server")
    for (const MapMarker& marker : transmitters) layer.classes.push_back(marker.name);
  if (quantity.name == "best_server") layer.unit = "name";
  if (quantity.name == "line_of_sight") layer.classes = {"not in sight", "line of sight"};
  if (quantity.name == "k_factor") layer.nothing = "no line of sight";
  return layer;
}

Array draw_map(const MapStage& stage, const MapLayer& layer) {
  const MapScale scale = map_scale(layer.values);
  const MapPixels& pixels = stage.background.pixels;
  const auto width = static_cast<int>(pixels.width), height = static_cast<int>(pixels.height);
  constexpr int left = 104, top = 66, bottom = 118;
  const Rect map{left, top, width, height};
  Canvas canvas(left + std::max(width, 560) + color_room(layer) + 24, top + height + bottom, theme::page);
  canvas.text(16, 10, fmt::format("{}: {}", stage.title, layer.title), theme::text_scale, theme::text);
  canvas.text(16, 10 + theme::line_height, stage.subtitle, theme::text_scale, theme::dim);
  canvas.picture(map, composed(stage, layer, scale));
  canvas.frame(map, theme::border);
  draw_markers(canvas, map, stage);
  io::draw_x_axis(canvas, map, {pixels.min_m.x, pixels.max_m.x}, "x, east (m)");
  io::draw_y_axis(canvas, map, {pixels.min_m.y, pixels.max_m.y}, "y, north (m)");
  draw_colors(canvas, map, map.right() + 20, layer, scale);
  const int foot = map.bottom() + 62;
  const double extent = pixels.max_m.x - pixels.min_m.x;
  draw_compass(canvas, left, foot, width / extent, extent);
  draw_north(canvas, canvas.width() - 50, foot - 10);
  const int swatch = left + static_cast<int>(0.3 * std::max(width, 400)) + 110;
  draw_swatch(canvas, swatch, foot, nothing_color, layer.nothing);
  canvas.text(left, foot + 28, layer.classes.empty() ? clipping(scale) : "", theme::text_scale, theme::dim);
  return canvas.image();
}

Array draw_maps(const MapStage& stage, std::span<const MapLayer> layers) {
  constexpr int side = 460, gap = 28, head = 66, title = 30, foot = 56;
  const MapPixels& pixels = stage.background.pixels;
  const double shrink = static_cast<double>(side) / std::max(pixels.width, pixels.height);
  const int width = std::max(1, static_cast<int>(std::lround(shrink * pixels.width))),
            height = std::max(1, static_cast<int>(std::lround(shrink * pixels.height)));
  int room = 0;
  for (const MapLayer& layer : layers) room = std::max(room, color_room(layer));
  const int columns = layers.size() < 3 ? static_cast<int>(layers.size()) : layers.size() == 4 ? 2 : 3;
  const int rows = (static_cast<int>(layers.size()) + columns - 1) / columns;
  const int step_x = width + room + gap, step_y = height + title + gap;
  Canvas canvas(gap + columns * step_x, head + rows * step_y + foot, theme::page);
  canvas.text(gap, 10, stage.title, theme::text_scale, theme::text);
  canvas.text(gap, 10 + theme::line_height, stage.subtitle, theme::text_scale, theme::dim);
  for (size_t i = 0; i < layers.size(); ++i) {
    const MapScale scale = map_scale(layers[i].values);
    const Rect map{gap + static_cast<int>(i) % columns * step_x,
                   head + title + static_cast<int>(i) / columns * step_y, width, height};
    canvas.text(map.x, map.y - theme::line_height, layers[i].title, theme::text_scale, theme::text);
    canvas.picture(map, composed(stage, layers[i], scale));
    canvas.frame(map, theme::border);
    draw_markers(canvas, map, stage);
    draw_colors(canvas, map, map.right() + 14, layers[i], scale);
  }
  const int y = canvas.height() - foot + 12;
  const double extent = pixels.max_m.x - pixels.min_m.x;
  draw_compass(canvas, gap, y, width / extent, extent);
  draw_swatch(canvas, gap + static_cast<int>(0.3 * width) + 130, y, nothing_color, "no value");
  draw_north(canvas, canvas.width() - 60, y - 8);
  return canvas.image();
}

}  // namespace greatx::apps
