// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/sensor_kinds.h"

#include <algorithm>

#include <fmt/format.h>

namespace greatx::sim {

// The rows are in the order of the alternatives, and none is missing.
static_assert(std::ranges::none_of(sensor_kinds, [](const SensorKind& kind) { return kind.type.empty(); }));
static_assert(sensor_kind_index<CameraConfig>() == 0 && sensor_kinds[0].type == "camera");
static_assert(sensor_kind_index<EventCameraConfig>() == 1 && sensor_kinds[1].type == "event_camera");
static_assert(sensor_kind_index<LidarConfig>() == 2 && sensor_kinds[2].type == "lidar");
static_assert(sensor_kind_index<RadarConfig>() == 3 && sensor_kinds[3].type == "radar");
static_assert(sensor_kind_index<AntennaConfig>() == 4 && sensor_kinds[4].type == "antenna");
static_assert(sensor_kind_index<ImuConfig>() == 5 && sensor_kinds[5].type == "imu");
static_assert(sensor_kind_index<GnssConfig>() == 6 && sensor_kinds[6].type == "gnss");
static_assert(sensor_kind_index<BarometerConfig>() == 7 && sensor_kinds[7].type == "barometer");
static_assert(sensor_kind_index<MagnetometerConfig>() == 8 && sensor_kinds[8].type == "magnetometer");

std::string with_article(const SensorKind& kind) {
  constexpr std::string_view vowels = "aeiou";
  return fmt::format("{} {}", vowels.find(kind.words.front()) == vowels.npos ? "a" : "an", kind.words);
}

}  // namespace greatx::sim
