// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/atmosphere/path_attenuation.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "rf/antenna/antenna.h"
#include "rf/atmosphere/fog.h"
#include "rf/atmosphere/gas.h"

namespace greatx::rf {

double amplitude(double db_per_km, double distance_m) {
  GREATX_CHECK(db_per_km >= 0.0 && distance_m >= 0.0 && std::isfinite(distance_m), "{} dB/km over {} m",
               db_per_km, distance_m);
  return std::pow(10.0, -(db_per_km * 1e-3) * distance_m / 20.0);
}

PolarizedAmplitude PathAttenuation::of(const dvec3& direction, double distance_m) const {
  if (rain_mm_h == 0.0) {
    const double both = amplitude(isotropic(), distance_m);
    return {both, both};
  }
  const double level = direction.x * direction.x + direction.y * direction.y;  // cos^2(elevation)
  const RainAttenuation here = rain_db_per_km(rain, rain_mm_h, std::min(1.0, level));
  return {amplitude(isotropic() + here.v, distance_m), amplitude(isotropic() + here.h, distance_m)};
}

FieldVector PathAttenuation::after(const FieldVector& field, const dvec3& direction,
                                   double distance_m) const {
  const PolarizedAmplitude factor = of(direction, distance_m);
  const dvec3 theta = theta_hat(direction), phi = phi_hat(direction);
  FieldVector result;
  result.add(factor.theta * field.along(theta), theta);
  result.add(factor.phi * field.along(phi), phi);
  return result;
}

PathAttenuation path_attenuation(const Weather& weather, double frequency_hz, const WeatherEffects& effects) {
  PathAttenuation attenuation;
  if (effects.gas)
    attenuation.gas = gas_db_per_km(frequency_hz, weather.temperature_k, weather.dry_pressure_hpa,
                                    weather.water_vapour_g_m3);
  if (effects.fog) attenuation.fog = fog_db_per_km(frequency_hz, weather.temperature_k, weather.fog_g_m3);
  if (!effects.rain || weather.rain_mm_h == 0.0) return attenuation;
  attenuation.rain = rain_coefficients(frequency_hz);
  attenuation.rain_mm_h = weather.rain_mm_h;
  const RainAttenuation level = rain_db_per_km(attenuation.rain, weather.rain_mm_h, 1.0);
  attenuation.rain_h = level.h;
  attenuation.rain_v = level.v;
  return attenuation;
}

}  // namespace greatx::rf
