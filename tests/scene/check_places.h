// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the tests of scene/check have in common: grounds, and the one place of a fault.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "tests/scene/check_shapes.h"

namespace greatx::scene::test {

inline constexpr auto flat = [](double, double) { return 0.0; };
inline const auto hills = [](double x, double y) { return 3.0 * std::sin(0.1 * x) * std::cos(0.07 * y); };

/// Returns the places of a kind, of which there must be one.
inline const FaultPlace& only_place(const SceneFaults& faults, const std::string& kind) {
  static const FaultPlace none;
  const SceneFault* fault = faults.find(kind);
  EXPECT_NE(fault, nullptr) << kind << " in: " << kinds_of(faults);
  if (!fault) return none;
  EXPECT_EQ(fault->places.size(), 1u) << kind;
  return fault->places.front();
}

inline void expect_near(const dvec3& found, const dvec3& expected, double distance) {
  EXPECT_LT(glm::distance(found, expected), distance)
      << found.x << ", " << found.y << ", " << found.z << "; expected " << expected.x << ", " << expected.y
      << ", " << expected.z;
}

}  // namespace greatx::scene::test
