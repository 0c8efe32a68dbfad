// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests what raindrops send back against Rayleigh's limit, Fresnel's limit and the attenuation of ITU-R
// P.838.
#include "rf/atmosphere/rain_backscatter.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "rf/atmosphere/fog.h"
#include "rf/atmosphere/rain.h"
#include "rf/atmosphere/water.h"

namespace greatx::rf {
namespace {

constexpr double kelvin = 283.15;

/// |K|^2 = |(eps - 1)/(eps + 2)|^2.
double dielectric_factor(double frequency_hz) {
  const WaterPermittivity water = water_permittivity(frequency_hz, kelvin);
  const std::complex<double> eps(water.stored, -water.lost);
  return std::norm((eps - 1.0) / (eps + 2.0));
}

TEST(RainBackscatter, SmallDropsScatterAsRayleigh) {
  for (const double frequency_hz : {3e9, 10e9, 77e9}) {
    const double lambda = speed_of_light / frequency_hz, d = lambda / 300.0;
    const double rayleigh =
        std::pow(pi, 5) * dielectric_factor(frequency_hz) * std::pow(d, 6) / std::pow(lambda, 4);
    EXPECT_NEAR(sphere_sections(d, frequency_hz, kelvin).back / rayleigh, 1.0, 5e-3) << frequency_hz;
    // Absorption is pi^2 d^3/lambda Im(-K); scattering is far below it.
    const WaterPermittivity water = water_permittivity(frequency_hz, kelvin);
    const std::complex<double> eps(water.stored, -water.lost), k = (eps - 1.0) / (eps + 2.0);
    const double absorbed = pi * pi * d * d * d / lambda * -k.imag();
    EXPECT_NEAR(sphere_sections(d, frequency_hz, kelvin).extinction / absorbed, 1.0, 0.03) << frequency_hz;
  }
}

TEST(RainBackscatter, LargeSpheresReflectAsFresnelSays) {
  // Absorbing spheres of many wavelengths: pi a^2 |r|^2 with the reflection at normal incidence, and twice
  // the geometric cross-section in extinction.
  const double frequency_hz = 30e9, d = 1.0;
  const WaterPermittivity water = water_permittivity(frequency_hz, kelvin);
  const std::complex<double> index = std::sqrt(std::complex<double>(water.stored, -water.lost));
  const double reflected = std::norm((index - 1.0) / (index + 1.0)), area = 0.25 * pi * d * d;
  const SphereSections sections = sphere_sections(d, frequency_hz, kelvin);
  EXPECT_NEAR(sections.back / (area * reflected), 1.0, 0.02);
  EXPECT_NEAR(sections.extinction / area, 2.0, 0.1);
}

TEST(RainBackscatter, AtLowFrequenciesItIsTheReflectivityFactor) {
  // eta = pi^5 |K|^2 Z/lambda^4 with Z = sum N(D) D^6 of Marshall and Palmer's drops up to 7 mm. At 3 GHz a
  // drop of 5 mm is half a wavelength of water wide: the difference is some per cent. At 77 GHz Rayleigh's
  // formula is wrong by a factor of three and more.
  for (const double rain_mm_h : {1.0, 10.0, 50.0}) {
    double z = 0.0;  // m^6/m^3
    for (double d = 0.005; d < 7.0; d += 0.01)
      z += 8000.0 * std::exp(-4.1 * std::pow(rain_mm_h, -0.21) * d) * 0.01 * std::pow(1e-3 * d, 6);
    const auto ratio = [&](double frequency_hz) {
      const double rayleigh =
          std::pow(pi, 5) * dielectric_factor(frequency_hz) * z / std::pow(speed_of_light / frequency_hz, 4);
      return rain_backscatter(frequency_hz, kelvin, rain_mm_h).reflectivity_per_m / rayleigh;
    };
    EXPECT_NEAR(ratio(1e9), 1.0, 0.012) << rain_mm_h;
    EXPECT_NEAR(ratio(3e9), 1.0, 0.1) << rain_mm_h;
    if (rain_mm_h < 50.0) {
      EXPECT_NEAR(ratio(10e9), 1.0, 0.25) << rain_mm_h;
    }
    EXPECT_LT(ratio(77e9), 0.34) << rain_mm_h;
    EXPECT_GT(ratio(77e9), 0.003) << rain_mm_h;
  }
}

TEST(RainBackscatter, TheSameDropsAttenuateAsP838Says) {
  // Recommendation P.838-3 has flattened drops of other size distributions: within a third.
  for (const double frequency_hz : {12e9, 24e9, 35e9, 77e9, 94e9})
    for (const double rain_mm_h : {5.0, 25.0}) {
      const RainCoefficients c = rain_coefficients(frequency_hz);
      const RainAttenuation loss = rain_db_per_km(c, rain_mm_h, 1.0);
      const double mie = rain_backscatter(frequency_hz, 293.15, rain_mm_h).extinction_db_per_km;
      EXPECT_NEAR(mie / (0.5 * (loss.h + loss.v)), 1.0, 0.34) << frequency_hz << " " << rain_mm_h;
    }
}

TEST(RainBackscatter, DropsFallAsTheirSizesSay) {
  const RainBackscatter low = rain_backscatter(3e9, kelvin, 10.0),
                        high = rain_backscatter(77e9, kelvin, 10.0);
  // At 3 GHz large drops count most: 7 to 9 m/s. At 77 GHz the smaller ones do.
  EXPECT_GT(low.fall_m_s, 7.0);
  EXPECT_LT(low.fall_m_s, 9.0);
  EXPECT_LT(high.fall_m_s, low.fall_m_s);
  EXPECT_GT(high.fall_m_s, 3.0);
  EXPECT_GT(high.fall_spread_m_s, 0.3);
  EXPECT_LT(high.fall_spread_m_s, 2.5);
}

TEST(RainBackscatter, KnowsItsRange) {
  EXPECT_EQ(rain_backscatter(77e9, kelvin, 0.0).reflectivity_per_m, 0.0);
  EXPECT_THROW(rain_backscatter(0.9e9, kelvin, 1.0), UserError);
  EXPECT_THROW(rain_backscatter(301e9, kelvin, 1.0), UserError);
}

}  // namespace
}  // namespace greatx::rf
