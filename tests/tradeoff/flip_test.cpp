// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/error/flip.h"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

namespace greatx::sim {
namespace {

Array picture(const std::function<std::array<int, 3>(int x, int y)>& color) {
  Array array(DType::u8, {36, 48, 3});
  for (int y = 0; y < 36; ++y)
    for (int x = 0; x < 48; ++x) {
      const std::array<int, 3> c = color(x, y);
      for (int i = 0; i < 3; ++i)
        array.as<uint8_t>()[static_cast<size_t>(3 * (48 * y + x) + i)] = static_cast<uint8_t>(c[i]);
    }
  return array;
}
Array flat(int grey) {
  return picture([&](int, int) { return std::array{grey, grey, grey}; });
}
Array ramp(int shift) {
  return picture([&](int x, int y) {
    x = std::max(x - shift, 0);
    return std::array{5 * x, 7 * y, (3 * x + 4 * y) % 256};
  });
}
Array checks(int shift) {
  return picture([&](int x, int y) {
    return ((x + shift) / 4 + y / 4) % 2 ? std::array{220, 220, 220} : std::array{60, 40, 30};
  });
}
Array spot() {
  return picture([](int x, int y) {
    return std::abs(x - 24) < 2 && std::abs(y - 18) < 2 ? std::array{255, 0, 0} : std::array{128, 128, 128};
  });
}

TEST(Flip, AgreesWithItsAuthorsProgram) {
  // The authors' own evaluator (flip-evaluator 1.x, LDR, 67 pixels per degree) yields these values: the mean,
  // pixel (24, 18) and pixel (7, 5).
  const auto expect = [](const Array& a, const Array& b, double mean, double middle, double corner) {
    const Flip f = flip(a, b);
    EXPECT_NEAR(f.mean, mean, 2e-4);
    EXPECT_NEAR(f.error[18 * 48 + 24], middle, 1e-3);
    EXPECT_NEAR(f.error[5 * 48 + 7], corner, 1e-3);
  };
  expect(flat(0), flat(255), 0.96740, 0.96739, 0.96739);
  expect(ramp(0), ramp(1), 0.09608, 0.09379, 0.06209);
  expect(checks(0), checks(1), 0.27133, 0.48807, 0.44476);
  expect(flat(128), spot(), 0.01082, 0.66919, 0.0);
  expect(ramp(0), flat(128), 0.77559, 0.33328, 0.79083);
}

TEST(Flip, TheSameIsZeroAndOrderDoesNotMatter) {
  EXPECT_EQ(flip(ramp(0), ramp(0)).mean, 0.0);
  EXPECT_DOUBLE_EQ(flip(ramp(0), checks(0)).mean, flip(checks(0), ramp(0)).mean);
}

}  // namespace
}  // namespace greatx::sim
