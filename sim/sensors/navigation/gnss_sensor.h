// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>

#include "sim/sensors/navigation/earth_place.h"
#include "sim/sensors/navigation/host_sensor.h"
#include "sim/sensors/navigation/sky_view.h"

namespace greatx::sim {

/// Measures position and velocity by ranges to satellites (docs/navigation.md).
class GnssSensor : public HostSensor {
 public:
  GnssSensor(const Experiment& experiment, uint32_t node, uint32_t sensor);
  void count(std::map<std::string, uint64_t>& counts) const override;

 protected:
  void begin(uint32_t sequence) override;
  std::vector<Array> measure(const TickContext& context) override;

 private:
  void declare_arrays();

  GnssConfig gnss_config_;
  EarthPlace place_;
  double unix_s_;
  SkyView view_;
  std::optional<navigation::Gnss> gnss_;
  uint64_t records_ = 0, fixes_ = 0, direct_ = 0, reflected_ = 0, blocked_ = 0;
};

}  // namespace greatx::sim
