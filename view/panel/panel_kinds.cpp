// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/panel/panel_kinds.h"

#include <algorithm>
#include <cmath>

namespace greatx::view {

namespace theme = io::theme;

void require_arrays(const SensorSpec& sensor, std::span<const char* const> arrays, const std::string& kind) {
  for (const char* name : arrays)
    if (std::ranges::find(sensor.arrays, name, &ArraySpec::name) == sensor.arrays.end())
      throw_user_error("{}: the panel '{}' needs the array {}, which the sensor does not deliver",
                       sensor.name, kind, name);
}

PlotPlace place_plot(const io::Canvas& canvas, bool color_scale) {
  constexpr int left = 92, top = 8, bottom = 12 + 2 * theme::line_height, right_of_scale = 92, right = 20;
  const int above = color_scale ? top + theme::line_height : top;
  const io::Rect plot{left, above, canvas.width() - left - (color_scale ? right_of_scale : right),
                      canvas.height() - above - bottom};
  if (plot.width >= 40 && plot.height >= 40) return {plot, true};
  return {{0, 0, canvas.width(), canvas.height()}, false};
}

double value_at_pixel(const io::Scale& scale, int start, int extent, int i) {
  return scale.low + (i - start + 0.5) / extent * (scale.high - scale.low);
}

void write_note(io::Canvas& canvas, const std::string& text, io::Color color) {
  const int scale = canvas.width() < 240 ? 1 : theme::text_scale;
  const auto most =
      static_cast<size_t>(std::max(1, (canvas.width() - 8) / (io::Canvas::glyph_width * scale)));
  std::vector<std::string> lines{""};
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find_first_of(" \n", begin), text.size());
    std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > most) lines.emplace_back();
    if (!lines.back().empty()) lines.back() += ' ';
    for (; lines.back().size() + word.size() > most; lines.emplace_back()) {
      const size_t room = most - lines.back().size();
      lines.back() += word.substr(0, room);
      word.erase(0, room);
    }
    lines.back() += word;
  }
  const int height = (io::Canvas::glyph_height + 3) * scale;
  int y = std::max(0, (canvas.height() - static_cast<int>(lines.size()) * height) / 2);
  for (const std::string& line : lines) {
    canvas.text(canvas.width() / 2, y, line, scale, color, io::Align::center);
    y += height;
  }
}

std::string with_prefix(double value, const char* unit) {
  if (std::isnan(value)) return "none";
  if (std::isinf(value)) return value > 0.0 ? "infinite" : "-infinite";
  static constexpr struct {
    double factor;
    const char* name;
  } prefixes[] = {{1e9, "G"},  {1e6, "M"},  {1e3, "k"},  {1.0, ""},
                  {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}, {1e-12, "p"}};
  if (value == 0.0) return fmt::format("0 {}", unit);
  for (const auto& prefix : prefixes)
    if (std::abs(value) >= 0.9999999 * prefix.factor)
      return fmt::format("{:.4g} {}{}", value / prefix.factor, prefix.name, unit);
  return fmt::format("{:.4g} {}", value, unit);
}

LinkSizes link_sizes(const SensorSpec& sensor) {
  LinkSizes sizes;
  for (const ArraySpec& array : sensor.arrays) {
    const std::vector<int64_t>& shape = array.shape;
    if (shape.size() == 6 && shape[0] > 0) return {shape[0], shape[1], shape[2], shape[3]};
    if (shape.size() == 2 && shape[0] > 0) sizes.receivers = shape[0], sizes.transmitters = shape[1];
    if (array.name == "amplitude" && shape.size() == 3)
      sizes.receiver_ports = shape[1], sizes.transmitter_ports = shape[2];
  }
  return sizes;
}

}  // namespace greatx::view
