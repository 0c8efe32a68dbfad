// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/picture_shapes.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "view/overlay/record_arrays.h"
#include "view/overlay/shape_parts.h"

namespace greatx::view {

namespace {

constexpr io::Color brighter_color{255, 70, 60}, darker_color{70, 130, 255};

const CameraFacts& camera_of(const RecordTables& tables, const SensorSpec& spec) {
  const SensorFacts& facts = tables.facts(spec);
  if (!facts.camera) throw_user_error("{}: expected the metadata of a camera", spec.name);
  return *facts.camera;
}

/// [boxes, 4] of either rectangle.
std::vector<double> rectangles_of(const RecordArrays& arrays, BoxRectangle rectangle, int64_t count) {
  if (rectangle == BoxRectangle::whole) {
    const std::span<const float> amodal = arrays.finite<float>("box_amodal", {count, 4});
    return {amodal.begin(), amodal.end()};
  }
  const std::span<const int32_t> modal = arrays.get<int32_t>("box_modal", {count, 4});
  return {modal.begin(), modal.end()};
}

}  // namespace

Shapes picture_box_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                          BoxRectangle rectangle) {
  Shapes shapes;
  const RecordArrays arrays(spec, record);
  if (!arrays.has("box_instance")) {
    shapes.note(spec.name + ": its boxes are not recorded: add 'boxes' to its outputs");
    return shapes;
  }
  shapes.picture_width = camera_of(tables, spec).width;
  const int64_t count = arrays.rows("box_instance");
  const std::span<const uint32_t> instance = arrays.get<uint32_t>("box_instance", {count});
  const std::span<const uint8_t> semantic = arrays.get<uint8_t>("box_semantic", {count});
  const std::span<const float> visibility = arrays.finite<float>("box_visibility", {count}),
                               truncation = arrays.finite<float>("box_truncation", {count});
  const std::vector<double> corners = rectangles_of(arrays, rectangle, count);
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    const dvec2 low(corners[4 * i], corners[4 * i + 1]), high(corners[4 * i + 2], corners[4 * i + 3]);
    if (!(high.x > low.x) || !(high.y > low.y)) continue;
    const uint32_t row = shapes.add_row(
        fmt::format(
            "{} ({})\n{:.0f} x {:.0f} pixels at ({:.0f}, {:.0f})\n{:.0f} % visible, {:.0f} % cut off by "
            "the picture",
            tables.instance_name(instance[i]), tables.class_name(semantic[i]), high.x - low.x, high.y - low.y,
            low.x, low.y, 100.0 * static_cast<double>(visibility[i]),
            100.0 * static_cast<double>(truncation[i])),
        row_id("picture box", instance[i]));
    shapes.picture.push_back(
        {low, high, semantic[i] == 0 ? dim_color : io::color_of_id(semantic[i]), false, row});
  }
  shapes.note(fmt::format("{}: {} boxes of {}, of {}", spec.name, shapes.picture.size(), count,
                          rectangle == BoxRectangle::whole ? "whole objects" : "visible pixels"));
  return shapes;
}

Shapes event_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                    const EventOptions& options) {
  Shapes shapes;
  const RecordArrays arrays(spec, record);
  if (!arrays.has("x") || !arrays.has("t")) {
    shapes.note(spec.name + ": its events are not recorded: add 'events' to its outputs");
    return shapes;
  }
  const CameraFacts& camera = camera_of(tables, spec);
  shapes.picture_width = camera.width;
  const int64_t count = arrays.rows("t");
  const std::span<const int64_t> t = arrays.get<int64_t>("t", {count});
  const std::span<const uint16_t> x = arrays.get<uint16_t>("x", {count}),
                                  y = arrays.get<uint16_t>("y", {count});
  const std::span<const uint8_t> p = arrays.get<uint8_t>("p", {count});
  const auto width = static_cast<size_t>(camera.width), height = static_cast<size_t>(camera.height);
  std::vector<bool> fired(width * height, false);
  const int64_t window_ns = options.window_s > 0.0 ? static_cast<int64_t>(1e9 * options.window_s) : 0;
  size_t pixels = 0;
  for (auto i = static_cast<size_t>(count); i-- > 0;) {  // the newest first
    if (window_ns > 0 && t[i] < record.time_ns - window_ns) break;
    if (x[i] >= width || y[i] >= height)
      arrays.fail("x", fmt::format("pixels of {} x {}", width, height),
                  fmt::format("({}, {}) in row {}", x[i], y[i], i));
    const size_t pixel = size_t{y[i]} * width + x[i];
    if (fired[pixel]) continue;
    fired[pixel] = true;
    if (++pixels > options.most) continue;
    shapes.picture.push_back({dvec2(x[i], y[i]), dvec2(x[i] + 1.0, y[i] + 1.0),
                              p[i] != 0 ? brighter_color : darker_color, true, no_row});
  }
  shapes.note(pixels > options.most
                  ? fmt::format("{}: the newest {} of {} pixels that fired", spec.name, options.most, pixels)
                  : fmt::format("{}: {} pixels fired, {} events", spec.name, pixels, count));
  shapes.legend.emplace_back("brighter", brighter_color);
  shapes.legend.emplace_back("darker", darker_color);
  return shapes;
}

}  // namespace greatx::view
