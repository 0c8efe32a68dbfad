// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes diffuse scattering by the effective-roughness model: V. Degli-Esposti, F. Fuschini, E. M. Vitucci,
// G. Falciasecca, "Measurement and modelling of scattering from buildings", IEEE Trans. Antennas Propag.
// 55(1), 2007.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "core/dual.h"
#include "core/units.h"
#include "core/vec.h"
#include "rf/antenna/field_vector.h"
#include "scene/material/material.h"

namespace greatx::rf {

/// Describes how a surface scatters.
template <typename R>
struct DiffuseScatteringOf {
  /// S, 0 to 1: ratio of the scattered amplitude to that which a smooth surface would reflect.
  R coefficient = 0.0;
  scene::ScatteringPattern pattern = scene::ScatteringPattern::lambertian;
  uint32_t exponent = 4;              ///< alpha_R of the lobe around the specular direction
  uint32_t backscatter_exponent = 4;  ///< alpha_I of the lobe back towards the source
  R backscatter_share = 0.5;          ///< 1 - Lambda: share of the lobe back towards the source
  R cross_polarization = 0.0;         ///< K_x: share of the scattered power in the other polarization, 0 to 1
};
using DiffuseScattering = DiffuseScatteringOf<double>;

/// Returns the scattering parameters of a material. Throws UserError naming the material if a value lies
/// outside its range or an exponent is not a whole number from 1 to 100.
DiffuseScattering diffuse_scattering(const scene::RadioMaterial& material, const std::string& material_name);

/// Returns F_alpha(theta_i), the integral of ((1 + cos psi)/2)^alpha over the hemisphere, sr. psi is the
/// angle from the specular direction. By symmetry the integral is the same if psi is the angle from the
/// direction back to the source. The closed form is F_alpha = 2^-alpha sum_k C(alpha, k) I_k with
///   I_k = 2 pi/(k + 1)                                                                for even k,
///   I_k = 2 pi/(k + 1) cos(theta_i) sum_{w <= (k-1)/2} C(2w, w) (sin(theta_i)/2)^{2w} for odd k.
template <typename R = double>
R lobe_normalisation(uint32_t exponent, const Given<R>& cos_incidence);

/// Returns f_s, the share of the scattered power in a direction, 1/sr. Its integral over the hemisphere is 1.
/// All vectors are unit vectors: `in` is the direction of the wave, `out` the direction of scattering, and
/// `normal` points to the side from which the wave comes (in . normal <= 0).
/// - lambertian: cos(theta_s)/pi;
/// - directive: ((1 + cos psi_R)/2)^alpha_R / F_alpha_R, with psi_R from the specular direction;
/// - backscattering: (Lambda ((1 + cos psi_R)/2)^alpha_R + (1 - Lambda)((1 + cos psi_I)/2)^alpha_I)
///   / (Lambda F_alpha_R + (1 - Lambda) F_alpha_I), with psi_I from -in.
/// Returns 0 for directions along the surface and on its far side: nothing is scattered through it.
template <typename R = double>
R scattering_pattern(const DiffuseScatteringOf<Given<R>>& surface, const Vec3Of<R>& in, const Vec3Of<R>& out,
                     const dvec3& normal);

/// Returns the numerator of f_s: 1 for `lambertian`, the lobe or the weighted sum of both lobes for the
/// others. Returns 0 where f_s is 0. It is the same for a wave along -out that is scattered along -in.
double scattering_shape(const DiffuseScattering& surface, const dvec3& in, const dvec3& out,
                        const dvec3& normal);

/// Relates the components along s and p of the field that a patch scatters to those of the incident field,
/// without S, the pattern and the distance. The matrix is unitary, so that the patch keeps the power of any
/// incident polarization exactly.
///   [along s_out]   [ sqrt(1 - K) e^{ja}    sqrt(K) e^{jc}     ] [along s_in]
///   [along p_out] = [ sqrt(K) e^{jd}        sqrt(1 - K) e^{jb} ] [along p_in],   d = a + b - c + pi
/// The phases a, b, c are independent and uniform over a full turn. They are a pure function of (seed, facet,
/// patch).
template <typename R>
struct ScatteringMatrixOf {
  ComplexOf<R> ss, sp, ps, pp;  ///< [out in]: the first letter is the scattered component
};
using ScatteringMatrix = ScatteringMatrixOf<double>;
template <typename R = double>
ScatteringMatrixOf<R> scattering_matrix(const Given<R>& cross_polarization, uint64_t seed, uint32_t facet,
                                        uint32_t patch);

/// Returns the distance that stands for the one between two patches in 1/distance^2: the first one, which
/// sends, is a disk with its area, seen on its axis (J. R. Wallace, K. A. Elmquist, E. A. Haines, "A ray
/// tracing algorithm for progressive radiosity", SIGGRAPH 1989).
template <typename R = double>
R between_patches_m(const Given<R>& distance_m, double area_m2) {
  using std::sqrt;
  return sqrt(distance_m * distance_m + area_m2 / pi);
}

}  // namespace greatx::rf
