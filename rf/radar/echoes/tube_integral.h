// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the phase integral of physical optics over a piece of a plane in closed form: I = integral of
// e^{-jk(r1 + r2)} dA, where r1 is the distance from a source (or its image) and r2 the distance from a
// receiver. The result is a set of contributions, each with a place.
//
// The behaviour of the phase on the piece selects one of three forms:
// - area: The phase deviates from a linear one by less than `bend` rad. The integral is the sum over the
//   sides by W. B. Gordon, "Far-field approximations to the Kirchhoff-Helmholtz representations of scattered
//   fields", IEEE Trans. Antennas Propag. 23(4), 1975, or its series where the gradient vanishes. It is
//   multiplied by the mean of e^{j quadratic part} to first order in the quadratic part. There is one
//   contribution.
// - border: The phase is nowhere near stationary. With V = grad(phase)/|grad(phase)|^2, the divergence
//   theorem turns I into -j closed integral of V . n (1 + j div V) e^{j phase} ds, whose next term is smaller
//   by (curvature/gradient^2)^2. In the same way each side becomes two corners, or, where the phase is
//   stationary along the side, a stretch of it. The contributions of a side that two pieces share cancel
//   exactly: a smooth wall sends back only its glint, its edges and its corners.
// - split: Otherwise the piece is halved, and each half is treated in the same way.
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/antenna/field_vector.h"
#include "rf/radar/echoes/polygon.h"

namespace greatx::rf {

/// Holds the two points from which the phase is counted, in the coordinates of a plane: (x, y, height).
struct PhasePlane {
  dvec3 source{0.0}, receiver{0.0};
  double wavenumber = 0.0;  ///< k, rad/m

  double length(const dvec2& p) const;   ///< r1 + r2
  dvec2 gradient(const dvec2& p) const;  ///< gradient of the phase -k(r1 + r2), rad/m
  /// Returns the second derivatives of the phase: (xx, xy, yy), rad/m^2.
  dvec3 curvature(const dvec2& p) const;
  /// Returns a bound on the norm of the second derivatives at all points within `reach` of `p`.
  double curvature_bound(const dvec2& p, double reach) const;
};

/// A contribution adds value * e^{-jk length(at)} to I.
struct Contribution {
  dvec2 at{0.0};
  Complex value{0.0};
  bool border = false;  ///< true for the contribution of a side or a corner
};

/// Holds the limits between the forms of the integral.
struct IntegralLimits {
  double bend = 0.1;  ///< largest deviation of the phase from a linear one in the area form, rad
  /// Ratio of gradient^2 to curvature from which a piece counts as far from a stationary point.
  double stationary = 20.0;
  double floor = 0.0;  ///< smallest border contribution that is kept, m^2
};

enum class IntegralForm : uint8_t { area, border, split };
IntegralForm integral_form(const PhasePlane& plane, const Polygon& piece, const IntegralLimits& limits = {});

/// Appends the contributions of `piece`. If bit i of `omitted` is set, the border form leaves side i out:
/// either a neighbouring piece cancels it, or it is the end of the field of view and no edge. Border
/// contributions smaller than `limits.floor` are not appended. Returns their number.
uint64_t integrate(const PhasePlane& plane, const Polygon& piece, uint32_t omitted,
                   std::vector<Contribution>& out, const IntegralLimits& limits = {});

/// Returns a bound on |I|: the area, or the sum over the sides that the divergence theorem leaves, whichever
/// is smaller. It holds to first order in curvature/gradient^2.
double most_of(const PhasePlane& plane, const Polygon& piece);

/// Returns Gordon's integral of e^{j gradient . (x - centroid)} over a polygon.
Complex linear_phase_integral(const Polygon& piece, const dvec2& centroid, const dvec2& gradient);

}  // namespace greatx::rf
