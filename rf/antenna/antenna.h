// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Antennas and planar arrays. Field patterns are in the spherical basis (theta, phi) of the antenna's own frame:
// zenith theta from +z, azimuth phi = atan2(y, x) (3GPP TR 38.901, section 7.1).
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace greatx::rf {

using Complex = std::complex<double>;

/// (F_theta, F_phi): amplitude gains, |F|^2 = power gain.
struct Jones {
  Complex theta{0.0}, phi{0.0};
};

enum class Pattern : uint32_t { isotropic, half_wave_dipole };
/// v: slant 0; h: slant 90 degrees; vh: both; slant: +45 and -45 degrees (TR 38.901, 7.3.2, polarization model 2).
enum class Polarization : uint32_t { v, h, vh, slant };

/// Port p = (row * columns + column) * polarizations + polarization. Elements lie in the array's y-z plane, rows along
/// +z, columns along +y, centred on the array's origin; boresight is +x.
struct AntennaArray {
  Pattern pattern = Pattern::isotropic;
  Polarization polarization = Polarization::v;
  uint32_t rows = 1, columns = 1;
  double row_spacing_m = 0.0, column_spacing_m = 0.0;

  uint32_t polarization_count() const;
  uint32_t port_count() const { return rows * columns * polarization_count(); }
  /// Position of the element of `port` in the array's frame, metres.
  dvec3 element_position(uint32_t port) const;
  /// Slant angle of `port`, rad.
  double slant(uint32_t port) const;
};

/// theta = atan2(hypot(x, y), z), phi = atan2(y, x); phi = 0 on the z axis. `direction` need not be a unit vector.
dvec2 theta_phi(const dvec3& direction);
/// The unit vectors theta-hat and phi-hat at a direction; at the poles the limit along phi = 0.
dvec3 theta_hat(const dvec3& direction);
dvec3 phi_hat(const dvec3& direction);

/// Field pattern of one element with polarization slant `slant` towards `direction` in the antenna's frame, resolved on
/// that frame's (theta, phi). Isotropic: (cos slant, sin slant) exactly; half-wave dipole along z: amplitude
/// sqrt(1.6409223770) cos(pi/2 cos theta) / sin theta, zero at the poles.
Jones element_field(Pattern pattern, double slant, const dvec3& direction);

/// The same in the world: the antenna is turned by `orientation` (world_from_antenna), the field resolved on the world's
/// (theta, phi) at the world direction (TR 38.901, eq. 7.1-11).
Jones element_field(Pattern pattern, double slant, const dquat& orientation, const dvec3& world_direction);

}  // namespace greatx::rf
