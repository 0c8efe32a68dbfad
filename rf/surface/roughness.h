// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace greatx::rf {

/// How a rough surface weakens its specular reflection. The two part for g > 1: at g = 2 by 7 dB, at g = 4 by
/// 53 dB.
enum class RoughnessModel : uint8_t {
  /// exp(-g^2/2), heights distributed normally (W. S. Ament, "Toward a theory of reflection by a rough
  /// surface", Proc. IRE 41, 1953).
  ament,
  /// exp(-g^2/2) I_0(g^2/2) (A. R. Miller, R. M. Brown, E. Vegh, "New derivation for the rough-surface
  /// reflection coefficient and for the distribution of sea-wave elevations", IEE Proc. H 131, 1984).
  miller_brown,
};

/// g = 4 pi sigma_h cos(theta) / lambda: the phase's standard deviation over the surface, rad. `cos_theta`
/// from the normal, `rms_height_m` >= 0.
double roughness_parameter(double rms_height_m, double cos_theta, double wavelength_m);

/// Factor rho in (0, 1] on the amplitude of the specular reflection; 1 on a smooth surface and at grazing.
/// For large g Ament's underflows to 0 and Miller and Brown's falls as 1/(sqrt(pi) g); nothing overflows.
double roughness_factor(RoughnessModel model, double g);

/// Most that a surface takes from a specular reflection by Ament's factor, at normal incidence, dB: >= 0.
double most_roughness_db(double rms_height_m, double wavelength_m);

/// e^{-x} I_0(x), x >= 0, to some 1e-15 of it (Abramowitz and Stegun, 9.6.12 and 9.7.1).
double scaled_bessel_i0(double x);

}  // namespace greatx::rf
