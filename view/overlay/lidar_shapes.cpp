// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "view/overlay/record_arrays.h"
#include "view/overlay/sensing_shapes.h"
#include "view/overlay/shape_parts.h"

namespace greatx::view {

namespace {

io::Color cloud_color(double share) { return io::turbo(0.08 + 0.84 * std::clamp(share, 0.0, 1.0)); }

/// Between which values most of them lie: without 2 % at either end.
std::pair<double, double> span_of(std::vector<float> values) {
  if (values.empty()) return {0.0, 1.0};
  const auto at = [&](double share) {
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return static_cast<double>(*place);
  };
  const double low = at(0.02), high = at(0.98);
  return {low, std::max(high, low + 1e-6)};
}

/// World_from_sensor by the time after the tick. Shots come in the order of their times, so that one pose is
/// kept.
class ShotPoses {
 public:
  ShotPoses(const NodePoses& poses, const Place& place) : poses_(poses), place_(place) {}
  const Pose& at(double offset_s) {
    if (!known_ || offset_s != offset_s_) {
      pose_ = *poses_.world_from(place_, offset_s);
      offset_s_ = offset_s;
      known_ = true;
    }
    return pose_;
  }

 private:
  const NodePoses& poses_;
  const Place& place_;
  Pose pose_;
  double offset_s_ = 0.0;
  bool known_ = false;
};

/// Points of the world, every `stride`-th.
std::vector<dvec3> placed_points(const RecordArrays& record, const RecordTables& tables, const Place& place,
                                 const NodePoses& poses, size_t stride) {
  const std::span<const float> xyzi = record.finite<float>("points", {-1, 4});
  const auto count = static_cast<int64_t>(xyzi.size() / 4);
  std::span<const float> offsets;
  if (tables.sweep_motion() && record.has("time_offset"))
    offsets = record.finite<float>("time_offset", {count});
  ShotPoses at(poses, place);
  std::vector<dvec3> points;
  points.reserve(xyzi.size() / 4 / stride + 1);
  for (size_t i = 0; i < static_cast<size_t>(count); i += stride)
    points.push_back(at.at(offsets.empty() ? 0.0 : static_cast<double>(offsets[i]))
                         .apply({xyzi[4 * i], xyzi[4 * i + 1], xyzi[4 * i + 2]}));
  return points;
}

void add_scale(Shapes& shapes, double low, double high, const char* format_unit, int digits) {
  for (const double share : {1.0, 0.5, 0.0}) {
    const double unit = std::pow(10.0, -digits), value = low + share * (high - low);
    // Without "-0.0".
    shapes.legend.emplace_back(
        fmt::format("{:.{}f}{}", std::round(value / unit) * unit + 0.0, digits, format_unit),
        cloud_color(share));
  }
}

/// The objects with most returns: more names would hide the picture.
void add_object_legend(Shapes& shapes, const RecordTables& tables, std::span<const uint32_t> ids) {
  constexpr size_t most_objects = 8;
  std::unordered_map<uint32_t, size_t> counts;
  for (const uint32_t id : ids) ++counts[id];
  std::vector<std::pair<size_t, uint32_t>> order;
  for (const auto& [id, count] : counts) order.emplace_back(count, id);
  std::ranges::sort(order, [](const auto& a, const auto& b) {
    return a.first > b.first || (a.first == b.first && a.second < b.second);
  });
  for (size_t i = 0; i < std::min(order.size(), most_objects); ++i)
    shapes.legend.emplace_back(
        fmt::format("{} ({} returns)",
                    order[i].second == 0 ? std::string("fog or rain") : tables.instance_name(order[i].second),
                    order[i].first),
        io::color_of_id(order[i].second));
  if (order.size() > most_objects) shapes.note(fmt::format("{} more objects", order.size() - most_objects));
}

/// What each point shown is coloured by, and the legend of it.
std::vector<io::Color> point_colors(Shapes& shapes, const RecordArrays& record, const RecordTables& tables,
                                    LidarColors by, const std::vector<dvec3>& points, size_t stride,
                                    int64_t count) {
  std::vector<io::Color> colors;
  colors.reserve(points.size());
  if (by == LidarColors::instance) {
    const std::span<const uint32_t> ids = record.get<uint32_t>("instance", {count});
    for (size_t i = 0; i < ids.size(); i += stride) colors.push_back(io::color_of_id(ids[i]));
    add_object_legend(shapes, tables, ids);
    return colors;
  }
  std::vector<float> values;
  values.reserve(points.size());
  if (by == LidarColors::height) {
    for (const dvec3& point : points) values.push_back(static_cast<float>(point.z));
  } else if (by == LidarColors::intensity) {
    const std::span<const float> xyzi = record.get<float>("points", {count, 4});
    for (size_t i = 0; i < static_cast<size_t>(count); i += stride) values.push_back(xyzi[4 * i + 3]);
  } else {
    const std::span<const uint16_t> rings = record.get<uint16_t>("ring", {count});
    for (size_t i = 0; i < rings.size(); i += stride) values.push_back(rings[i]);
  }
  auto [low, high] = span_of(values);
  if (by == LidarColors::ring && !values.empty()) {
    const auto [first, last] = std::ranges::minmax(values);
    low = first;
    high = std::max(first + 1.0f, last);
  }
  for (const float value : values) colors.push_back(cloud_color((value - low) / (high - low)));
  if (values.empty()) return colors;
  if (by == LidarColors::height) add_scale(shapes, low, high, " m height", 1);
  if (by == LidarColors::intensity) add_scale(shapes, low, high, " intensity", 3);
  if (by == LidarColors::ring) {
    shapes.legend.emplace_back(fmt::format("ring {}", high), cloud_color(1.0));
    shapes.legend.emplace_back(fmt::format("ring {}", low), cloud_color(0.0));
  }
  return colors;
}

/// A row for each object; the row of each point shown.
std::vector<uint32_t> object_rows(Shapes& shapes, const RecordArrays& record, const RecordTables& tables,
                                  const std::string& sensor, size_t stride, int64_t count) {
  if (!record.has("instance")) return {};
  const std::span<const uint32_t> ids = record.get<uint32_t>("instance", {count});
  std::unordered_map<uint32_t, size_t> returns;
  for (const uint32_t id : ids) ++returns[id];
  std::unordered_map<uint32_t, uint32_t> rows;
  std::vector<uint32_t> of_points;
  of_points.reserve(ids.size() / stride + 1);
  for (size_t i = 0; i < ids.size(); i += stride) {
    const auto [row, added] = rows.try_emplace(ids[i], 0);
    if (added) {
      std::string text = ids[i] == 0 ? "fog or rain" : tables.instance_name(ids[i]);
      if (ids[i] > 0 && ids[i] <= tables.instances().size())
        text += fmt::format(" ({})", tables.instances()[ids[i] - 1].semantic_class);
      row->second = shapes.add_row(fmt::format("{}\n{}: {} returns", text, sensor, returns[ids[i]]),
                                   row_id(sensor + " returns", ids[i]));
    }
    of_points.push_back(row->second);
  }
  return of_points;
}

}  // namespace

Shapes lidar_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                    const NodePoses* poses, const LidarOptions& options) {
  GREATX_CHECK(options.most > 0, "{} points", options.most);
  Shapes shapes;
  const RecordArrays arrays(spec, record);
  const char* const needed = options.colors == LidarColors::ring       ? "ring"
                             : options.colors == LidarColors::instance ? "instance"
                                                                       : nullptr;
  if (!arrays.has("points")) {
    shapes.note(spec.name + ": its points are not recorded: add 'points' to its outputs");
    return shapes;
  }
  if (needed != nullptr && !arrays.has(needed)) {
    shapes.note(
        fmt::format("{}: '{}' is not recorded: add 'ply' or 'pcd' to its outputs", spec.name, needed));
    return shapes;
  }
  const Place& place = tables.facts(spec).place;
  const NodePoses* const known = poses_for(shapes, spec, record, poses);
  if (known == nullptr) return shapes;
  if (!place.known) {
    shapes.note(spec.name + ": the poses have no such node, so it cannot be placed");
    return shapes;
  }
  const int64_t count = arrays.rows("points");
  const auto total = static_cast<size_t>(std::max<int64_t>(count, 0));
  const size_t stride = std::max<size_t>(1, (total + options.most - 1) / options.most);
  const std::vector<dvec3> points = placed_points(arrays, tables, place, *known, stride);
  shapes.note(stride == 1
                  ? fmt::format("{}: {} points", spec.name, total)
                  : fmt::format("{}: {} of {} points, one in {}", spec.name, points.size(), total, stride));
  const std::vector<io::Color> colors =
      point_colors(shapes, arrays, tables, options.colors, points, stride, count);
  const std::vector<uint32_t> rows = object_rows(shapes, arrays, tables, spec.name, stride, count);
  shapes.points.reserve(points.size());
  for (size_t i = 0; i < points.size(); ++i)
    shapes.points.push_back(
        {points[i], colors[i], options.size_px, PointShape::Mark::dot, rows.empty() ? no_row : rows[i]});
  return shapes;
}

}  // namespace greatx::view
