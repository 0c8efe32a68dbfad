// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/surface/roughness.h"

#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {

template <typename R>
R scaled_bessel_i0(const Given<R>& x) {
  using std::exp, std::sqrt;
  GREATX_CHECK(x >= 0.0, "{}", value_of(x));
  R sum = 1.0, term = 1.0;
  if (x < 20.0) {  // sum of (x^2/4)^k / (k!)^2; the terms are positive, so nothing cancels
    for (int k = 1; term > 1e-17 * sum; ++k) {
      term *= 0.25 * x * x / (double(k) * k);
      sum += term;
    }
    return exp(-x) * sum;
  }
  // The asymptotic series is the sum of ((2k - 1)!!)^2 / (k! (8x)^k). Its smallest term is e^{-2x} here.
  for (int k = 1; k < 40 && term > 1e-17; ++k) {
    const double odd = 2.0 * k - 1.0;
    term *= odd * odd / (k * 8.0 * x);
    sum += term;
  }
  return sum / sqrt(2.0 * pi * x);
}

template <typename R>
R roughness_parameter(const Given<R>& rms_height_m, const Given<R>& cos_theta, const Given<R>& wavelength_m) {
  GREATX_CHECK(rms_height_m >= 0.0 && cos_theta >= 0.0 && cos_theta <= 1.0 && wavelength_m > 0.0,
               "rms height {} m, cosine {}, wavelength {} m", value_of(rms_height_m), value_of(cos_theta),
               value_of(wavelength_m));
  return 4.0 * pi * rms_height_m * cos_theta / wavelength_m;
}

template <typename R>
R roughness_factor(RoughnessModel model, const Given<R>& g) {
  using std::exp;
  GREATX_CHECK(g >= 0.0, "g = {}", value_of(g));
  const R x = 0.5 * g * g;
  return model == RoughnessModel::ament ? exp(-x) : scaled_bessel_i0<R>(x);
}

double scattered_share(double deviation_m, double wavelength_m) {
  if (deviation_m == 0.0) return 1.0;
  const double g = roughness_parameter(deviation_m, 1.0, wavelength_m);
  return std::sqrt(-std::expm1(-g * g));
}

double scattered_share_slope(double deviation_m, double frequency_hz) {
  if (deviation_m == 0.0) return 0.0;
  const double wavelength_m = speed_of_light / frequency_hz,
               g = roughness_parameter(deviation_m, 1.0, wavelength_m);
  const double share = scattered_share(deviation_m, wavelength_m);
  return share > 0.0 ? g * g * std::exp(-g * g) / (frequency_hz * share) : 0.0;
}

double most_roughness_db(double rms_height_m, double wavelength_m) {
  const double g = roughness_parameter(rms_height_m, 1.0, wavelength_m);
  return -20.0 * std::log10(roughness_factor(RoughnessModel::ament, g));
}

template double scaled_bessel_i0<double>(const double&);
template Dual scaled_bessel_i0<Dual>(const Dual&);
template double roughness_parameter<double>(const double&, const double&, const double&);
template Dual roughness_parameter<Dual>(const Dual&, const Dual&, const Dual&);
template double roughness_factor<double>(RoughnessModel, const double&);
template Dual roughness_factor<Dual>(RoughnessModel, const Dual&);

}  // namespace greatx::rf
