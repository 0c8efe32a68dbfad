// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the diffraction coefficients of a straight wedge by the uniform theory of diffraction (R. G.
// Kouyoumjian, P. H. Pathak, "A uniform geometrical theory of diffraction for an edge in a perfectly
// conducting surface", Proc. IEEE 62(11), 1974). For walls that are not conductors it uses the reflection
// coefficients of R. J. Luebbers ("Finite conductivity uniform GTD versus knife edge diffraction in
// prediction of propagation path loss", IEEE Trans. AP-32(1), 1984; also Rec. ITU-R P.526, "Finitely
// conducting wedge obstacle").
//
// The time convention is e^{+j omega t}. Angles phi about the edge are measured from face 0 (phi = 0) through
// the exterior to face n (phi = n pi). phi' is the angle of the source, phi the angle of the observer.
#pragma once

#include <complex>

#include "core/dual.h"
#include "core/vec.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Returns erfcx(e^{j pi/4} w) = e^{j w^2} erfc(e^{j pi/4} w) for w >= 0; 1 at w = 0. The relative error is
/// below 1e-15 for every w (the midpoint rule of D. B. Hunter, T. Regan, Math. Comp. 26, 1972, with 12 nodes
/// and the residue of its pole).
template <typename R = double>
ComplexOf<R> erfcx_on_diagonal(const Given<R>& w);
template <>
Complex erfcx_on_diagonal<double>(const double& w);
template <>
DualComplex erfcx_on_diagonal<Dual>(const Dual& w);

/// Names the four terms of the coefficient. Each belongs to a boundary, where it compensates the jump of
/// geometrical optics.
enum class UtdTerm : uint32_t {
  shadow_n = 0,      ///< D1, phi - phi' + pi: shadow behind face n
  shadow_0 = 1,      ///< D2, phi - phi' - pi: shadow behind face 0
  reflection_n = 2,  ///< D3, phi + phi' + pi: end of the reflection in face n, at (2n - 1) pi
  reflection_0 = 3,  ///< D4, phi + phi' - pi: end of the reflection in face 0, at pi
};

/// Holds the angles of source and observer about the edge.
template <typename R>
struct UtdAnglesOf {
  double n = 2.0;    ///< the exterior is n pi wide, 1 < n <= 2
  R incident = 0.0;  ///< phi', in [0, n pi]
  R observed = 0.0;  ///< phi, in [0, n pi]
  /// How far the observer is past the boundary of each UtdTerm: delta = phi -+ phi' +- pi - 2 n pi N, |delta|
  /// <= n pi.
  R delta[4]{};

  /// Tells whether the wedge hides the source. On the boundary the source is not hidden.
  bool in_shadow() const;
};
using UtdAngles = UtdAnglesOf<double>;
/// Returns the angles for given phi' and phi. Near a boundary delta is accurate to the rounding of phi and
/// phi', about 1e-15.
template <typename R = double>
UtdAnglesOf<R> utd_angles(double n, const Given<R>& incident, const Given<R>& observed);
/// Returns the angles for directions across the edge, as seen from the edge, in (tangent_0, normal_0), of any
/// length above 0. Near a boundary delta is the atan2 between the observer and the boundary's own direction:
/// exactly 0 if the observer is exactly on the boundary.
template <typename R = double>
UtdAnglesOf<R> utd_angles(double n, const Vec2Of<R>& source, const Vec2Of<R>& observer);

/// Holds one term as d = amplitude erfcx(e^{j pi/4} sqrt(2 k L) half_sine).
template <typename R>
struct UtdFactorOf {
  R amplitude = 0.0;  ///< -+ (1/2) sgn(delta) |sinc(delta/2)| (y cot y)|_{y = delta/2n}
  R half_sine = 0.0;  ///< |sin(delta/2)|
  bool lit = true;    ///< the observer is on the lit side of the term's boundary
};
using UtdFactor = UtdFactorOf<double>;
template <typename R>
struct UtdFactorsOf {
  UtdFactorOf<R> factors[4];
  const UtdFactorOf<R>& operator[](UtdTerm term) const { return factors[static_cast<uint32_t>(term)]; }
};
using UtdFactors = UtdFactorsOf<double>;
/// Returns d. `distance_m` is L of utd_terms().
template <typename R = double>
ComplexOf<R> utd_value(const UtdFactorOf<Given<R>>& factor, const Given<R>& wave_number,
                       const Given<R>& distance_m);
