// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/vec.h"
#include "rf/antenna/antenna.h"
#include "rf/antenna/element.h"

namespace greatx::rf {

/// Holds a complex field vector.
template <typename R>
struct FieldVectorOf {
  using Vec3 = Vec3Of<R>;
  Vec3 re{dvec3(0.0)}, im{dvec3(0.0)};
  ComplexOf<R> along(const Vec3& axis) const { return {dot(re, axis), dot(im, axis)}; }
  void add(const ComplexOf<R>& amplitude, const Vec3& axis) {
    re += amplitude.real() * axis;
    im += amplitude.imag() * axis;
  }
  void scale(const ComplexOf<R>& by) {
    const Vec3 real = by.real() * re - by.imag() * im;
    im = by.real() * im + by.imag() * re;
    re = real;
  }
};
using FieldVector = FieldVectorOf<double>;

/// Returns the field of an element of one polarization towards a world direction.
inline FieldVector field_towards(const TurnedElement& element, const dvec3& direction) {
  Jones jones[1];
  const Angles at = angles_of(direction);
  element.respond(direction, jones);
  FieldVector field;
  field.add(jones[0].theta, at.theta_hat());
  field.add(jones[0].phi, at.phi_hat());
  return field;
}

}  // namespace greatx::rf
