// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "sim/navigation/inertial.h"
#include "sim/sensors/navigation/host_sensor.h"

namespace greatx::sim {

/// Measures specific force and angular rate (docs/navigation.md). A record holds the samples since the record
/// before, the last one at its own time.
class ImuSensor : public HostSensor {
 public:
  ImuSensor(const Experiment& experiment, uint32_t node, uint32_t sensor);

 protected:
  void begin(uint32_t sequence) override;
  std::vector<Array> measure(const TickContext& context) override;

 private:
  /// The instants of a record: seconds and nanoseconds, and the number of the first one in the sequence.
  struct Instants {
    std::vector<double> times_s;
    std::vector<int64_t> times_ns;
    int64_t first = 0;
    double step_s = 0.0;
  };
  Instants instants(const TickContext& context) const;
  Motion motion_at(const TickContext& context, double time_s) const;
  navigation::Inertial truth(const TickContext& context, double time_s, double step_s, bool first) const;

  ImuConfig imu_;
  navigation::InertialFrame frame_;
  std::optional<navigation::Triad> accelerometer_, gyroscope_;
};

}  // namespace greatx::sim
