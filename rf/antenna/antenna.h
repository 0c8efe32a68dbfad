// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes antennas as arrays of equal elements.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/antenna/element.h"

namespace greatx::rf {

/// Polarizations of an element. v: slant 0; h: slant 90 degrees; vh: both; slant: +45 and -45 degrees;
/// single: one slant, AntennaArray::single_slant.
enum class Polarization : uint32_t { v, h, vh, slant, single };
/// The plane of an array's rows and columns. yz: rows follow +z and columns +y, so that the array faces
/// boresight (+x); xz: rows follow +z and columns +x; xy: rows follow +y and columns +x. The elements face +x
/// in every plane.
enum class ArrayPlane : uint32_t { yz, xz, xy };

/// Holds equal elements that all face the same way. They form rows and columns of a plane, centred on the
/// array's origin, or stand at `positions_m`. Port p = element * polarizations + polarization; in rows and
/// columns, element = row * columns + column.
struct AntennaArray {
  ElementPattern pattern;
  Polarization polarization = Polarization::v;
  double single_slant = 0.0;  ///< slant of Polarization::single, rad
  ArrayPlane plane = ArrayPlane::yz;
  uint32_t rows = 1, columns = 1;
  double row_spacing_m = 0.0, column_spacing_m = 0.0;
  /// Positions of the elements in the array's frame, metres, not centred. If the list is not empty, it
  /// replaces rows and columns.
  std::vector<dvec3> positions_m;

  uint32_t element_count() const {
    return positions_m.empty() ? rows * columns : static_cast<uint32_t>(positions_m.size());
  }
  uint32_t polarization_count() const;
  uint32_t port_count() const { return element_count() * polarization_count(); }
  /// Returns the position of the element of `port` in the array's frame, metres.
  dvec3 element_position(uint32_t port) const;
  /// Returns the slant angle of `port`, rad.
  double slant(uint32_t port) const;
  /// Returns one element with all its polarizations; `orientation` (world_from_array) turns the array.
  TurnedElement turned_element(const dquat& orientation) const;
  /// Returns the largest distance between two elements, metres: D of the far-field distance 2 D^2/lambda
  /// (IEEE Std 145). Returns 0 for one element, whose own size is unknown.
  double aperture() const;
  /// Returns the largest distance of an element from the array's origin, metres. The paths of the whole array
  /// end at the origin.
  double reach() const;
};

/// Returns the distance at which the far field of a link of two arrays begins, 2 (D_a + D_b)^2 / lambda,
/// metres (C. A. Balanis, Antenna Theory, 4th ed., 2.2.4, with the sum of the two apertures). D = 2
/// AntennaArray::reach() is the aperture of a centred array. Beyond this distance a spherical wave differs
/// from a plane wave by less than pi/8 at the arrays' edges. Returns 0 for single elements at their origins.
double far_field_distance_m(const AntennaArray& a, const AntennaArray& b, double carrier_hz);

}  // namespace greatx::rf
