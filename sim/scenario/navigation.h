// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the sensors of a scenario that navigate: inertial sensors, GNSS receivers, barometers and
// magnetometers (docs/navigation.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/navigation/atmosphere.h"
#include "sim/navigation/gnss.h"
#include "sim/navigation/presets.h"

namespace greatx::sim {

struct ImuConfig {
  std::string device = "bmi088";  ///< from whose errors the others below begin
  navigation::TriadErrors accelerometer, gyroscope;
  uint32_t samples_per_record = 1;  ///< evenly spaced since the record before
  bool mean = false;                ///< means over the time since the sample before, not instants
  bool earth_rotation = false;      ///< whether the sensor feels the Earth's rotation
};

struct GnssConfig {
  navigation::GnssReceiver receiver;
  bool reflections = true;       ///< hidden satellites are tracked where a wall shows them
  std::string time;              ///< of tick 0, RFC 3339; empty: that of the environment
  std::optional<double> unix_s;  ///< the same instant
};

struct BarometerConfig {
  navigation::BarometerErrors errors;
  double sea_level_pa = navigation::standard_pressure_pa;
};

struct MagnetometerConfig {
  double noise_t = 0.3e-6;       ///< standard deviation of a sample, T
  double hard_iron_t = 10e-6;    ///< constant bias, standard deviation
  double soft_iron = 0.03;       ///< standard deviation of each element of the matrix less 1
  double drift_t = 0.0;          ///< of a Gauss-Markov process of the bias
  double drift_time_s = 1000.0;  ///< its correlation time
  double resolution_t = 0.3e-6;
  double range_t = 1300e-6;  ///< 0: none
};

}  // namespace greatx::sim
