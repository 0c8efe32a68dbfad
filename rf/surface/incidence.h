// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "core/dual.h"

namespace greatx::rf {

/// Returns any unit vector perpendicular to k.
template <typename V>
V any_perpendicular(const V& k) {
  using std::abs;
  return normalize(cross(k, abs(k.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
}

/// Returns s = k x n / |k x n|, the direction of horizontal polarization. Within 1e-8 of the normal the plane
/// of incidence is only rounding noise, while r_TE = -r_TM and t_TE = t_TM to 1e-16: any s gives the same
/// field. `V` is a dvec3 or a vector of dual numbers.
template <typename V>
V s_axis(const V& k, const dvec3& normal) {
  const V product = cross(k, normal);
  const auto sine = length(product);
  return sine > 1e-8 ? product / sine : any_perpendicular(k);
}

}  // namespace greatx::rf
