// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The phase integral of physical optics over a piece of a plane, I = integral of e^{-jk(r1 + r2)} dA, r1 and r2 the distances
// from a source (or its image) and from a receiver: in closed form, as contributions that each have a place.
//
// Three forms, by what the phase does on the piece:
//   area    it is linear but for less than `bend` rad: W. B. Gordon, "Far-field approximations to the Kirchhoff-Helmholtz
//           representations of scattered fields", IEEE Trans. Antennas Propag. 23(4), 1975: a sum over the sides, by its
//           series where the gradient vanishes; times the mean of e^{j quadratic part} to first order in it. One place.
//   border  nowhere near stationary: with V = grad(phase)/|grad(phase)|^2, the divergence theorem turns I into
//           -j closed integral of V . n (1 + j div V) e^{j phase} ds, whose next term is smaller by (curvature/gradient^2)^2.
//           Each side in the same way becomes two corners, or, where the phase is stationary along it, a stretch of it. What
//           two pieces share cancels exactly: a smooth wall sends back nothing but from its glint, its edges and corners.
//   split   else: two halves, each anew.
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/antenna/field_vector.h"
#include "rf/radar/echoes/polygon.h"

namespace greatx::rf {

/// A plane with coordinates, and the two points that phases are counted from, in those: (x, y, height).
struct PhasePlane {
  dvec3 source{0.0}, receiver{0.0};
  double wavenumber = 0.0;  ///< k, rad/m

  double length(const dvec2& p) const;   ///< r1 + r2
  dvec2 gradient(const dvec2& p) const;  ///< of the phase -k(r1 + r2), rad/m
  /// Second derivatives of the phase: (xx, xy, yy), rad/m^2.
  dvec3 curvature(const dvec2& p) const;
  /// A bound of their norm on all points within `reach` of `p`.
  double curvature_bound(const dvec2& p, double reach) const;
};

/// value * e^{-jk length(at)} is what it adds to I.
struct Contribution {
  dvec2 at{0.0};
  Complex value{0.0};
  bool border = false;  ///< from a side or a corner
};

struct IntegralLimits {
  double bend = 0.1;         ///< rad
  double stationary = 20.0;  ///< gradient^2 over curvature from which a piece counts as far from stationary
  double floor = 0.0;        ///< of a border's contribution, m^2
};

enum class IntegralForm : uint8_t { area, border, split };
IntegralForm integral_form(const PhasePlane& plane, const Polygon& piece, const IntegralLimits& limits = {});

/// Appends the contributions. `omitted`: bit i set: side i of the piece is left out of the border form (its other side is
/// known to cancel it, or it is no edge but where the field of view ends). Contributions of the border that are smaller than
/// `limits.floor` are not appended; returns how many there were.
uint64_t integrate(const PhasePlane& plane, const Polygon& piece, uint32_t omitted,
                   std::vector<Contribution>& out, const IntegralLimits& limits = {});

/// Gordon's integral of e^{j gradient . (x - centroid)} over a polygon.
Complex linear_phase_integral(const Polygon& piece, const dvec2& centroid, const dvec2& gradient);

}  // namespace greatx::rf
