// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds what the sensors that navigate have in common: they measure on the host, and record nothing on the
// device.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sim/experiment/experiment.h"
#include "sim/scenario/clock.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

/// A sensor of a node that follows from poses alone. Its noise depends on (seed, name, sequence, sample), and
/// processes with memory go on from sample 0 by themselves, so that it need not remember earlier records.
class HostSensor : public Sensor {
 public:
  const SensorSpec& spec() const override { return spec_; }
  void start(const TickContext& context) override { begin(context.sequence); }
  void record(gpu::TickSlot& slot, const TickContext& context) override {
    arrays_[slot.index] = measure(context);
  }
  std::vector<Array> collect(const gpu::TickSlot& slot) override { return std::move(arrays_[slot.index]); }

 protected:
  /// `kind` is that of the spec. `experiment` outlives this.
  HostSensor(const Experiment& experiment, uint32_t node, uint32_t sensor, const char* kind);
  /// Makes the noise of a sequence.
  virtual void begin(uint32_t sequence) = 0;
  virtual std::vector<Array> measure(const TickContext& context) = 0;

  const SensorConfig& config() const { return experiment_.scenario.nodes[node_].sensors[sensor_]; }
  /// Declares an array that is a file of its own.
  void declare(const char* name, DType dtype, std::vector<int64_t> shape, const char* unit,
               const std::string& description);
  /// Adds the mount to the metadata, and keeps them.
  void describe(nlohmann::json metadata);
  /// Returns the number of the record at `tick`, at which the sensor is due.
  int64_t sample_at(int64_t tick) const { return times_.sample_at(tick); }
  /// Returns the motion of the sensor's place, without its angular acceleration's share.
  Motion mounted_motion(const TickContext& context) const;

  const Experiment& experiment_;
  uint32_t node_, sensor_;
  Pose mount_;
  double period_s_;  ///< between records
  Clock clock_;
  SampleTimes times_;
  SensorSpec spec_;

 private:
  std::array<std::vector<Array>, slots_in_flight> arrays_;
};

/// Returns an array f64 [rows, 3] of vectors, or [3] of one.
Array array_of_rows(const std::vector<dvec3>& rows);
Array array_of_vector(const dvec3& vector);
/// Returns an array f64 [1].
Array array_of_number(double value);

}  // namespace greatx::sim
