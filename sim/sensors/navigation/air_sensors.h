// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Barometers and magnetometers.
#pragma once

#include <optional>

#include "sim/navigation/atmosphere.h"
#include "sim/navigation/triad.h"
#include "sim/sensors/navigation/earth_place.h"
#include "sim/sensors/navigation/host_sensor.h"

namespace greatx::sim {

/// Measures the air's pressure at its height above the sea: the world's z, unless the scene has a place on
/// the Earth.
class BarometerSensor : public HostSensor {
 public:
  BarometerSensor(const Experiment& experiment, uint32_t node, uint32_t sensor);

 protected:
  void begin(uint32_t sequence) override;
  std::vector<Array> measure(const TickContext& context) override;

 private:
  BarometerConfig barometer_config_;
  std::optional<EarthPlace> place_;
  std::optional<navigation::Barometer> barometer_;
};

/// Measures the Earth's magnetic field in its axes.
class MagnetometerSensor : public HostSensor {
 public:
  MagnetometerSensor(const Experiment& experiment, uint32_t node, uint32_t sensor);

 protected:
  void begin(uint32_t sequence) override;
  std::vector<Array> measure(const TickContext& context) override;

 private:
  MagnetometerConfig magnetometer_config_;
  EarthPlace place_;
  double year_;
  std::optional<navigation::Triad> triad_;
};

}  // namespace greatx::sim
