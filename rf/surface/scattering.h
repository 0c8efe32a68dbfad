// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Diffuse scattering by the effective-roughness model: V. Degli-Esposti, F. Fuschini, E. M. Vitucci, G.
// Falciasecca, "Measurement and modelling of scattering from buildings", IEEE Trans. Antennas Propag. 55(1),
// 2007.
#pragma once

#include <cstdint>
#include <string>

#include "core/vec.h"
#include "rf/antenna/field_vector.h"
#include "scene/material/material.h"

namespace greatx::rf {

/// How a surface scatters.
struct DiffuseScattering {
  double coefficient =
      0.0;  ///< S: amplitude of what is scattered over that of what would be reflected, 0 to 1
  scene::ScatteringPattern pattern = scene::ScatteringPattern::lambertian;
  uint32_t exponent = 4;              ///< alpha_R of the lobe about the specular direction
  uint32_t backscatter_exponent = 4;  ///< alpha_I of the lobe back to where the wave comes from
  double backscatter_share = 0.5;     ///< 1 - Lambda
  double cross_polarization = 0.0;    ///< K_x: share of the scattered power in the other polarization, 0 to 1
};

/// Throws UserError naming the material where a value lies outside its range or an exponent is no whole
/// number from 1 to 100.
DiffuseScattering diffuse_scattering(const scene::RadioMaterial& material, const std::string& material_name);

/// F_alpha(theta_i), the integral of ((1 + cos psi)/2)^alpha over the hemisphere, psi counted from the
/// specular direction (or, which is the same by symmetry, from the direction back to the source), sr:
/// 2^-alpha sum_k C(alpha, k) I_k, I_k = 2 pi/(k + 1) for even k, times cos(theta_i) sum_{w <= (k-1)/2} C(2w,
/// w) (sin(theta_i)/2)^{2w} for odd ones.
double lobe_normalisation(uint32_t exponent, double cos_incidence);

/// f_s, the share of the scattered power in a direction, 1/sr; its integral over the hemisphere is 1. Unit
/// vectors: `in` the wave's direction, `out` the scattered one's, `normal` on the side that the wave comes
/// from (in . normal <= 0).
/// - lambertian: cos(theta_s)/pi;
/// - directive: ((1 + cos psi_R)/2)^alpha_R / F_alpha_R, psi_R from the specular direction;
/// - backscattering: (Lambda ((1 + cos psi_R)/2)^alpha_R + (1 - Lambda)((1 + cos psi_I)/2)^alpha_I)
///   / (Lambda F_alpha_R + (1 - Lambda) F_alpha_I), psi_I from -in.
/// 0 on the far side of the surface and along it: nothing is scattered through.
double scattering_pattern(const DiffuseScattering& surface, const dvec3& in, const dvec3& out,
                          const dvec3& normal);

/// The field that a patch sends out, over the incident field's components along s and p, but for S, the
/// pattern and the distance: a unitary matrix, so that the patch keeps the power of any incident polarization
/// exactly.
///   [along s_out]   [ sqrt(1 - K) e^{ja}    sqrt(K) e^{jc}     ] [along s_in]
///   [along p_out] = [ sqrt(K) e^{jd}        sqrt(1 - K) e^{jb} ] [along p_in],   d = a + b - c + pi
/// a, b, c are independent and uniform over a turn: a pure function of (seed, facet, patch).
struct ScatteringMatrix {
  Complex ss, sp, ps, pp;  ///< [out in]
};
ScatteringMatrix scattering_matrix(double cross_polarization, uint64_t seed, uint32_t facet, uint32_t patch);

}  // namespace greatx::rf
