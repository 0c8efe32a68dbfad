// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Diffraction coefficients of a straight wedge: the uniform theory of diffraction (R. G. Kouyoumjian, P. H.
// Pathak, "A uniform geometrical theory of diffraction for an edge in a perfectly conducting surface", Proc.
// IEEE 62(11), 1974), with R. J. Luebbers' reflection coefficients for walls that are no conductors ("Finite
// conductivity uniform GTD versus knife edge diffraction in prediction of propagation path loss", IEEE Trans.
// AP-32(1), 1984; also Rec. ITU-R P.526, "Finitely conducting wedge obstacle").
//
// Time convention e^{+j omega t}. Angles phi about the edge are measured from face 0 (phi = 0) through the
// exterior to face n (phi = n pi); phi' is the source's, phi the observer's.
#pragma once

#include <complex>

#include "core/vec.h"

namespace greatx::rf {

using Complex = std::complex<double>;

/// erfcx(e^{j pi/4} w) = e^{j w^2} erfc(e^{j pi/4} w), w >= 0; 1 at w = 0. Relative error below 1e-15 for
/// every w (the midpoint rule of D. B. Hunter, T. Regan, Math. Comp. 26, 1972: 12 nodes and the residue of
/// its pole).
Complex erfcx_on_diagonal(double w);

/// Kouyoumjian and Pathak's transition function F(x) = 2j sqrt(x) e^{jx} int_{sqrt(x)}^inf e^{-j t^2} dt, x
/// >= 0 = sqrt(pi x) e^{j pi/4} erfcx(e^{j pi/4} sqrt(x)).
Complex transition_function(double x);

/// The four terms of the coefficient, each with the boundary where it makes up for what geometrical optics
/// loses.
enum class UtdTerm : uint32_t {
  shadow_n = 0,      ///< D1, phi - phi' + pi: shadow behind face n
  shadow_0 = 1,      ///< D2, phi - phi' - pi: shadow behind face 0
  reflection_n = 2,  ///< D3, phi + phi' + pi: end of the reflection in face n, at (2n - 1) pi
  reflection_0 = 3,  ///< D4, phi + phi' - pi: end of the reflection in face 0, at pi
};

/// Where source and observer are, seen from the edge.
struct UtdAngles {
  double n = 2.0;         ///< the exterior is n pi wide, 1 < n <= 2
  double incident = 0.0;  ///< phi', in [0, n pi]
  double observed = 0.0;  ///< phi, in [0, n pi]
  /// By UtdTerm: delta = phi -+ phi' +- pi - 2 n pi N, |delta| <= n pi: how far past that boundary the
  /// observer is.
  double delta[4]{};

  /// Is the source hidden behind the wedge? On the boundary: no.
  bool in_shadow() const;
};
/// From angles. Near a boundary delta is good to the rounding of phi and phi', some 1e-15.
UtdAngles utd_angles(double n, double incident, double observed);
/// From directions across the edge, seen from it, in (tangent_0, normal_0); any length above 0. Near a
/// boundary delta is the atan2 between the observer and the boundary's own direction: exactly 0 where the
/// boundary is met exactly.
UtdAngles utd_angles(double n, const dvec2& source, const dvec2& observer);

/// The terms without dimension: d_i = D_i sin(beta_0) / sqrt(L), by UtdTerm, before any reflection
/// coefficient:
///   d = -+ (1/2) sgn(delta) |sinc(delta/2)| (y cot y)|_{y = delta/2n} erfcx(e^{j pi/4} w),
///   w = sqrt(2 k L) |sin(delta/2)|,
/// the product cot(.) F(.) with its pole taken out. -+ 1/2 on the boundaries, where the observer is taken to
/// be on the lit side (the geometrical field is counted there: facets are closed). kL = 0 is allowed. Error
/// 2e-15.
struct UtdTerms {
  Complex d[4];
  Complex operator[](UtdTerm term) const { return d[static_cast<uint32_t>(term)]; }
};
/// `distance_m`: L = s s' sin^2(beta_0) / (s + s') for a spherical wave, s sin^2(beta_0) for a plane one.
UtdTerms utd_terms(const UtdAngles& angles, double wave_number, double distance_m);

/// Something for each polarization: soft, E along the edge's plane with the ray (beta_0; TE on the faces when
/// beta_0 = 90 degrees), and hard (phi; TM).
struct SoftHard {
  Complex soft{0.0}, hard{0.0};
};
inline constexpr SoftHard conductor_reflection{-1.0, 1.0};

/// D_{s,h} = D1 + D2 + R_n D3 + R_0 D4 in sqrt(m) (Luebbers; R = -+1: Kouyoumjian and Pathak's eq. 25). The
/// diffracted field is D A(s', s) e^{-jks} times the incident one at the edge, A = sqrt(s'/(s (s + s'))) for
/// a spherical wave, 1/sqrt(s) for a plane one. sin(beta_0) must not be 0: the field itself is finite there,
/// D is not.
SoftHard utd_coefficients(const UtdAngles& angles, double wave_number, double distance_m, double sin_beta0,
                          const SoftHard& reflection_0, const SoftHard& reflection_n);

/// At which angle each face's reflection coefficient is taken. The face nearer to the source: at the source's
/// angle. The other one: where its reflection would leave for the observer (Luebbers: R_0 at phi', R_n at n
/// pi - phi), and at normal incidence for observers beyond that, which its reflection reaches for no such
/// source: there Luebbers' angle would come back to grazing in the face's extended plane. Angles of incidence
/// about the edge, each from its own face, in [0, pi]; the angle with the face's normal has cos = sin(beta_0)
/// sin(angle). Not reciprocal; it does not matter which face is called 0 (a source half-way between both
/// faces counts as near the one that the observer is farther from).
struct FaceAngles {
  double face_0 = 0.0, face_n = 0.0;
};
FaceAngles luebbers_angles(const UtdAngles& angles);

}  // namespace greatx::rf
