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

template <typename R>
R amplitude(const Given<R>& db_per_km, const Given<R>& distance_m) {
  using std::pow;
  GREATX_CHECK(db_per_km >= 0.0 && distance_m >= 0.0 && std::isfinite(value_of(distance_m)),
               "{} dB/km over {} m", value_of(db_per_km), value_of(distance_m));
  return pow(10.0, -(db_per_km * 1e-3) * distance_m / 20.0);
}
template double amplitude<double>(const double&, const double&);
template Dual amplitude<Dual>(const Dual&, const Dual&);

template <typename R>
PolarizedAmplitudeOf<R> PathAttenuationOf<R>::of(const Vec3Of<R>& direction, const R& distance_m) const {
  if (rain_mm_h == 0.0) {
    const R both = amplitude<R>(isotropic(), distance_m);
    return {both, both};
  }
  const R level = direction.x * direction.x + direction.y * direction.y;  // cos^2(elevation)
  const RainAttenuationOf<R> here = rain_db_per_km<R>(rain, rain_mm_h, std::min(R(1.0), level));
  return {amplitude<R>(isotropic() + here.v, distance_m), amplitude<R>(isotropic() + here.h, distance_m)};
}

template <typename R>
FieldVectorOf<R> PathAttenuationOf<R>::after(const FieldVectorOf<R>& field, const Vec3Of<R>& direction,
                                             const R& distance_m) const {
  const PolarizedAmplitudeOf<R> factor = of(direction, distance_m);
  const Vec3Of<R> theta = theta_hat<R>(direction), phi = phi_hat<R>(direction);
  FieldVectorOf<R> result;
  result.add(factor.theta * field.along(theta), theta);
  result.add(factor.phi * field.along(phi), phi);
  return result;
}
template struct PathAttenuationOf<double>;
template struct PathAttenuationOf<Dual>;

template <typename R>
PathAttenuationOf<R> path_attenuation(const Weather& weather, const Given<R>& frequency_hz,
                                      const WeatherEffects& effects) {
  PathAttenuationOf<R> attenuation;
  if (effects.gas)
    attenuation.gas = gas_db_per_km<R>(frequency_hz, weather.temperature_k, weather.dry_pressure_hpa,
                                       weather.water_vapour_g_m3);
  if (effects.fog) attenuation.fog = fog_db_per_km<R>(frequency_hz, weather.temperature_k, weather.fog_g_m3);
  if (!effects.rain || weather.rain_mm_h == 0.0) return attenuation;
  attenuation.rain = rain_coefficients<R>(frequency_hz);
  attenuation.rain_mm_h = weather.rain_mm_h;
  const RainAttenuationOf<R> level = rain_db_per_km<R>(attenuation.rain, weather.rain_mm_h, 1.0);
  attenuation.rain_h = level.h;
  attenuation.rain_v = level.v;
  return attenuation;
}
template PathAttenuation path_attenuation<double>(const Weather&, const double&, const WeatherEffects&);
template PathAttenuationOf<Dual> path_attenuation<Dual>(const Weather&, const Dual&, const WeatherEffects&);

}  // namespace greatx::rf
