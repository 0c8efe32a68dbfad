// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines light in eight bands of 40 nm from 380 to 700 nm. They are enough for air, whose coefficients are
// smooth. Three bands would turn a clear sky purple.
#pragma once

#include <array>
#include <cmath>

#include "core/vec.h"

namespace greatx::render {

inline constexpr int bands = 8;

struct Spectrum {
  std::array<double, bands> v{};

  static Spectrum all(double value) {
    Spectrum s;
    s.v.fill(value);
    return s;
  }
  template <typename F>
  static Spectrum of_wavelength(F&& f) {
    Spectrum s;
    for (int i = 0; i < bands; ++i) s.v[i] = f(400.0 + 40.0 * i);
    return s;
  }
  Spectrum& operator+=(const Spectrum& o) {
    for (int i = 0; i < bands; ++i) v[i] += o.v[i];
    return *this;
  }
  Spectrum& operator*=(const Spectrum& o) {
    for (int i = 0; i < bands; ++i) v[i] *= o.v[i];
    return *this;
  }
  Spectrum& operator*=(double f) {
    for (double& x : v) x *= f;
    return *this;
  }
  friend Spectrum operator+(Spectrum a, const Spectrum& b) { return a += b; }
  friend Spectrum operator*(Spectrum a, const Spectrum& b) { return a *= b; }
  friend Spectrum operator*(Spectrum a, double f) { return a *= f; }
};

inline Spectrum exp_of(Spectrum s) {
  for (double& x : s.v) x = std::exp(x);
  return s;
}

/// Returns the linear Rec. 709 colour of a spectrum that is given as a share of the sun's above the air,
/// scaled so that all of the sun's light has luminance 1. The sun is ASTM G173-03, extraterrestrial, averaged
/// over the bands. The eye is CIE 1931 by the fit of C. Wyman, P.-P. Sloan and P. Shirley, "Simple Analytic
/// Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013. Saturated colours outside Rec.
/// 709 have channels below 0.
dvec3 color_of(const Spectrum& share_of_sun);

}  // namespace greatx::render
