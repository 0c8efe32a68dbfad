// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/record.h"

#include <gtest/gtest.h>

#include "core/units.h"
#include "core/vec.h"

namespace greatx {
namespace {

TEST(Array, HoldsItsValuesInOrder) {
  const std::vector<float> values{1, 2, 3, 4, 5, 6};
  const Array array = Array::of<float>({2, 3}, values);
  EXPECT_EQ(array.element_count(), 6);
  EXPECT_EQ(array.as<float>()[5], 6.0f);
  EXPECT_THROW(array.as<double>(), ContractError);
  EXPECT_THROW(Array::of<float>({7}, values), ContractError);
}

TEST(Array, MayBeEmpty) { EXPECT_EQ(Array(DType::complex64, {0, 4}).bytes.size(), 0u); }

TEST(Pose, ComposesAndInverts) {
  const Pose a{{1, 2, 3}, orientation_from_yaw_pitch_roll(0.3, -0.2, 0.1)};
  const Pose b{{-4, 5, 6}, orientation_from_yaw_pitch_roll(-1.0, 0.4, 2.0)};
  const dvec3 point{7, 8, 9};
  EXPECT_LT(glm::length((a * b).apply(point) - a.apply(b.apply(point))), 1e-12);
  EXPECT_LT(glm::length((a * a.inverse()).apply(point) - point), 1e-12);
  // Yaw turns x towards y, positive pitch turns x downwards (right-handed about y).
  EXPECT_LT(glm::length(orientation_from_yaw_pitch_roll(pi / 2, 0, 0) * dvec3(1, 0, 0) - dvec3(0, 1, 0)),
            1e-12);
  EXPECT_LT(glm::length(orientation_from_yaw_pitch_roll(0, pi / 2, 0) * dvec3(1, 0, 0) - dvec3(0, 0, -1)),
            1e-12);
}

}  // namespace
}  // namespace greatx
