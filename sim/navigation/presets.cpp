// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/navigation/presets.h"

#include "core/units.h"
#include "sim/navigation/inertial.h"

namespace greatx::navigation {

namespace {

constexpr double g = standard_gravity, degree = pi / 180.0, hour = 3600.0;

constexpr ImuPreset presets[] = {
    {"ideal", "an inertial sensor without errors", {}, {}},
    // Bosch Sensortec, BMI088 data sheet, tables 1 and 2: a MEMS sensor of small drones. The instability of
    // the accelerometer's bias is not in the data sheet; it is the order of published Allan variances.
    {"bmi088",
     "a consumer MEMS sensor",
     {.noise_density = 175e-6 * g,
      .bias_std = 20e-3 * g,
      .bias_instability = 25e-6 * g,
      .bias_time_s = 300.0,
      .scale_std = 8e-3,
      .misalignment_std = 5e-3,
      .resolution = 24.0 * g / 32768.0,
      .range = 24.0 * g},
     {.noise_density = 0.014 * degree,
      .bias_std = 1.0 * degree,
      .bias_instability = 2.0 * degree / hour,
      .bias_time_s = 300.0,
      .scale_std = 1e-2,
      .misalignment_std = 1e-2,
      .resolution = 2000.0 * degree / 32768.0,
      .range = 2000.0 * degree}},
    // The parameters of EuRoC's imu0/sensor.yaml (M. Burri et al., Int. J. Robotics Research 35 (2016)), with
    // ranges and resolutions of Analog Devices' data sheet of the ADIS16448.
    {"adis16448",
     "the sensor of the EuRoC MAV data set",
     {.noise_density = 2.0e-3, .bias_walk = 3.0e-3, .resolution = g / 1200.0, .range = 18.0 * g},
     {.noise_density = 1.6968e-4,
      .bias_walk = 1.9393e-5,
      .resolution = 0.04 * degree,
      .range = 1000.0 * degree}},
    // Analog Devices, ADIS16495-1 data sheet, table 1: 0.09 degrees and 0.008 m/s per square root of an hour.
    {"adis16495",
     "a tactical MEMS sensor",
     {.noise_density = 0.008 / 60.0,
      .bias_std = 1.4e-3 * g,
      .bias_instability = 3.2e-6 * g,
      .bias_time_s = 100.0,
      .scale_std = 1e-3,
      .misalignment_std = 0.035 * degree,
      .resolution = 8.0 * g / 32768.0 / 65536.0,
      .range = 8.0 * g},
     {.noise_density = 0.09 * degree / 60.0,
      .bias_std = 0.07 * degree,
      .bias_instability = 0.8 * degree / hour,
      .bias_time_s = 100.0,
      .scale_std = 2e-3,
      .misalignment_std = 0.05 * degree,
      .resolution = 125.0 * degree / 20000.0 / 65536.0,
      .range = 125.0 * degree}},
};

}  // namespace

std::span<const ImuPreset> imu_presets() { return presets; }

}  // namespace greatx::navigation
