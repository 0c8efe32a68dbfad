// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the frame in which shadow maps are drawn.
#pragma once

#include "core/vec.h"

namespace greatx::render {

/// Holds right-handed axes in the local frame, with z to the sun.
struct SunFrame {
  dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  static SunFrame of(const dvec3& to_sun);
  dvec3 from_local(const dvec3& p) const { return {glm::dot(x, p), glm::dot(y, p), glm::dot(z, p)}; }
};

}  // namespace greatx::render