/// Near a boundary, `sides` may say on which side of it the observer counts.
template <typename R = double>
UtdFactorsOf<R> utd_factors(const UtdAnglesOf<Given<R>>& angles, const EdgeSides& sides = {});

/// Tells whether an observer goes deeper into the shadow of a term's boundary as phi grows (else as phi
/// falls).
constexpr bool darkens_with_observer(UtdTerm term) {
  return term == UtdTerm::shadow_0 || term == UtdTerm::reflection_0;
}
/// Does the same for the source and phi'.
constexpr bool darkens_with_source(UtdTerm term) {
  return term == UtdTerm::shadow_n || term == UtdTerm::reflection_0;
}

/// Holds the dimensionless terms d_i = D_i sin(beta_0) / sqrt(L), by UtdTerm, before any reflection
/// coefficient:
///   d = -+ (1/2) sgn(delta) |sinc(delta/2)| (y cot y)|_{y = delta/2n} erfcx(e^{j pi/4} w),
///   w = sqrt(2 k L) |sin(delta/2)|.
/// This is the product cot(.) F(.) without its pole, where F(x) = sqrt(pi x) e^{j pi/4} erfcx(e^{j pi/4}
/// sqrt(x)) is Kouyoumjian and Pathak's transition function. On a boundary d is -+ 1/2: the observer counts
/// as on the lit side, because facets are closed and the geometrical field is counted there. Near a boundary,
/// `sides` may say on which side the observer counts. kL = 0 is allowed. The error is 2e-15.
struct UtdTerms {
  Complex d[4];
  Complex operator[](UtdTerm term) const { return d[static_cast<uint32_t>(term)]; }
};
/// Computes the terms. `distance_m`: L = s s' sin^2(beta_0) / (s + s') for a spherical wave, s sin^2(beta_0)
/// for a plane wave.
///
/// The coefficient is D_{s,h} = D1 + D2 + R_n D3 + R_0 D4 in sqrt(m) (Luebbers; R = -+1 gives Kouyoumjian and
/// Pathak's eq. 25). The diffracted field is D A(s', s) e^{-jks} times the incident field at the edge, with A
/// = sqrt(s'/(s (s + s'))) for a spherical wave and 1/sqrt(s) for a plane wave. Soft: E in the plane of the
/// edge and the ray (beta_0; TE on the faces if beta_0 = 90 degrees). Hard: E along phi (TM).
UtdTerms utd_terms(const UtdAngles& angles, double wave_number, double distance_m,
                   const EdgeSides& sides = {});

/// Holds the angles at which the faces' reflection coefficients are taken. The face nearer to the source
/// takes the angle of the source. The other face takes the angle at which its reflection would leave for the
/// observer (Luebbers: R_0 at phi', R_n at n pi - phi). Beyond normal incidence, where no such source has its
/// reflection, that face takes normal incidence; Luebbers' angle would return to grazing in the face's
/// extended plane there.
///
/// Both are angles of incidence about the edge, each from its own face, in [0, pi]. The angle with the face's
/// normal has the cosine sin(beta_0) sin(angle). The choice is not reciprocal. It does not depend on which
/// face is called 0: a source halfway between the faces counts as near the face that is farther from the
/// observer.
template <typename R>
struct FaceAnglesOf {
  R face_0 = 0.0, face_n = 0.0;
  bool near_0 = true;  ///< the source counts as near face 0
};
using FaceAngles = FaceAnglesOf<double>;
template <typename R = double>
FaceAnglesOf<R> luebbers_angles(const UtdAnglesOf<Given<R>>& angles);

}  // namespace greatx::rf
