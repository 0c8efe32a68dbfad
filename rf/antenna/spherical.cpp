// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/antenna/spherical.h"

#include <cmath>

#include "core/error.h"

namespace greatx::rf {

template <typename R>
AnglesOf<R> angles_of(const Vec3Of<R>& direction) {
  using std::hypot;
  const R rho = hypot(direction.x, direction.y);
  const R length = hypot(rho, direction.z);
  GREATX_CHECK(length > 0.0 && std::isfinite(value_of(length)), "direction ({}, {}, {}) has no angles",
               value_of(direction.x), value_of(direction.y), value_of(direction.z));
  if (rho == 0.0) return {direction.z > 0.0 ? 1.0 : -1.0, 0.0, 1.0, 0.0};
  return {direction.z / length, rho / length, direction.x / rho, direction.y / rho};
}
template Angles angles_of<double>(const dvec3&);
template AnglesOf<Dual> angles_of<Dual>(const Vec3Of<Dual>&);

dvec2 theta_phi(const dvec3& direction) {
  const double rho = std::hypot(direction.x, direction.y);
  return {std::atan2(rho, direction.z), rho == 0.0 ? 0.0 : std::atan2(direction.y, direction.x)};
}

}  // namespace greatx::rf
