// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes what an edge sends back beyond physical optics: the field of the fringe currents of a conducting
// wedge, by the physical theory of diffraction (P. Ya. Ufimtsev, "Fundamentals of the Physical Theory of
// Diffraction", 2nd ed., Wiley 2014, chapters 2 to 4, the functions f and g and their parts of physical
// optics).
#pragma once

#include <vector>

#include "core/vec.h"
#include "rf/antenna/field_vector.h"

namespace greatx::rf {

/// Holds f - f0 and g - g0: the field of the fringe currents at the distance r of an edge of length dl, for
/// an incident field of 1, is dl/(2 pi r) e^{-jkr} times `soft` for the electric field along the edge and
/// times `hard` for the magnetic field along the edge.
struct Fringe {
  double soft = 0.0, hard = 0.0;
};

/// Returns the coefficients of a wedge whose exterior is n pi wide, 1 < n <= 2, for incidence from the angle
/// `incident` and observation at `observed`, both from face 0 and within [0, n pi]. They are finite
/// everywhere; within 1e-3 rad of a boundary of the shadow or of a reflection, where f and f0 are infinite,
/// they are the mean of the values 1e-3 rad beside it.
Fringe fringe(double n, double incident, double observed);

/// Holds the points from which the phase along a line is counted: place along the line, and distance from it.
struct PhaseLine {
  dvec2 source{0.0}, receiver{0.0};
  double wavenumber = 0.0;  ///< k, rad/m

  double slope(double x) const;   ///< derivative of the phase -k(r1 + r2), rad/m
  double bend(double x) const;    ///< second derivative, rad/m^2
  double length(double x) const;  ///< r1 + r2
};

/// A contribution adds value * e^{-jk length(at)} to the integral of e^{-jk(r1 + r2)} along a line.
struct LineContribution {
  double at = 0.0;
  Complex value;
};

/// Appends the contributions of [from, to]: of the ends where the phase is far from stationary, and else of
/// stretches on which it deviates from a linear one by less than 0.1 rad.
void integrate(const PhaseLine& line, double from, double to, std::vector<LineContribution>& out);

}  // namespace greatx::rf
