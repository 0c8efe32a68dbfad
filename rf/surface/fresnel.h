// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the reflection and transmission of plane waves by half-spaces and layered walls. The time
// convention is e^{+j omega t}, so that eta = eta' - j eta'' with eta'' >= 0. cos_theta is the cosine of the
// angle from the normal: 0 at grazing, 1 at normal incidence. The outside is vacuum.
//
// The signs follow ITU-R P.2040-4: r_TE refers to the field along s = k x n, and r_TM to the field along k x
// s, taken with the incident k before and the reflected k after the reflection. At normal incidence r_TE =
// -r_TM describes one and the same reflection.
//
// All functions are built for R = double and R = Dual.
#pragma once

#include <complex>
#include <span>

#include "core/dual.h"

namespace greatx::rf {

using Complex = std::complex<double>;

template <typename R>
struct ReflectionCoefficientsOf {
  ComplexOf<R> r_te{0.0}, r_tm{0.0};  ///< ratio of reflected to incident field at the outer face
};
using ReflectionCoefficients = ReflectionCoefficientsOf<double>;

template <typename R>
struct FresnelCoefficientsOf : ReflectionCoefficientsOf<R> {
  /// Ratio of transmitted to incident field: behind the face of a half-space, or behind the last layer.
  ComplexOf<R> t_te{0.0}, t_tm{0.0};
};
using FresnelCoefficients = FresnelCoefficientsOf<double>;

template <typename R>
struct DielectricLayerOf {
  ComplexOf<R> eta{1.0};
  R thickness_m = 0.0;
};
using DielectricLayer = DielectricLayerOf<double>;

/// Returns A = sqrt(eta - 1 + C^2) with Im A <= 0 (P.2040-4, 2.2.1): the normal component of the wave vector
/// inside the medium, over k_0.
template <typename R = double>
ComplexOf<R> normal_component(const ComplexOf<R>& eta, const Given<R>& cos_theta);

/// Returns the coefficients of one face of a medium that fills the space behind it (P.2040-4, 2.2.1):
///   r_TE = (C - A)/(C + A), r_TM = (eta C - A)/(eta C + A),
///   t_TE = 2C/(C + A), t_TM = 2 sqrt(eta) C/(eta C + A).
/// They are evaluated without cancellation, so that r keeps its relative accuracy as eta -> 1 and at grazing:
///   r_TE = -(eta - 1)/(C + A)^2, r_TM = (eta - 1)((eta + 1)C^2 - 1)/(eta C + A)^2.
/// At cos_theta = 0 the result is r = -1, t = 0. For eta = 1 it is r = 0, t = 1.
template <typename R = double>
FresnelCoefficientsOf<R> half_space(const ComplexOf<R>& eta, const Given<R>& cos_theta);
/// Returns the reflection of half_space() alone, to the last bit.
template <typename R = double>
ReflectionCoefficientsOf<R> half_space_reflection(const ComplexOf<R>& eta, const Given<R>& cos_theta);

/// Returns the coefficients of a slab with vacuum on both sides (P.2040-4, 2.2.2, eq. 43 and 44), with q = 2
/// pi d A / lambda:
///   R = r(1 - e^{-2jq})/(1 - r^2 e^{-2jq}), T = (1 - r^2)e^{-jq}/(1 - r^2 e^{-2jq}).
/// T is the field at the rear face over the field at the front face, both at the foot of the same normal.
template <typename R = double>
FresnelCoefficientsOf<R> slab(const DielectricLayerOf<Given<R>>& layer, const Given<R>& wavelength_m,
                              const Given<R>& cos_theta);
/// Returns the reflection of slab() alone, to the last bit.
template <typename R = double>
ReflectionCoefficientsOf<R> slab_reflection(const DielectricLayerOf<Given<R>>& layer,
                                            const Given<R>& wavelength_m, const Given<R>& cos_theta);

/// Returns the coefficients of any number of layers, the outermost first, with vacuum behind them (P.2040-4,
/// 2.2.2 and Attachment 1). The transfer-matrix recursion divides each matrix by its growing exponential: a
/// thick lossy layer underflows, and nothing overflows. A last layer of thickness 0 is the half-space behind
/// the other layers; t is then the field at the face of this half-space.
template <typename R = double>
FresnelCoefficientsOf<R> multilayer(std::span<const DielectricLayerOf<Given<R>>> layers,
                                    const Given<R>& wavelength_m, const Given<R>& cos_theta);

/// Returns the factor that turns `t` of a wall of thickness d into that of a sheet without geometric
/// thickness. The length of the path already includes the phase e^{-jk d C} once (P.2040-4, 2.2.2). With this
/// factor a slab of vacuum is invisible.
template <typename R = double>
ComplexOf<R> sheet_phase(const Given<R>& thickness_m, const Given<R>& wavelength_m,
                         const Given<R>& cos_theta);

}  // namespace greatx::rf
