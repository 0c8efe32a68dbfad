// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/atmosphere/water.h"

namespace greatx::rf {

template <typename R>
WaterPermittivityOf<R> water_permittivity(const Given<R>& frequency_hz, double temperature_k) {
  const R f = frequency_hz / 1e9;
  const double warm = 300.0 / temperature_k - 1.0;  // theta - 1
  const double eps0 = 77.66 + 103.3 * warm, eps1 = 0.0671 * eps0, eps2 = 3.52;
  // Principal and secondary relaxation frequency, GHz.
  const double fp = 20.20 - 146.0 * warm + 316.0 * warm * warm, fs = 39.8 * fp;
  const R x = f / fp, y = f / fs;
  return {(eps0 - eps1) / (1.0 + x * x) + (eps1 - eps2) / (1.0 + y * y) + eps2,
          x * (eps0 - eps1) / (1.0 + x * x) + y * (eps1 - eps2) / (1.0 + y * y)};
}

template WaterPermittivity water_permittivity<double>(const double&, double);
template WaterPermittivityOf<Dual> water_permittivity<Dual>(const Dual&, double);

}  // namespace greatx::rf
