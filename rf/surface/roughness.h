// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/dual.h"

namespace greatx::rf {

/// Selects how a rough surface weakens its specular reflection. The two models differ for g > 1: by 7 dB at g
/// = 2 and by 53 dB at g = 4.
enum class RoughnessModel : uint8_t {
  /// exp(-g^2/2), for normally distributed heights (W. S. Ament, "Toward a theory of reflection by a rough
  /// surface", Proc. IRE 41, 1953).
  ament,
  /// exp(-g^2/2) I_0(g^2/2) (A. R. Miller, R. M. Brown, E. Vegh, "New derivation for the rough-surface
  /// reflection coefficient and for the distribution of sea-wave elevations", IEE Proc. H 131, 1984).
  miller_brown,
};

/// Returns g = 4 pi sigma_h cos(theta) / lambda: the standard deviation of the phase over the surface, rad.
/// `cos_theta` is the cosine of the angle from the normal; `rms_height_m` is >= 0.
template <typename R = double>
R roughness_parameter(const Given<R>& rms_height_m, const Given<R>& cos_theta, const Given<R>& wavelength_m);

/// Returns the factor rho in (0, 1] on the amplitude of the specular reflection. It is 1 for a smooth surface
/// and at grazing. For large g Ament's factor underflows to 0, and that of Miller and Brown falls as
/// 1/(sqrt(pi) g). Nothing overflows.
template <typename R = double>
R roughness_factor(RoughnessModel model, const Given<R>& g);

/// Returns the share, 0 to 1, of the amplitude that a surface scatters which lies `deviation_m` (rms,
/// normally distributed) off the plane that stands for it: sqrt(1 - e^{-g^2}), g at normal incidence. What
/// Ament's factor leaves of the power goes on in the mirror direction, and the rest is scattered (P.
/// Beckmann, A. Spizzichino, "The Scattering of Electromagnetic Waves from Rough Surfaces", Pergamon, 1963).
/// The mirror direction would keep more at other angles, where g falls with the cosine: that is left out. 0
/// m: 1, for materials that do not say how far off they are.
double scattered_share(double deviation_m, double wavelength_m);
/// Returns the derivative of scattered_share() by the frequency, 1/Hz.
double scattered_share_slope(double deviation_m, double frequency_hz);

/// Returns the largest loss of a specular reflection by Ament's factor, which occurs at normal incidence, dB,
/// >= 0.
double most_roughness_db(double rms_height_m, double wavelength_m);

/// Returns e^{-x} I_0(x) for x >= 0, with a relative error of about 1e-15 (Abramowitz and Stegun, 9.6.12 and
/// 9.7.1).
template <typename R = double>
R scaled_bessel_i0(const Given<R>& x);

}  // namespace greatx::rf
