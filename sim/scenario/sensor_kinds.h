// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the kinds of sensors that a node can carry. Every other table of kinds (those of the parser, of the
// registry in sim/sensors/registry, and of the panels in draw/sheet) is checked against this one.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Holds the settings of one kind of sensor.
using SensorSettings = decltype(SensorConfig::config);
inline constexpr size_t sensor_kind_count = std::variant_size_v<SensorSettings>;

/// Describes a row of the table: the names of a kind.
struct SensorKind {
  std::string_view type;   ///< `type` in a scenario, SensorSpec::kind in a data set
  std::string_view words;  ///< the name in a sentence, without an article
  /// Whether the kind delivers records at a rate of its own. An antenna does not; channels and radars use it.
  bool fires;
};

/// The index is that of SensorConfig::config.
inline constexpr std::array<SensorKind, sensor_kind_count> sensor_kinds{
    {{"camera", "camera", true},
     {"event_camera", "event camera", true},
     {"lidar", "LiDAR", true},
     {"radar", "radar", true},
     {"antenna", "antenna", false},
     {"imu", "inertial sensor", true},
     {"gnss", "GNSS receiver", true},
     {"barometer", "barometer", true},
     {"magnetometer", "magnetometer", true}}};

/// Returns the row of the table for the settings of type `Config`.
template <typename Config>
constexpr size_t sensor_kind_index() {
  return []<typename... All>(const std::variant<All...>*) {
    static_assert((std::is_same_v<Config, All> || ...));
    size_t index = 0;
    const auto found = [&](bool same) { return same || (++index, false); };
    static_cast<void>((found(std::is_same_v<Config, All>) || ...));
    return index;
  }(static_cast<const SensorSettings*>(nullptr));
}

inline const SensorKind& sensor_kind(const SensorConfig& sensor) {
  return sensor_kinds[sensor.config.index()];
}

/// Returns the name with its article: "a camera", "an event camera".
std::string with_article(const SensorKind& kind);

}  // namespace greatx::sim
