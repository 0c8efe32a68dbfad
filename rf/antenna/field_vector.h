// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/vec.h"
#include "rf/antenna/antenna.h"
#include "rf/antenna/element.h"

namespace greatx::rf {

/// Holds a complex field vector.
struct FieldVector {
  dvec3 re{0.0}, im{0.0};
  Complex along(const dvec3& axis) const { return {glm::dot(re, axis), glm::dot(im, axis)}; }
  void add(Complex amplitude, const dvec3& axis) {
    re += amplitude.real() * axis;
    im += amplitude.imag() * axis;
  }
  void scale(Complex by) {
    const dvec3 real = by.real() * re - by.imag() * im;
    im = by.real() * im + by.imag() * re;
    re = real;
  }
};

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
