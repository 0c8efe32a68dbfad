// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/atmosphere/gas.h"

#include <cmath>

#include "core/error.h"
#include "rf/atmosphere/gas_lines.h"
#include "rf/atmosphere/weather.h"

namespace greatx::rf {
namespace {

/// Describes the air in the variables of the recommendation.
struct Air {
  double p;      ///< dry pressure, hPa
  double e;      ///< vapour pressure, hPa
  double theta;  ///< 300 / T
};

/// Returns the line shape F (P.676-13, eq. 5), all frequencies in GHz: `delta_f` is the width, `delta` the
/// interference.
template <typename R>
R line_shape(const R& f, double f0, double delta_f, double delta) {
  const R below = f0 - f, above = f0 + f;
  return f / f0 *
         ((delta_f - delta * below) / (below * below + delta_f * delta_f) +
          (delta_f - delta * above) / (above * above + delta_f * delta_f));
}

template <typename R>
R oxygen(const R& f, const Air& air) {
  R sum = 0.0;
  for (const OxygenLine& line : oxygen_lines()) {
    const double strength =
        line.a1 * 1e-7 * air.p * std::pow(air.theta, 3.0) * std::exp(line.a2 * (1.0 - air.theta));  // eq. 3
    const double pressure_width =
        line.a3 * 1e-4 * (air.p * std::pow(air.theta, 0.8 - line.a4) + 1.1 * air.e * air.theta);  // eq. 6a
    const double width = std::sqrt(pressure_width * pressure_width + 2.25e-6);  // eq. 6b: Zeeman splitting
    const double interference =
        (line.a5 + line.a6 * air.theta) * 1e-4 * (air.p + air.e) * std::pow(air.theta, 0.8);  // eq. 7
    sum += strength * line_shape(f, line.f0_ghz, width, interference);
  }
  return sum;
}

template <typename R>
R water_vapour(const R& f, const Air& air) {
  R sum = 0.0;
  for (const WaterVapourLine& line : water_vapour_lines()) {
    const double strength =
        line.b1 * 1e-1 * air.e * std::pow(air.theta, 3.5) * std::exp(line.b2 * (1.0 - air.theta));  // eq. 3
    const double pressure_width =
        line.b3 * 1e-4 *
        (air.p * std::pow(air.theta, line.b4) + line.b5 * air.e * std::pow(air.theta, line.b6));  // eq. 6a
    // eq. 6b: Doppler broadening
    const double width =
        0.535 * pressure_width + std::sqrt(0.217 * pressure_width * pressure_width +
                                           2.1316e-12 * line.f0_ghz * line.f0_ghz / air.theta);
    sum += strength * line_shape(f, line.f0_ghz, width, 0.0);
  }
  return sum;
}

/// Returns N''_D (P.676-13, eq. 8 and 9): the Debye spectrum of oxygen below 10 GHz and the pressure-induced
/// absorption of nitrogen above 100 GHz. The first term is 6.14e-5 / (d (1 + (f/d)^2)), written so that it is
/// 0 in a vacuum (d = 0).
template <typename R>
R dry_continuum(const R& f, const Air& air) {
  using std::pow;
  const double d = 5.6e-4 * (air.p + air.e) * std::pow(air.theta, 0.8);
  const R debye = 6.14e-5 * d / (d * d + f * f);
  const R nitrogen = 1.4e-12 * air.p * std::pow(air.theta, 1.5) / (1.0 + 1.9e-5 * pow(f, 1.5));
  return f * air.p * air.theta * air.theta * (debye + nitrogen);
}

}  // namespace

template <typename R>
R gas_db_per_km(const Given<R>& frequency_hz, double temperature_k, double dry_pressure_hpa,
                double water_vapour_g_m3) {
  if (!gas_model_covers(value_of(frequency_hz)))
    throw_user_error(
        "gas attenuation: expected a frequency from 1 to 1000 GHz (ITU-R P.676-13, Annex 1), found {:g} GHz",
        value_of(frequency_hz) / 1e9);
  GREATX_CHECK(temperature_k > 0.0 && dry_pressure_hpa >= 0.0 && water_vapour_g_m3 >= 0.0,
               "{} K, {} hPa, {} g/m3", temperature_k, dry_pressure_hpa, water_vapour_g_m3);
  const R f = frequency_hz / 1e9;
  const Air air{dry_pressure_hpa, vapour_pressure_hpa(water_vapour_g_m3, temperature_k),
                300.0 / temperature_k};
  return 0.182 * f * (oxygen(f, air) + dry_continuum(f, air) + water_vapour(f, air));
}

template double gas_db_per_km<double>(const double&, double, double, double);
template Dual gas_db_per_km<Dual>(const Dual&, double, double, double);

}  // namespace greatx::rf
