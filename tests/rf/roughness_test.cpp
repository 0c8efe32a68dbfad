// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/surface/roughness.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/units.h"

namespace greatx::rf {
namespace {

TEST(Roughness, Figures) {
  EXPECT_NEAR(roughness_factor(RoughnessModel::ament, 1.0), 0.6065306597126334, 1e-15);
  EXPECT_NEAR(roughness_factor(RoughnessModel::miller_brown, 1.0), 0.6450352704491501, 1e-15);
  EXPECT_NEAR(roughness_factor(RoughnessModel::ament, 2.0), 0.1353352832366127, 1e-15);
  EXPECT_NEAR(roughness_factor(RoughnessModel::miller_brown, 2.0), 0.308508322553671, 1e-15);
  EXPECT_NEAR(roughness_factor(RoughnessModel::miller_brown, 4.0), 0.1434317818568503, 1e-15);
  // A roughness of 1 mm rms at 28 GHz and 60 degrees.
  const double g = roughness_parameter(1e-3, 0.5, speed_of_light / 28e9);
  EXPECT_NEAR(g, 4.0 * pi * 1e-3 * 0.5 * 28e9 / 299792458.0, 1e-15);
  EXPECT_NEAR(roughness_factor(RoughnessModel::ament, g), std::exp(-0.5 * g * g), 1e-15);
}

/// What the mirror direction keeps and what is scattered is all the power. sqrt(1 - 1/e) at g = 1.
TEST(Roughness, WhatASurfaceScattersByItsDeviation) {
  constexpr double deviation_m = 3e-3;
  const double one_hz = speed_of_light / (4.0 * pi * deviation_m);
  EXPECT_NEAR(scattered_share(deviation_m, speed_of_light / one_hz), 0.7950600976206501, 1e-15);
  for (const double hz : {1e8, 1e9, 2e9, 6e9, 28e9}) {
    const double wavelength_m = speed_of_light / hz, g = roughness_parameter(deviation_m, 1.0, wavelength_m),
                 share = scattered_share(deviation_m, wavelength_m);
    EXPECT_NEAR(share * share + std::pow(roughness_factor(RoughnessModel::ament, g), 2), 1.0, 1e-15) << hz;
    const double h = 1e-5 * hz, ahead = scattered_share(deviation_m, speed_of_light / (hz + h)),
                 behind = scattered_share(deviation_m, speed_of_light / (hz - h));
    EXPECT_NEAR(scattered_share_slope(deviation_m, hz) * hz, (ahead - behind) / (2.0 * h) * hz, 1e-9) << hz;
  }
  EXPECT_NEAR(scattered_share(1e-9, 1.0) / (4.0 * pi * 1e-9), 1.0, 1e-12);  // g where it is small
  EXPECT_EQ(scattered_share(deviation_m, speed_of_light / 77e9), 1.0);
  EXPECT_EQ(scattered_share(0.0, 0.1), 1.0);  // materials without a deviation scatter at all frequencies
  EXPECT_EQ(scattered_share_slope(0.0, 1e9), 0.0);
  EXPECT_EQ(scattered_share(1e-200, 0.1), 0.0);  // g^2 is too small for a number, and for a slope
  EXPECT_EQ(scattered_share_slope(1e-200, 3e9), 0.0);
  EXPECT_EQ(scattered_share(10.0, 1e-3), 1.0);
}

TEST(Roughness, SmoothGrazingAndVeryRough) {
  for (const RoughnessModel model : {RoughnessModel::ament, RoughnessModel::miller_brown}) {
    EXPECT_EQ(roughness_factor(model, roughness_parameter(0.0, 1.0, 0.01)), 1.0);
    EXPECT_EQ(roughness_factor(model, roughness_parameter(0.01, 0.0, 0.01)), 1.0);
    EXPECT_EQ(roughness_factor(model, 1e200), 0.0);
    double before = 1.0;
    for (double g = 0.01; g < 100.0; g *= 1.1) {
      const double here = roughness_factor(model, g);
      EXPECT_LE(here, before);
      EXPECT_GE(here, 0.0);
      before = here;
    }
  }
  // I_0 e^{-x} = (1 + 1/8x + ...)/sqrt(2 pi x) with x = g^2/2.
  const double g = 1e4;
  EXPECT_NEAR(roughness_factor(RoughnessModel::miller_brown, g) * std::sqrt(pi) * g, 1.0 + 0.25 / (g * g),
              1e-15);
}

TEST(Roughness, ScaledBessel) {
  // The figures were computed with 30 digits (mpmath).
  constexpr double figures[][2] = {{0.0, 1.0},
                                   {0.0078125, 0.992233078362222237},
                                   {0.5, 0.645035270449150068},
                                   {2.0, 0.30850832255367104},
                                   {8.0, 0.143431781856850311},
                                   {19.99, 0.0898030614289093723},
                                   {20.01, 0.089757579627575303},
                                   {50.0, 0.0565616266474541925},
                                   {1e6, 0.000398942330269245779}};
  for (const auto& [x, expected] : figures) EXPECT_NEAR(scaled_bessel_i0(x) / expected, 1.0, 4e-15) << x;
  EXPECT_EQ(scaled_bessel_i0(std::numeric_limits<double>::infinity()), 0.0);
}

}  // namespace
}  // namespace greatx::rf
