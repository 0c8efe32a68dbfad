// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/surface/roughness.h"

#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {

double scaled_bessel_i0(double x) {
  GREATX_CHECK(x >= 0.0, "{}", x);
  double sum = 1.0, term = 1.0;
  if (x < 20.0) {  // sum of (x^2/4)^k / (k!)^2; the terms are positive, so nothing cancels
    for (int k = 1; term > 1e-17 * sum; ++k) {
      term *= 0.25 * x * x / (double(k) * k);
      sum += term;
    }
    return std::exp(-x) * sum;
  }
  // The asymptotic series is the sum of ((2k - 1)!!)^2 / (k! (8x)^k). Its smallest term is e^{-2x} here.
  for (int k = 1; k < 40 && term > 1e-17; ++k) {
    const double odd = 2.0 * k - 1.0;
    term *= odd * odd / (k * 8.0 * x);
    sum += term;
  }
  return sum / std::sqrt(2.0 * pi * x);
}

double roughness_parameter(double rms_height_m, double cos_theta, double wavelength_m) {
  GREATX_CHECK(rms_height_m >= 0.0 && cos_theta >= 0.0 && cos_theta <= 1.0 && wavelength_m > 0.0,
               "rms height {} m, cosine {}, wavelength {} m", rms_height_m, cos_theta, wavelength_m);
  return 4.0 * pi * rms_height_m * cos_theta / wavelength_m;
}

double roughness_factor(RoughnessModel model, double g) {
  GREATX_CHECK(g >= 0.0, "g = {}", g);
  const double x = 0.5 * g * g;
  return model == RoughnessModel::ament ? std::exp(-x) : scaled_bessel_i0(x);
}

double most_roughness_db(double rms_height_m, double wavelength_m) {
  const double g = roughness_parameter(rms_height_m, 1.0, wavelength_m);
  return -20.0 * std::log10(roughness_factor(RoughnessModel::ament, g));
}

}  // namespace greatx::rf
