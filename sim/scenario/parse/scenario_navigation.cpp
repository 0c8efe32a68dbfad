// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses the inertial sensors, GNSS receivers, barometers and magnetometers of nodes[].sensors[].
#include <array>

#include "core/units.h"
#include "sim/navigation/presets.h"
#include "sim/scenario/date_time.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

/// The most of an error, in its unit; the shortest and the longest time of a process.
constexpr double most_error = 1e6, least_time_s = 1e-3, most_time_s = 1e9;
constexpr uint32_t most_samples_per_record = 10'000;

void parse_error(const FieldMap& map, const char* key, double& value, double unit = 1.0) {
  if (const auto f = map.find(key)) value = unit * f->non_negative(most_error);
}

void parse_time_constant(const FieldMap& map, const char* key, double& value) {
  if (const auto f = map.find(key)) value = f->between(least_time_s, most_time_s);
}

void parse_triad(const Field& field, navigation::TriadErrors& errors) {
  const FieldMap map(field, {"noise_density", "bias_std", "bias_instability", "bias_time_s", "bias_walk",
                             "scale_std", "misalignment_deg", "resolution", "range"});
  parse_error(map, "noise_density", errors.noise_density);
  parse_error(map, "bias_std", errors.bias_std);
  parse_error(map, "bias_instability", errors.bias_instability);
  parse_time_constant(map, "bias_time_s", errors.bias_time_s);
  parse_error(map, "bias_walk", errors.bias_walk);
  if (const auto f = map.find("scale_std")) errors.scale_std = f->between(0.0, 1.0);
  if (const auto f = map.find("misalignment_deg")) errors.misalignment_std = radians(f->between(0.0, 45.0));
  parse_error(map, "resolution", errors.resolution);
  parse_error(map, "range", errors.range);
}

size_t parse_device(const Field& field) {
  std::vector<std::string_view> names;
  for (const navigation::ImuPreset& preset : navigation::imu_presets()) names.push_back(preset.name);
  return field.choice(names);
}

void parse_gnss_errors(const Field& field, navigation::GnssErrors& errors) {
  const FieldMap map(field,
                     {"code_m", "doppler_m_s", "multipath", "multipath_time_s", "orbit_m", "orbit_time_s",
                      "ionosphere_m", "ionosphere_time_s", "troposphere_m", "troposphere_time_s"});
  parse_error(map, "code_m", errors.code_m);
  parse_error(map, "doppler_m_s", errors.doppler);
  parse_error(map, "multipath", errors.multipath);
  parse_time_constant(map, "multipath_time_s", errors.multipath_time_s);
  parse_error(map, "orbit_m", errors.orbit_m);
  parse_time_constant(map, "orbit_time_s", errors.orbit_time_s);
  parse_error(map, "ionosphere_m", errors.ionosphere_m);
  parse_time_constant(map, "ionosphere_time_s", errors.ionosphere_time_s);
  parse_error(map, "troposphere_m", errors.troposphere_m);
  parse_time_constant(map, "troposphere_time_s", errors.troposphere_time_s);
}

}  // namespace

ImuConfig parse_imu(const FieldMap& map) {
  ImuConfig imu;
  size_t device = 0;
  const std::span<const navigation::ImuPreset> presets = navigation::imu_presets();
  while (presets[device].name != imu.device) ++device;
  if (const auto f = map.find("device")) device = parse_device(*f);
  imu.device = presets[device].name;
  imu.accelerometer = presets[device].accelerometer;
  imu.gyroscope = presets[device].gyroscope;
  if (const auto f = map.find("accelerometer")) parse_triad(*f, imu.accelerometer);
  if (const auto f = map.find("gyroscope")) parse_triad(*f, imu.gyroscope);
  if (const auto f = map.find("samples_per_record"))
    imu.samples_per_record = f->integer32(1, most_samples_per_record);
  if (const auto f = map.find("output")) imu.mean = f->choice({"instant", "mean"}) == 1;
  if (const auto f = map.find("earth_rotation")) imu.earth_rotation = f->boolean();
  return imu;
}

GnssConfig parse_gnss(const FieldMap& map) {
  GnssConfig gnss;
  if (const auto f = map.find("time")) {
    gnss.time = f->text();
    gnss.unix_s = parse_date_time(gnss.time);
    if (!gnss.unix_s || *gnss.unix_s < first_known_instant || *gnss.unix_s > last_known_instant)
      f->fail("a date and time of the years 1900 to 2150 with its offset, such as 2026-06-21T12:00:00Z");
  }
  if (const auto f = map.find("mask_deg")) gnss.receiver.mask = radians(f->between(0.0, 90.0));
  if (const auto f = map.find("most_pdop")) gnss.receiver.most_pdop = f->between(1.0, 1e6);
  if (const auto f = map.find("reflections")) gnss.reflections = f->boolean();
  if (const auto f = map.find("integrity")) gnss.receiver.integrity = f->boolean();
  if (const auto f = map.find("false_alarm")) gnss.receiver.false_alarm = f->between(1e-12, 0.5);
  if (const auto f = map.find("errors")) parse_gnss_errors(*f, gnss.receiver.errors);
  return gnss;
}

BarometerConfig parse_barometer(const FieldMap& map) {
  BarometerConfig barometer;
  if (const auto f = map.find("sea_level_hpa")) barometer.sea_level_pa = 100.0 * f->between(500.0, 1500.0);
  navigation::BarometerErrors& errors = barometer.errors;
  parse_error(map, "noise_pa", errors.noise_std);
  parse_error(map, "bias_pa", errors.bias_std);
  parse_error(map, "drift_pa", errors.drift_std);
  parse_time_constant(map, "drift_time_s", errors.drift_time_s);
  parse_error(map, "resolution_pa", errors.resolution);
  return barometer;
}

MagnetometerConfig parse_magnetometer(const FieldMap& map) {
  constexpr double microtesla = 1e-6;
  MagnetometerConfig magnetometer;
  parse_error(map, "noise_ut", magnetometer.noise_t, microtesla);
  parse_error(map, "hard_iron_ut", magnetometer.hard_iron_t, microtesla);
  if (const auto f = map.find("soft_iron")) magnetometer.soft_iron = f->between(0.0, 1.0);
  parse_error(map, "drift_ut", magnetometer.drift_t, microtesla);
  parse_time_constant(map, "drift_time_s", magnetometer.drift_time_s);
  parse_error(map, "resolution_ut", magnetometer.resolution_t, microtesla);
  parse_error(map, "range_ut", magnetometer.range_t, microtesla);
  return magnetometer;
}

}  // namespace greatx::sim
