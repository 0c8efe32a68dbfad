// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/atmosphere/rain.h"

#include <cmath>
#include <span>

#include "core/error.h"

namespace greatx::rf {
namespace {

/// Terms of the regression sum_j a exp(-((log10 f - b)/c)^2) + m log10 f + c0 (P.838-3, eq. 2 and 3).
struct Bell {
  double a, b, c;
};
struct Regression {
  std::span<const Bell> bells;
  double slope, constant;
  template <typename R>
  R at(const R& log10_ghz) const {
    using std::exp;
    R sum = slope * log10_ghz + constant;
    for (const Bell& bell : bells) {
      const R x = (log10_ghz - bell.b) / bell.c;
      sum += bell.a * exp(-x * x);
    }
    return sum;
  }
};

// ITU-R P.838-3, Tables 1 to 4.
constexpr Bell k_h_bells[] = {{-5.33980, -0.10008, 1.13098},
                              {-0.35351, 1.26970, 0.45400},
                              {-0.23789, 0.86036, 0.15354},
                              {-0.94158, 0.64552, 0.16817}};
constexpr Bell k_v_bells[] = {{-3.80595, 0.56934, 0.81061},
                              {-3.44965, -0.22911, 0.51059},
                              {-0.39902, 0.73042, 0.11899},
                              {0.50167, 1.07319, 0.27195}};
constexpr Bell alpha_h_bells[] = {{-0.14318, 1.82442, -0.55187},
                                  {0.29591, 0.77564, 0.19822},
                                  {0.32177, 0.63773, 0.13164},
                                  {-5.37610, -0.96230, 1.47828},
                                  {16.1721, -3.29980, 3.43990}};
constexpr Bell alpha_v_bells[] = {{-0.07771, 2.33840, -0.76284},
                                  {0.56727, 0.95545, 0.54039},
                                  {-0.20238, 1.14520, 0.26809},
                                  {-48.2991, 0.791669, 0.116226},
                                  {48.5833, 0.791459, 0.116479}};
constexpr Regression log_k_h{k_h_bells, -0.18961, 0.71147};
constexpr Regression log_k_v{k_v_bells, -0.16398, 0.63297};
constexpr Regression alpha_h{alpha_h_bells, 0.67849, -1.95537};
constexpr Regression alpha_v{alpha_v_bells, -0.053739, 0.83433};

/// Returns gamma by eq. 1, 4 and 5. `lean` = cos^2(elevation) cos(2 tilt) runs from 1 (horizontal path,
/// horizontal polarization) to -1 (horizontal path, vertical polarization).
template <typename R>
R gamma_of(const RainCoefficientsOf<R>& c, double rain_mm_h, const R& lean) {
  using std::pow;
  const R k = 0.5 * (c.k_h + c.k_v + (c.k_h - c.k_v) * lean);
  const R alpha =
      (c.k_h * c.alpha_h + c.k_v * c.alpha_v + (c.k_h * c.alpha_h - c.k_v * c.alpha_v) * lean) / (2.0 * k);
  return k * pow(rain_mm_h, alpha);
}

}  // namespace

template <typename R>
RainCoefficientsOf<R> rain_coefficients(const Given<R>& frequency_hz) {
  using std::log10, std::pow;
  if (!rain_model_covers(value_of(frequency_hz)))
    throw_user_error(
        "rain attenuation: expected a frequency from 1 to 1000 GHz (ITU-R P.838-3), found {:g} GHz",
        value_of(frequency_hz) / 1e9);
  const R x = log10(frequency_hz / 1e9);
  return {pow(10.0, log_k_h.at(x)), alpha_h.at(x), pow(10.0, log_k_v.at(x)), alpha_v.at(x)};
}

template <typename R>
RainAttenuationOf<R> rain_db_per_km(const RainCoefficientsOf<Given<R>>& coefficients, double rain_mm_h,
                                    const Given<R>& cos2_elevation) {
  GREATX_CHECK(rain_mm_h >= 0.0 && cos2_elevation >= 0.0 && cos2_elevation <= 1.0,
               "{} mm/h, cos^2(elevation) {}", rain_mm_h, value_of(cos2_elevation));
  return {gamma_of<R>(coefficients, rain_mm_h, cos2_elevation),
          gamma_of<R>(coefficients, rain_mm_h, -cos2_elevation)};
}

template RainCoefficients rain_coefficients<double>(const double&);
template RainCoefficientsOf<Dual> rain_coefficients<Dual>(const Dual&);
template RainAttenuation rain_db_per_km<double>(const RainCoefficients&, double, const double&);
template RainAttenuationOf<Dual> rain_db_per_km<Dual>(const RainCoefficientsOf<Dual>&, double, const Dual&);

}  // namespace greatx::rf
