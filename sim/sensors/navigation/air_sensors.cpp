// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/navigation/air_sensors.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "sim/navigation/magnetic_field.h"

namespace greatx::sim {

namespace {

/// The year of the field if the scenario has no time.
constexpr double usual_field_year = 2025.0;

navigation::TriadErrors triad_errors(const MagnetometerConfig& config, double step_s) {
  return {.noise_density = config.noise_t * std::sqrt(step_s),
          .bias_std = config.hard_iron_t,
          .bias_instability = config.drift_t * navigation::most_gauss_markov_allan,
          .bias_time_s = config.drift_time_s,
          .bias_walk = 0.0,
          .scale_std = config.soft_iron,
          .misalignment_std = config.soft_iron,
          .resolution = config.resolution_t,
          .range = config.range_t};
}

}  // namespace

BarometerSensor::BarometerSensor(const Experiment& experiment, uint32_t node, uint32_t sensor)
    : HostSensor(experiment, node, sensor, "barometer"),
      barometer_config_(std::get<BarometerConfig>(config().config)),
      place_(earth_place(experiment)) {
  declare("pressure", DType::f64, {1}, "Pa", "measured pressure");
  declare("height", DType::f64, {1}, "m", "height of the standard atmosphere with the measured pressure");
  declare("pressure_true", DType::f64, {1}, "Pa", "pressure without errors");
  declare("height_true", DType::f64, {1}, "m", "height of the sensor above the sea");
  declare("bias", DType::f64, {1}, "Pa", "sum of the biases of the pressure");
  const navigation::BarometerErrors& e = barometer_config_.errors;
  describe({{"sea_level_pa", barometer_config_.sea_level_pa},
            {"noise_pa", e.noise_std},
            {"bias_pa", e.bias_std},
            {"drift_pa", e.drift_std},
            {"drift_time_s", e.drift_time_s},
            {"resolution_pa", e.resolution}});
}

void BarometerSensor::begin(uint32_t sequence) {
  barometer_.emplace(barometer_config_.errors, experiment_.scenario.seed, spec_.name, sequence, period_s_);
}

std::vector<Array> BarometerSensor::measure(const TickContext& context) {
  const dvec3 position = mounted_motion(context).pose.position;
  const double height_m = place_ ? place_->frame.datum_place(position).height_m : position.z;
  const double sea_pa = barometer_config_.sea_level_pa, truth_pa = navigation::air_pressure(height_m, sea_pa);
  const navigation::Barometer::Sample sample = barometer_->measure(truth_pa, sample_at(context.tick));
  std::vector<Array> arrays;
  const double shown_m = navigation::pressure_height(std::max(sample.measured_pa, 1.0), sea_pa);
  for (const double value : {sample.measured_pa, shown_m, truth_pa, height_m, sample.bias_pa})
    arrays.push_back(array_of_number(value));
  return arrays;
}

MagnetometerSensor::MagnetometerSensor(const Experiment& experiment, uint32_t node, uint32_t sensor)
    : HostSensor(experiment, node, sensor, "magnetometer"),
      magnetometer_config_(std::get<MagnetometerConfig>(config().config)),
      place_(require_earth_place(experiment, "a magnetometer")),
      year_(place_.unix_s ? navigation::year_of(*place_.unix_s) : usual_field_year) {
  declare("field", DType::f64, {3}, "T", "[xyz] measured magnetic flux density, sensor axes");
  declare("field_true", DType::f64, {3}, "T", "[xyz] of the Earth, without errors, sensor axes");
  declare("bias", DType::f64, {3}, "T", "[xyz] sum of the biases");
  const MagnetometerConfig& c = magnetometer_config_;
  describe({{"year", year_},
            {"noise_ut", 1e6 * c.noise_t},
            {"hard_iron_ut", 1e6 * c.hard_iron_t},
            {"soft_iron", c.soft_iron},
            {"drift_ut", 1e6 * c.drift_t},
            {"drift_time_s", c.drift_time_s},
            {"resolution_ut", 1e6 * c.resolution_t},
            {"range_ut", 1e6 * c.range_t}});
}

void MagnetometerSensor::begin(uint32_t sequence) {
  triad_.emplace(triad_errors(magnetometer_config_, period_s_), experiment_.scenario.seed, spec_.name,
                 sequence, period_s_);
}

std::vector<Array> MagnetometerSensor::measure(const TickContext& context) {
  const Pose pose = mounted_motion(context).pose;
  const dvec3 field = navigation::magnetic_field(place_.frame.place(pose.position), year_);
  const dvec3 truth = glm::conjugate(pose.orientation) * field;
  const navigation::TriadSample sample = triad_->measure(truth, sample_at(context.tick));
  std::vector<Array> arrays;
  for (const dvec3& vector : {sample.measured, truth, sample.bias}) arrays.push_back(array_of_vector(vector));
  return arrays;
}

}  // namespace greatx::sim
