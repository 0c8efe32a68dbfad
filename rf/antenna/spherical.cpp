// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/antenna/spherical.h"

#include <cmath>

#include "core/error.h"

namespace greatx::rf {

Angles angles_of(const dvec3& direction) {
  const double rho = std::hypot(direction.x, direction.y);
  const double length = std::hypot(rho, direction.z);
  GREATX_CHECK(length > 0.0 && std::isfinite(length), "direction ({}, {}, {}) has no angles", direction.x,
               direction.y, direction.z);
  if (rho == 0.0) return {direction.z > 0.0 ? 1.0 : -1.0, 0.0, 1.0, 0.0};
  return {direction.z / length, rho / length, direction.x / rho, direction.y / rho};
}

dvec2 theta_phi(const dvec3& direction) {
  const double rho = std::hypot(direction.x, direction.y);
  return {std::atan2(rho, direction.z), rho == 0.0 ? 0.0 : std::atan2(direction.y, direction.x)};
}

dvec3 theta_hat(const dvec3& direction) { return angles_of(direction).theta_hat(); }
dvec3 phi_hat(const dvec3& direction) { return angles_of(direction).phi_hat(); }

}  // namespace greatx::rf
