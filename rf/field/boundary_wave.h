// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the boundary wave of a straight edge: the part of Kirchhoff's diffraction integral over a plane
// surface that one of its edges contributes.
//
// Kirchhoff's integral for a spherical wave over a surface with an outline is the ray of geometrical optics,
// if it passes through the outline, and a line integral along the outline (A. Rubinowicz, "Die Beugungswelle
// in der Kirchhoffschen Theorie der Beugungserscheinungen", Ann. Phys. 53, 1917; M. Born, E. Wolf,
// "Principles of Optics", 7th ed., 8.9). The reduction is exact. In units of the field of the ray, a piece of
// the outline contributes -E:
//
//   E = (D T/2 pi) int e^{-j k (L - D)} / (L^2 - D^2) dt/(r s),   L = r + s.
//
// S and R are the ends, D is their distance, r and s are the distances from S and from R to the point t of
// the edge, and T is the triple product e . ((S - t) x (R - t)), which is the same for every t of a straight
// edge. Two forms of the integral are computed; both follow from the definition by algebra:
//
// - Near the ray, with the angle phi about the ray as seen along it. The last integrand is smooth even where
//   the edge meets the ray, where the first one has a pole:
//     2 pi E = phi(t_2) - phi(t_1)
//              + int (D T/(r s)) [(e^{-jk(L-D)} - 1)/(L^2 - D^2) - 1/(D^2 - (r - s)^2)] dt.
// - Far from the ray, with L itself as the variable. r and s are no longer needed, because
//     dt/(r s) = 2 dL / sqrt((L^2 - L*^2)(L^2 - B^2)),
//   where L* is the least L on the edge's line and B^2 = h^2 + (d_S - d_R)^2, for the distances d of the ends
//   from the line and their distance h along it. The integrand is an analytic function of L - L* = zeta^2,
//   and the path of integration is turned to where it decays. Its singularities are at L = D, B and below, B
//   <= D <= L*, so that nothing is near the path where k (L - D) is large.
#pragma once

#include <complex>

#include "core/dual.h"
#include "core/vec.h"

namespace greatx::rf {

using Complex = std::complex<double>;

/// Describes a ray from S to R by a point on it.
template <typename Real>
struct UnfoldedRayOf {
  Vec3Of<Real> direction{dvec3(0.0)};  ///< unit, from S to R
  Real before_m = 0.0, after_m = 0.0;  ///< distances of S and of R from the point, > 0
  Real length_m() const { return before_m + after_m; }
};
using UnfoldedRay = UnfoldedRayOf<double>;

/// A straight edge, or a part of its line, relative to the ray's point.
template <typename Real>
struct EdgePieceOf {
  Vec3Of<Real> start{dvec3(0.0)};  ///< from the ray's point to the place t = 0 of the edge
  dvec3 along{0.0};                ///< unit
  double from = 0.0, to = 0.0;     ///< range of t, metres; may be infinite
};
using EdgePiece = EdgePieceOf<double>;

/// Returns E of the piece, for a surface on whose side of the edge the ray passes; for a ray that passes
/// on the other side the contribution is -E. It is 1/2 as an endless edge approaches the ray, and tends to
/// 1/(2 sqrt(pi k (L* - D))) far from the ray. The ends are at least half a wavelength from the edge: nearer,
/// physical optics means nothing. The absolute error is below 1e-8 (`BoundaryWave.*`), and below 1e-10 of the
/// integral of the modulus for a piece along which k L changes by less than 12.
template <typename Real = double>
ComplexOf<Real> boundary_wave(const UnfoldedRayOf<Given<Real>>& ray, const EdgePieceOf<Given<Real>>& piece,
                              const Given<Real>& wave_number);

/// Returns the place t of the edge's line where the path from S to R over the line is shortest (Keller's
/// point).
template <typename Real = double>
Real keller_place(const UnfoldedRayOf<Given<Real>>& ray, const EdgePieceOf<Given<Real>>& piece);

/// Returns L - D at the place t, without cancellation, metres.
template <typename Real = double>
Real excess_m(const UnfoldedRayOf<Given<Real>>& ray, const EdgePieceOf<Given<Real>>& piece,
              const Given<Real>& t);

}  // namespace greatx::rf
