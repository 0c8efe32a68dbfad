// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the pressure of the standard atmosphere and the errors of a barometer.
#pragma once

#include <string>

#include "sim/navigation/random_process.h"

namespace greatx::navigation {

/// Pressure of the standard atmosphere at the level of the sea, Pa.
inline constexpr double standard_pressure_pa = 101325.0;

/// Returns the air's pressure at a height above the sea, Pa: U.S. Standard Atmosphere 1976 (NOAA-S/T 76-1562,
/// eqs. 18, 33a and 33b, and table 4, from -5 km to 32 km), which is ISO 2533's too, times
/// `sea_level_pa` / 101325. Throws UserError for a height beyond that.
double air_pressure(double height_m, double sea_level_pa = standard_pressure_pa);

/// Returns the height of the standard atmosphere with that pressure, m: what a barometric altimeter shows.
/// The inverse of air_pressure() for its heights.
double pressure_height(double pressure_pa, double sea_level_pa = standard_pressure_pa);

/// Holds the errors of a barometer, Pa. A value of 0 leaves its term out.
struct BarometerErrors {
  double noise_std = 1.2;        ///< of each sample
  double bias_std = 25.0;        ///< constant of a sequence
  double drift_std = 6.0;        ///< of a first-order Gauss-Markov process: weather, temperature, airflow
  double drift_time_s = 1000.0;  ///< its correlation time
  double resolution = 0.016;     ///< quantum of the output
  bool operator==(const BarometerErrors&) const = default;
};

/// Measures pressure with errors; the random numbers depend on (seed, name, sequence).
class Barometer {
 public:
  Barometer(const BarometerErrors& errors, uint64_t seed, const std::string& name, uint32_t sequence,
            double step_s);
  struct Sample {
    double measured_pa = 0.0, bias_pa = 0.0;
  };
  Sample measure(double truth_pa, int64_t sample);

 private:
  BarometerErrors errors_;
  double constant_ = 0.0;
  NormalStream white_;
  GaussMarkov drift_;
};

}  // namespace greatx::navigation
