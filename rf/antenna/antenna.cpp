// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/antenna/antenna.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {

uint32_t AntennaArray::polarization_count() const {
  return polarization == Polarization::vh || polarization == Polarization::slant ? 2 : 1;
}

dvec3 AntennaArray::element_position(uint32_t port) const {
  GREATX_CHECK(port < port_count(), "port {} of {}", port, port_count());
  const uint32_t element = port / polarization_count();
  if (!positions_m.empty()) return positions_m[element];
  const double row = element / columns, column = element % columns;
  const double up = (row - 0.5 * (rows - 1.0)) * row_spacing_m;
  const double across = (column - 0.5 * (columns - 1.0)) * column_spacing_m;
  switch (plane) {
    case ArrayPlane::yz:
      return {0.0, across, up};
    case ArrayPlane::xz:
      return {across, 0.0, up};
    case ArrayPlane::xy:
      return {across, up, 0.0};
  }
  GREATX_CHECK(false, "plane {}", static_cast<uint32_t>(plane));
}

double AntennaArray::slant(uint32_t port) const {
  GREATX_CHECK(port < port_count(), "port {} of {}", port, port_count());
  const bool second = port % polarization_count() == 1;
  switch (polarization) {
    case Polarization::v:
      return 0.0;
    case Polarization::h:
      return 0.5 * pi;
    case Polarization::vh:
      return second ? 0.5 * pi : 0.0;
    case Polarization::slant:
      return second ? -0.25 * pi : 0.25 * pi;
    case Polarization::single:
      return single_slant;
  }
  GREATX_CHECK(false, "polarization {}", static_cast<uint32_t>(polarization));
}

TurnedElement AntennaArray::turned_element(const dquat& orientation) const {
  std::array<double, 2> slants{};
  for (uint32_t p = 0; p < polarization_count(); ++p) slants[p] = slant(p);
  return {pattern, {slants.data(), polarization_count()}, orientation};
}

double AntennaArray::aperture() const {
  if (positions_m.empty())
    return std::hypot((rows - 1.0) * row_spacing_m, (columns - 1.0) * column_spacing_m);
  double largest = 0.0;
  for (size_t i = 0; i < positions_m.size(); ++i)
    for (size_t j = 0; j < i; ++j) largest = std::max(largest, glm::distance(positions_m[i], positions_m[j]));
  return largest;
}

double AntennaArray::reach() const {
  if (positions_m.empty()) return 0.5 * aperture();
  double largest = 0.0;
  for (const dvec3& position : positions_m) largest = std::max(largest, glm::length(position));
  return largest;
}

double far_field_distance_m(const AntennaArray& a, const AntennaArray& b, double carrier_hz) {
  const double extent_m = 2.0 * (a.reach() + b.reach());
  return 2.0 * extent_m * extent_m * carrier_hz / speed_of_light;
}

}  // namespace greatx::rf
