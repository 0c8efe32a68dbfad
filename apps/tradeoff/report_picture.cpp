// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/tradeoff/report.h"
#include "draw/canvas/plot.h"
#include "draw/sheet/panels.h"

namespace greatx::apps {

namespace {

const Array* array_of(const SensorSpec& spec, const Record& record, std::string_view name, DType dtype) {
  for (size_t i = 0; i < spec.arrays.size() && i < record.arrays.size(); ++i)
    if (spec.arrays[i].name == name && record.arrays[i].dtype == dtype) return &record.arrays[i];
  return nullptr;
}

/// Returns the picture with at most `most` columns.
Array narrowed(const Array& rgb, int64_t most) {
  if (rgb.shape[1] <= most) return rgb;
  const auto height = static_cast<int>(std::max<int64_t>(1, rgb.shape[0] * most / rgb.shape[1]));
  io::Canvas canvas(static_cast<int>(most), height, io::theme::page);
  canvas.picture({0, 0, static_cast<int>(most), height}, rgb);
  return canvas.image();
}

Array events_picture(const SensorSpec& spec, const Record& record) {
  const Array *const x = array_of(spec, record, "x", DType::u16),
                     *const y = array_of(spec, record, "y", DType::u16),
                     *const p = array_of(spec, record, "p", DType::u8);
  const nlohmann::json metadata = nlohmann::json::parse(spec.metadata_json, nullptr, false);
  if (x == nullptr || y == nullptr || p == nullptr || !metadata.is_object()) return {};
  const int64_t width = metadata.value("width", int64_t{0}), height = metadata.value("height", int64_t{0});
  if (width <= 0 || height <= 0) return {};
  return io::event_picture(x->as<uint16_t>(), y->as<uint16_t>(), p->as<uint8_t>(), width, height);
}

/// Points from above, 100 m to each side, coloured by height.
Array lidar_picture(const Array& points) {
  constexpr int side = 480;
  constexpr double reach_m = 100.0, low_m = -20.0, high_m = 20.0;
  io::Canvas canvas(side, side, io::theme::page);
  const std::span<const float> values = points.as<float>();
  for (size_t i = 0; i + 3 < values.size(); i += 4) {
    const double x = static_cast<double>(values[i]), y = static_cast<double>(values[i + 1]),
                 z = static_cast<double>(values[i + 2]);
    const double height = std::clamp((z - low_m) / (high_m - low_m), 0.0, 1.0);
    canvas.blend(static_cast<int>(std::floor(0.5 * side * (1.0 - y / reach_m))),
                 static_cast<int>(std::floor(0.5 * side * (1.0 - x / reach_m))), io::turbo(height));
  }
  return canvas.image();
}

/// 60 dB below the strongest cell are dark.
Array radar_picture(const Array& map) {
  if (map.shape.size() != 2 || map.shape[0] < 1 || map.shape[1] < 1) return {};
  const std::span<const float> values = map.as<float>();
  const double most = std::max(1e-30, static_cast<double>(*std::ranges::max_element(values)));
  const auto rows = static_cast<int>(map.shape[0]), columns = static_cast<int>(map.shape[1]);
  const int scale = std::max(1, 384 / columns);
  io::Canvas canvas(columns * scale, rows * scale, io::theme::page);
  canvas.raster({0, 0, columns * scale, rows * scale}, columns, rows, [&](int x, int y) {
    const auto power = static_cast<double>(values[static_cast<size_t>((rows - 1 - y) * columns + x)]);
    return io::viridis(std::clamp(1.0 + 10.0 * std::log10(std::max(power, 1e-30) / most) / 60.0, 0.0, 1.0));
  });
  return canvas.image();
}

/// The path gain of the strongest transmitter, north up. The colours of all maps of a study are those of the
/// reference's range; cells with no path are grey, and cells without a value have the colour of the page.
Array map_picture(const SensorSpec& spec, const Array& gain) {
  const nlohmann::json metadata = nlohmann::json::parse(spec.metadata_json, nullptr, false);
  if (gain.shape.size() != 3 || gain.shape[0] < 1 || !metadata.is_object() || !metadata.contains("range_db"))
    return {};
  constexpr int longer_side = 512;
  constexpr io::Color no_path{110, 110, 110};
  const double low_db = metadata["range_db"][0], high_db = metadata["range_db"][1];
  const auto rows = static_cast<int>(gain.shape[1]), columns = static_cast<int>(gain.shape[2]);
  const int longer = std::max(rows, columns), width = std::max(1, longer_side * columns / longer),
            height = std::max(1, longer_side * rows / longer);
  const std::span<const double> values = gain.as<double>();
  const size_t cells = static_cast<size_t>(rows) * static_cast<size_t>(columns);
  io::Canvas canvas(width, height, io::theme::page);
  canvas.raster({0, 0, width, height}, columns, rows, [&](int x, int y) {
    const auto cell = static_cast<size_t>((rows - 1 - y) * columns + x);
    double strongest = values[cell];
    for (size_t i = cell; i < values.size(); i += cells) strongest = std::max(strongest, values[i]);
    if (std::isnan(strongest)) return io::theme::page;
    if (!(strongest > 0.0)) return no_path;
    const double db = 10.0 * std::log10(strongest);
    return io::viridis(std::clamp((db - low_db) / (high_db - low_db), 0.0, 1.0));
  });
  return canvas.image();
}

}  // namespace

std::string legend_of(const SensorSpec& spec) {
  const nlohmann::json metadata = nlohmann::json::parse(spec.metadata_json, nullptr, false);
  if (spec.kind != "map" || !metadata.is_object() || !metadata.contains("range_db")) return {};
  return fmt::format(
      "Path gain of the strongest transmitter, north up: {:.0f} dB and less are dark blue, {:.0f} dB and "
      "more "
      "are yellow. Grey: no path. Black: no value, because the middle of the cell is inside a solid or has "
      "no "
      "ground beneath.",
      metadata["range_db"][0].get<double>(), metadata["range_db"][1].get<double>());
}

Array picture_of(const SensorSpec& spec, const Record& record) {
  constexpr int64_t widest = 400;
  if (spec.kind == "camera") {
    const Array* const rgb = array_of(spec, record, "rgb", DType::u8);
    return rgb == nullptr ? Array() : narrowed(*rgb, widest);
  }
  if (spec.kind == "event_camera") {
    const Array picture = events_picture(spec, record);
    return picture.bytes.empty() ? Array() : narrowed(picture, widest);
  }
  if (spec.kind == "lidar") {
    const Array* const points = array_of(spec, record, "points", DType::f32);
    return points == nullptr ? Array() : lidar_picture(*points);
  }
  if (spec.kind == "map") {
    const Array* const gain = array_of(spec, record, "path_gain", DType::f64);
    return gain == nullptr ? Array() : map_picture(spec, *gain);
  }
  if (spec.kind == "radar") {
    const Array* const map = array_of(spec, record, "range_doppler", DType::f32);
    return map == nullptr ? Array() : radar_picture(*map);
  }
  return {};
}

}  // namespace greatx::apps
