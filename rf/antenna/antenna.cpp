// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/antenna/antenna.h"

#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

/// Directivity of the half-wave dipole: 4 / Cin(2 pi), Balanis, "Antenna Theory", 4th ed., eq. 4-91.
constexpr double half_wave_directivity = 1.6409223770;

struct Angles {
  double cos_theta, sin_theta, cos_phi, sin_phi;
};

/// From the components, so that nothing is lost near the poles; phi = 0 on the z axis.
Angles angles(const dvec3& direction) {
  const double rho = std::hypot(direction.x, direction.y);
  const double length = std::hypot(rho, direction.z);
  GREATX_CHECK(length > 0.0 && std::isfinite(length), "direction ({}, {}, {}) has no angles", direction.x,
               direction.y, direction.z);
  if (rho == 0.0) return {direction.z > 0.0 ? 1.0 : -1.0, 0.0, 1.0, 0.0};
  return {direction.z / length, rho / length, direction.x / rho, direction.y / rho};
}

/// cos(pi/2 cos theta) / sin theta, as sin(pi/2 (1 - |cos theta|)) / sin theta with 1 - |c| = s^2 / (1 +
/// |c|).
double half_wave_amplitude(const Angles& at) {
  if (at.sin_theta == 0.0) return 0.0;
  const double versine = at.sin_theta * at.sin_theta / (1.0 + std::abs(at.cos_theta));
  return std::sqrt(half_wave_directivity) * std::sin(0.5 * pi * versine) / at.sin_theta;
}

}  // namespace

uint32_t AntennaArray::polarization_count() const {
  return polarization == Polarization::vh || polarization == Polarization::slant ? 2 : 1;
}

dvec3 AntennaArray::element_position(uint32_t port) const {
  GREATX_CHECK(port < port_count(), "port {} of {}", port, port_count());
  const uint32_t element = port / polarization_count();
  const double row = element / columns, column = element % columns;
  return {0.0, (column - 0.5 * (columns - 1.0)) * column_spacing_m,
          (row - 0.5 * (rows - 1.0)) * row_spacing_m};
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
  }
  GREATX_CHECK(false, "polarization {}", static_cast<uint32_t>(polarization));
}

dvec2 theta_phi(const dvec3& direction) {
  const double rho = std::hypot(direction.x, direction.y);
  return {std::atan2(rho, direction.z), rho == 0.0 ? 0.0 : std::atan2(direction.y, direction.x)};
}

dvec3 theta_hat(const dvec3& direction) {
  const Angles at = angles(direction);
  return {at.cos_theta * at.cos_phi, at.cos_theta * at.sin_phi, -at.sin_theta};
}

dvec3 phi_hat(const dvec3& direction) {
  const Angles at = angles(direction);
  return {-at.sin_phi, at.cos_phi, 0.0};
}

Jones element_field(Pattern pattern, double slant, const dvec3& direction) {
  // TR 38.901, 7.3.2, polarization model 2 (eq. 7.3-4, 7.3-5): the unslanted amplitude times (cos, sin) of
  // the slant.
  const double amplitude = pattern == Pattern::isotropic ? 1.0 : half_wave_amplitude(angles(direction));
  return {amplitude * std::cos(slant), amplitude * std::sin(slant)};
}

Jones element_field(Pattern pattern, double slant, const dquat& orientation, const dvec3& world_direction) {
  const dvec3 direction = glm::conjugate(orientation) * world_direction;
  const Jones own = element_field(pattern, slant, direction);
  const dvec3 own_theta = orientation * theta_hat(direction), own_phi = orientation * phi_hat(direction);
  const dvec3 theta = theta_hat(world_direction), phi = phi_hat(world_direction);
  return {glm::dot(theta, own_theta) * own.theta + glm::dot(theta, own_phi) * own.phi,
          glm::dot(phi, own_theta) * own.theta + glm::dot(phi, own_phi) * own.phi};
}

}  // namespace greatx::rf
