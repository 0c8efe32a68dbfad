// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Differentiates the field that an antenna element radiates, by its direction, by a turn of the antenna and
// by the slant of its polarization.
#pragma once

#include <array>
#include <span>

#include "rf/antenna/element.h"

namespace greatx::rf {

/// Holds the field of one polarization towards a direction, and its derivatives. All of them are resolved on
/// the world's (theta, phi) at the direction, and the turn of this basis is part of the derivatives.
struct FieldSlopes {
  Jones field;
  /// A change dk of the unit direction k, perpendicular to k, changes the field by the sum of
  /// by_direction[x] dk_x over x, y and z.
  std::array<Jones, 3> by_direction;
  /// A small turn by the vector w (rad, world axes) after the orientation changes it by the sum of
  /// by_attitude[x] w_x.
  std::array<Jones, 3> by_attitude;
  Jones by_slant;  ///< per rad
};

/// Evaluates what TurnedElement evaluates, with derivatives in closed form:
/// - A pattern is differentiated by the angles (theta, phi) of its own frame. TR 38.901's element has a bend
///   where its attenuation reaches 30 dB, and a table has one at each of its grid lines. There the derivative
///   is that of one side.
/// - The angle psi between both bases (TR 38.901, eq. 7.1-15) has the differential
///       d psi = w . k + cos(theta') d phi' - cos(theta) d phi,
///   with primes for the antenna's frame: a basis (theta, phi) turns by cos(theta) d phi about its direction.
/// - On the z axis of a frame phi has no derivative. The basis is then carried along without turning. The
///   transfer of a path does the same (rf/gradient/path_slopes.h), so that their product is right. Where the
///   antenna itself is singular (a dipole along its axis, an isotropic element at its own poles), the
///   derivative by theta' alone is taken.
class ElementSlopes {
 public:
  /// Arguments as for TurnedElement.
  ElementSlopes(ElementPattern pattern, std::span<const double> slants, const dquat& orientation);

  /// Computes the field and its derivatives for each slant at a unit direction of the world. `out` must have
  /// room for all polarizations.
  void at(const dvec3& world_direction, std::span<FieldSlopes> out) const;
  size_t polarization_count() const { return count_; }

 private:
  ElementPattern pattern_;
  std::array<dvec2, 2> slants_;  ///< (cos, sin)
  size_t count_;
  dmat3 world_from_antenna_;
};

}  // namespace greatx::rf
