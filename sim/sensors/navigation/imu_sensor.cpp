// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/navigation/imu_sensor.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/units.h"
#include "sim/sensors/navigation/earth_place.h"

namespace greatx::sim {

namespace {

/// The half of the interval over which angular acceleration is a difference, at most.
constexpr double most_half_interval_s = 5e-3;

nlohmann::json json_of_triad(const navigation::TriadErrors& e) {
  return {{"noise_density", e.noise_density},
          {"bias_std", e.bias_std},
          {"bias_instability", e.bias_instability},
          {"bias_time_s", e.bias_time_s},
          {"bias_walk", e.bias_walk},
          {"scale_std", e.scale_std},
          {"misalignment_deg", degrees(e.misalignment_std)},
          {"resolution", e.resolution},
          {"range", e.range}};
}

}  // namespace

ImuSensor::ImuSensor(const Experiment& experiment, uint32_t node, uint32_t sensor)
    : HostSensor(experiment, node, sensor, "imu"), imu_(std::get<ImuConfig>(config().config)) {
  const char* const at = imu_.mean ? "mean since the sample before" : "at the sample's time";
  declare("time", DType::i64, {-1}, "ns", "[sample] since tick 0");
  const auto add = [&](const char* name, const char* unit, const char* what) {
    declare(name, DType::f64, {-1, 3}, unit, fmt::format("[sample, xyz] {}, sensor axes", what));
  };
  add("specific_force", "m/s^2", fmt::format("measured specific force, {}", at).c_str());
  add("angular_rate", "rad/s", fmt::format("measured angular rate, {}", at).c_str());
  add("specific_force_true", "m/s^2", "specific force without errors");
  add("angular_rate_true", "rad/s", "angular rate without errors");
  add("accelerometer_bias", "m/s^2", "sum of all biases of the accelerometers");
  add("gyroscope_bias", "rad/s", "sum of all biases of the gyroscopes");
  nlohmann::json metadata{{"device", imu_.device},
                          {"sample_rate_hz", imu_.samples_per_record / period_s_},
                          {"samples_per_record", imu_.samples_per_record},
                          {"output", imu_.mean ? "mean" : "instant"},
                          {"earth_rotation", imu_.earth_rotation},
                          {"accelerometer", json_of_triad(imu_.accelerometer)},
                          {"gyroscope", json_of_triad(imu_.gyroscope)}};
  if (imu_.earth_rotation) require_earth_place(experiment, "an inertial sensor with 'earth_rotation'");
  if (const std::optional<EarthPlace> place = earth_place(experiment)) {
    const Geodetic& origin = place->frame.reference().origin;
    frame_ = navigation::earth_frame(radians(origin.latitude_deg), origin.height_m, imu_.earth_rotation);
  }
  metadata["gravity_m_s2"] = -frame_.gravity.z;
  describe(std::move(metadata));
}

void ImuSensor::begin(uint32_t sequence) {
  const double step_s = period_s_ / imu_.samples_per_record;
  const uint64_t seed = experiment_.scenario.seed;
  accelerometer_.emplace(imu_.accelerometer, seed, spec_.name + "/accelerometer", sequence, step_s);
  gyroscope_.emplace(imu_.gyroscope, seed, spec_.name + "/gyroscope", sequence, step_s);
}

ImuSensor::Instants ImuSensor::instants(const TickContext& context) const {
  const int64_t record = sample_at(context.tick), count = imu_.samples_per_record;
  const int64_t now_ns = clock_.nanoseconds(context.tick);
  Instants out;
  out.step_s = period_s_ / static_cast<double>(count);
  if (record == 0) {  // there is no record before it
    out.times_s = {context.time_s};
    out.times_ns = {now_ns};
    return out;
  }
  const int64_t before = times_.tick_of(record - 1);
  const double before_s = clock_.seconds(before);
  const int64_t before_ns = clock_.nanoseconds(before);
  out.first = record * count - (count - 1);
  out.step_s = (context.time_s - before_s) / static_cast<double>(count);
  for (int64_t i = 1; i <= count; ++i) {
    out.times_s.push_back(i == count ? context.time_s : before_s + out.step_s * static_cast<double>(i));
    out.times_ns.push_back(before_ns + ((now_ns - before_ns) * i + count / 2) / count);
  }
  return out;
}

Motion ImuSensor::motion_at(const TickContext& context, double time_s) const {
  return time_s == context.time_s ? context.nodes[node_] : context.motion_at(node_, time_s);
}

navigation::Inertial ImuSensor::truth(const TickContext& context, double time_s, double step_s,
                                      bool first) const {
  const auto motion = [&](double at_s) { return motion_at(context, at_s); };
  if (imu_.mean && !first) {
    const auto end = navigation::mounted(motion(time_s), dvec3(0.0), mount_);
    const auto begin = navigation::mounted(motion(time_s - step_s), dvec3(0.0), mount_);
    return navigation::mean_over(begin, end, step_s, frame_);
  }
  dvec3 acceleration(0.0);  // of the angle; a sensor at the body's origin does not feel it
  if (mount_.position != dvec3(0.0))
    acceleration =
        navigation::angular_acceleration(motion, time_s, std::min(0.5 * step_s, most_half_interval_s));
  return navigation::instantaneous(navigation::mounted(motion(time_s), acceleration, mount_), frame_);
}

std::vector<Array> ImuSensor::measure(const TickContext& context) {
  const Instants at = instants(context);
  std::vector<dvec3> force, rate, force_true, rate_true, force_bias, rate_bias;
  for (size_t i = 0; i < at.times_s.size(); ++i) {
    const int64_t sample = at.first + static_cast<int64_t>(i);
    const navigation::Inertial true_values = truth(context, at.times_s[i], at.step_s, sample == 0);
    const navigation::TriadSample f = accelerometer_->measure(true_values.force, sample);
    const navigation::TriadSample w = gyroscope_->measure(true_values.rate, sample);
    force.push_back(f.measured);
    rate.push_back(w.measured);
    force_true.push_back(true_values.force);
    rate_true.push_back(true_values.rate);
    force_bias.push_back(f.bias);
    rate_bias.push_back(w.bias);
  }
  std::vector<Array> arrays;
  arrays.push_back(Array::of<int64_t>({static_cast<int64_t>(at.times_ns.size())}, at.times_ns));
  for (const std::vector<dvec3>* rows : {&force, &rate, &force_true, &rate_true, &force_bias, &rate_bias})
    arrays.push_back(array_of_rows(*rows));
  return arrays;
}

}  // namespace greatx::sim
