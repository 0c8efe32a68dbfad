// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Antennas: arrays of equal elements.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/antenna/element.h"

namespace greatx::rf {

/// v: slant 0; h: slant 90 degrees; vh: both; slant: +45 and -45 degrees; single: the array's own.
enum class Polarization : uint32_t { v, h, vh, slant, single };
/// Where rows and columns lie: yz: rows along +z, columns along +y (looks along boresight, +x); xz: rows
/// along +z, columns along +x; xy: rows along +y, columns along +x. The elements look along +x whatever the
/// plane.
enum class ArrayPlane : uint32_t { yz, xz, xy };

/// Equal elements in a plane's rows and columns, centred on the array's origin, or wherever `positions_m`
/// says. All look the same way. Port p = element * polarizations + polarization; in rows and columns, element
/// = row * columns + column.
struct AntennaArray {
  ElementPattern pattern;
  Polarization polarization = Polarization::v;
  double single_slant = 0.0;  ///< rad, of Polarization::single
  ArrayPlane plane = ArrayPlane::yz;
  uint32_t rows = 1, columns = 1;
  double row_spacing_m = 0.0, column_spacing_m = 0.0;
  /// Elements in the array's frame, metres, not centred; if there are any, they take the place of rows and
  /// columns.
  std::vector<dvec3> positions_m;

  uint32_t element_count() const {
    return positions_m.empty() ? rows * columns : static_cast<uint32_t>(positions_m.size());
  }
  uint32_t polarization_count() const;
  uint32_t port_count() const { return element_count() * polarization_count(); }
  /// Position of the element of `port` in the array's frame, metres.
  dvec3 element_position(uint32_t port) const;
  /// Slant angle of `port`, rad.
  double slant(uint32_t port) const;
  /// One element with all its polarizations, the array turned by `orientation` (world_from_array).
  TurnedElement turned_element(const dquat& orientation) const;
  /// The largest distance between two elements, metres: D of the far-field distance 2 D^2/lambda (IEEE Std
  /// 145). 0 for one element, whose own size is not known.
  double aperture() const;
  /// The largest distance of an element from the array's origin, where the paths of the whole array end,
  /// metres.
  double reach() const;
};

/// 2 (D_a + D_b)^2 / lambda, metres, D = 2 AntennaArray::reach(), the aperture of an array that is centred:
/// where the far field of a link of two arrays begins (C. A. Balanis, Antenna Theory, 4th ed., 2.2.4; for two
/// apertures their sum). Beyond it a spherical wave differs from a plane one by less than pi/8 at the arrays'
/// edges. 0 for single elements at their origins.
double far_field_distance_m(const AntennaArray& a, const AntennaArray& b, double carrier_hz);

}  // namespace greatx::rf
