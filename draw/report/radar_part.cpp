// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of radars: maps of power and detections.
#include <algorithm>
#include <cmath>

#include "draw/report/parts.h"

namespace greatx::io::report {

namespace {

constexpr double no_power_dbm = -400.0;

double level_at(std::vector<double> levels, double share) {
  const auto at = levels.begin() + static_cast<std::ptrdiff_t>(share * double(levels.size() - 1));
  std::nth_element(levels.begin(), at, levels.end());
  return *at;
}

/// Returns [x, y, z, range, velocity, azimuth, elevation, snr, power, rcs, instance] of each detection, the
/// strongest first; null where a value is not known.
Json encode_detections(const Context& context, const PanelSource& source, const IndexRow& row) {
  const Array places = source.load(row, "detections", {DType::f32}, {-1, 4});
  const auto count = static_cast<size_t>(places.shape[0]);
  std::vector<std::pair<const char*, Array>> columns;
  for (const char* const name : {"range", "velocity", "azimuth", "elevation", "snr", "power"})
    if (source.has(name)) {
      columns.emplace_back(name, source.load(row, name, {DType::f32}, {-1}));
      expect_same_rows(source, {&places, &columns.back().second});
    }
  const auto value = [&](std::string_view name, size_t i) -> Json {
    for (const auto& [column, array] : columns)
      if (name == column) return rounded(array.as<float>()[i], 4);
    return nullptr;
  };
  std::optional<Array> instance;
  if (source.has("instance")) {
    instance = source.load(row, "instance", {DType::u32}, {-1});
    expect_same_rows(source, {&places, &*instance});
  }
  std::vector<size_t> order(count);
  for (size_t i = 0; i < count; ++i) order[i] = i;
  if (source.has("power"))
    std::ranges::stable_sort(order, [&](size_t a, size_t b) {
      const std::span<const float> power = columns.back().second.as<float>();
      const auto order_of = [&](size_t i) { return std::isfinite(power[i]) ? power[i] : -1e30f; };
      return order_of(a) > order_of(b);
    });
  if (count > most_detections) {
    order.resize(most_detections);
    context.collected.notes.insert(fmt::format("{}: the {} strongest detections of each record.",
                                               printable(source.spec().name), most_detections));
  }
  Json list = Json::array();
  for (const size_t i : order) {
    const float* const at = places.as<float>().data() + 4 * i;
    const uint32_t id = instance ? instance->as<uint32_t>()[i] : 0;
    context.collected.instances.insert(id);
    list.push_back({rounded(at[0], 3), rounded(at[1], 3), rounded(at[2], 3), value("range", i),
                    value("velocity", i), value("azimuth", i), value("elevation", i), value("snr", i),
                    value("power", i), rounded(at[3], 2), id});
  }
  return {{"blob", context.blobs.add(packed_text(list.dump()))}, {"all", count}};
}

}  // namespace

Json encode_power(const Context& context, std::span<const float> watts, int64_t rows, int64_t columns) {
  // Blocks grow along the longer side until few enough are left.
  int64_t by_row = 1, by_column = 1;
  const auto blocks = [](int64_t all, int64_t by) { return (all + by - 1) / by; };
  while (static_cast<size_t>(blocks(rows, by_row) * blocks(columns, by_column)) > context.detail.map_cells)
    ++(blocks(rows, by_row) >= blocks(columns, by_column) ? by_row : by_column);
  const int64_t h = blocks(rows, by_row), w = blocks(columns, by_column);
  std::vector<double> levels(static_cast<size_t>(h * w), no_power_dbm);
  for (int64_t y = 0; y < rows; ++y)
    for (int64_t x = 0; x < columns; ++x) {
      const double watt = watts[static_cast<size_t>(y * columns + x)];
      double& level = levels[static_cast<size_t>(y / by_row * w + x / by_column)];
      if (watt > 0.0 && std::isfinite(watt)) level = std::max(level, 10.0 * std::log10(watt) + 30.0);
    }
  if (by_row * by_column > 1)
    context.collected.notes.insert(
        fmt::format("A cell of a map of {} x {} cells is shown as the strongest of {} x {}.", rows, columns,
                    by_row, by_column));
  const double middle = level_at(levels, 0.5), top = *std::ranges::max_element(levels);
  const double low = std::max(std::min(middle - 10.0, top - 1.0), top - 120.0),
               step = std::max(top - low, 1.0) / 254.0;
  std::vector<uint32_t> codes;
  codes.reserve(levels.size());
  for (const double level : levels)
    codes.push_back(static_cast<uint32_t>(std::clamp(std::round((level - low) / step), 0.0, 255.0)));
  return {{"blob", context.blobs.add(packed(codes, 1, 0))},
          {"h", h},
          {"w", w},
          {"rows", rows},
          {"columns", columns},
          {"by", {by_row, by_column}},
          {"low", low},
          {"step", step},
          {"floor", rounded(middle, 2)},
          {"top", rounded(level_at(levels, 0.999), 2)}};
}

Json describe_radar(const PanelSource& source) {
  const JsonDocument metadata = metadata_of(source);
  Json json = Json::object();
  for (const char* const key :
       {"range_bin_m", "velocity_min_m_s", "velocity_bin_m_s", "azimuth_min_rad", "azimuth_max_rad"})
    if (metadata.root().has(key)) json[key] = metadata.root().at(key).number(-1e9, 1e9);
  return json;
}

Json encode_radar(const Context& context, const PanelSource& source, const IndexRow& row) {
  Json json = {{"pose", pose_json(context, context.poses.world_from(node_of(source.spec()), mount_of(source),
                                                                    row.tick))}};
  for (const char* const name : {"range_doppler", "range_azimuth"})
    if (source.has(name)) {
      const Array map = source.load(row, name, {DType::f32}, {0, 0});
      json[name] = encode_power(context, map.as<float>(), map.shape[0], map.shape[1]);
    }
  if (source.has("detections")) json["detections"] = encode_detections(context, source, row);
  return json;
}

}  // namespace greatx::io::report
