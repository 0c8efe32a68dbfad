// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/navigation/host_sensor.h"

#include "sim/navigation/inertial.h"
#include "sim/sensors/sensor_metadata.h"

namespace greatx::sim {

HostSensor::HostSensor(const Experiment& experiment, uint32_t node, uint32_t sensor, const char* kind)
    : experiment_(experiment),
      node_(node),
      sensor_(sensor),
      mount_(mount_pose(experiment.scenario.nodes[node].sensors[sensor].mount)),
      period_s_(1.0 / experiment.scenario.nodes[node].sensors[sensor].rate_hz.value()),
      clock_(experiment.scenario.tick_rate_hz),
      times_(experiment.scenario.tick_rate_hz, experiment.scenario.nodes[node].sensors[sensor].rate_hz) {
  spec_.name = experiment.scenario.nodes[node].name + "/" + config().name;
  spec_.kind = kind;
  spec_.rate = config().rate_hz.str();
}

void HostSensor::declare(const char* name, DType dtype, std::vector<int64_t> shape, const char* unit,
                         const std::string& description) {
  const bool ragged = !shape.empty() && shape.front() == -1;
  spec_.arrays.push_back({name, dtype, std::move(shape), unit, description});
  spec_.outputs.push_back({name, ragged ? FileFormat::npy_ragged : FileFormat::npy_stack, {name}});
}

void HostSensor::describe(nlohmann::json metadata) {
  metadata["body_from_sensor"] = json_of(mount_);
  spec_.metadata_json = metadata.dump();
}

Motion HostSensor::mounted_motion(const TickContext& context) const {
  return navigation::mounted(context.nodes[node_], dvec3(0.0), mount_);
}

Array array_of_rows(const std::vector<dvec3>& rows) {
  Array array(DType::f64, {static_cast<int64_t>(rows.size()), 3});
  double* value = array.as<double>().data();
  for (const dvec3& row : rows)
    for (int i = 0; i < 3; ++i) *value++ = row[i];
  return array;
}

Array array_of_vector(const dvec3& vector) {
  return Array::of<double>({3}, std::span<const double>(&vector.x, 3));
}

Array array_of_number(double value) { return Array::of<double>({1}, std::span<const double>(&value, 1)); }

}  // namespace greatx::sim
