// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of channels that sense: maps of power, true targets and detections, by link.
#include <cmath>

#include "draw/report/parts.h"

namespace greatx::io::report {

namespace {

/// The arrays of a record, read once for all links. Those that the data set has not are empty.
struct Sensed {
  std::vector<std::pair<const char*, Array>> maps;    ///< by name, [rx, tx, rows, columns]
  std::vector<Array> truth;                           ///< [rx, tx, target]: range, velocity, azimuth, power
  std::optional<Array> range, velocity, azimuth;      ///< [detection]
  std::optional<Array> rx, tx, instance;              ///< [detection]
  std::optional<Array> elevation, snr, power, place;  ///< [detection], place [detection, 3]
};

Sensed load_sensed(const PanelSource& source, const IndexRow& row, size_t targets) {
  Sensed sensed;
  for (const char* const name : {"range_doppler", "range_azimuth"})
    if (source.has(name)) sensed.maps.emplace_back(name, source.load(row, name, {DType::f32}, {0, 0, 0, 0}));
  if (source.has("target_range") && targets > 0)
    for (const char* const name : {"target_range", "target_velocity", "target_azimuth", "target_power"})
      sensed.truth.push_back(source.load(row, name, {DType::f64}, {0, 0, static_cast<int64_t>(targets)}));
  if (!source.has("detection_range")) return sensed;
  const auto column = [&](const char* name, DType type, const std::vector<int64_t>& shape = {-1}) {
    std::optional<Array> array = source.load(row, name, {type}, shape);
    if (sensed.range) expect_same_rows(source, {&*sensed.range, &*array});
    return array;
  };
  sensed.range = column("detection_range", DType::f32);
  sensed.velocity = column("detection_velocity", DType::f32);
  sensed.azimuth = column("detection_azimuth", DType::f32);
  sensed.rx = column("detection_rx", DType::i32);
  sensed.tx = column("detection_tx", DType::i32);
  sensed.instance = column("detection_instance", DType::u32);
  if (source.has("detection_elevation")) sensed.elevation = column("detection_elevation", DType::f32);
  if (source.has("detection_snr")) sensed.snr = column("detection_snr", DType::f32);
  if (source.has("detection_power")) sensed.power = column("detection_power", DType::f32);
  if (source.has("detection_position")) sensed.place = column("detection_position", DType::f32, {-1, 3});
  return sensed;
}

/// Returns the place of a link in an array [rx, tx, ...]. Throws UserError if the array has it not.
size_t place_of(const PanelSource& source, const Array& array, const ChannelLink& link) {
  if (link.rx >= static_cast<size_t>(array.shape[0]) || link.tx >= static_cast<size_t>(array.shape[1]))
    throw_user_error("{}: expected links of all receivers and transmitters, found {} x {}", source.place(),
                     array.shape[0], array.shape[1]);
  return link.rx * static_cast<size_t>(array.shape[1]) + link.tx;
}

Json encode_targets(const PanelSource& source, const Sensed& sensed, const ChannelLink& link,
                    size_t targets) {
  constexpr int digits[] = {3, 3, 5, 2};
  std::vector<std::span<const double>> columns;
  for (const Array& array : sensed.truth)
    columns.push_back(array.as<double>().subspan(place_of(source, array, link) * targets, targets));
  Json list = Json::array();
  for (size_t i = 0; i < targets; ++i) {
    Json target = Json::array();
    for (size_t c = 0; c < columns.size(); ++c) target.push_back(rounded(columns[c][i], digits[c]));
    list.push_back(std::move(target));
  }
  return list;
}

/// Returns the detections of a link as those of a radar (radar_part.cpp).
Json encode_detections_of(const Context& context, const PanelSource& source, const Sensed& sensed,
                          const ChannelLink& link) {
  const auto one = [](const std::optional<Array>& array, size_t i, int digits) {
    return array ? rounded(array->as<float>()[i], digits) : Json(nullptr);
  };
  Json list = Json::array();
  size_t all = 0;
  for (size_t i = 0; i < sensed.range->as<float>().size(); ++i) {
    if (sensed.rx->as<int32_t>()[i] != static_cast<int32_t>(link.rx) ||
        sensed.tx->as<int32_t>()[i] != static_cast<int32_t>(link.tx) || ++all > most_detections)
      continue;
    const uint32_t id = sensed.instance->as<uint32_t>()[i];
    context.collected.instances.insert(id);
    list.push_back({one(sensed.place, 3 * i, 3), one(sensed.place, 3 * i + 1, 3),
                    one(sensed.place, 3 * i + 2, 3), one(sensed.range, i, 3), one(sensed.velocity, i, 3),
                    one(sensed.azimuth, i, 5), one(sensed.elevation, i, 5), one(sensed.snr, i, 2),
                    one(sensed.power, i, 2), nullptr, id});
  }
  if (all > most_detections)
    context.collected.notes.insert(fmt::format("{}: the first {} detections of each link and record.",
                                               printable(source.spec().name), most_detections));
  return {{"blob", context.blobs.add(packed_text(list.dump()))}, {"all", all}};
}

}  // namespace

Json encode_sensing(const Context& context, const PanelSource& source, const IndexRow& row, size_t targets,
                    const std::vector<ChannelLink>& links) {
  const Sensed sensed = load_sensed(source, row, targets);
  Json list = Json::array();
  for (const ChannelLink& link : links) {
    Json json = {{"rx", link.rx}, {"tx", link.tx}};
    for (const auto& [name, map] : sensed.maps) {
      const auto cells = static_cast<size_t>(map.shape[2] * map.shape[3]);
      json[name] = encode_power(context, map.as<float>().subspan(place_of(source, map, link) * cells, cells),
                                map.shape[2], map.shape[3]);
    }
    if (!sensed.truth.empty()) json["targets"] = encode_targets(source, sensed, link, targets);
    if (sensed.range) json["detections"] = encode_detections_of(context, source, sensed, link);
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace greatx::io::report
