// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/random.h"

#include <array>

#include <gtest/gtest.h>

namespace greatx {
namespace {

// known answers from Random123's kat_vectors for philox4x32-10
TEST(Philox, MatchesKnownAnswers) {
  EXPECT_EQ(shared::philox4x32(glm::uvec4(0u), glm::uvec2(0u)),
            glm::uvec4(0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u));
  EXPECT_EQ(shared::philox4x32(glm::uvec4(0xffffffffu), glm::uvec2(0xffffffffu)),
            glm::uvec4(0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu));
  EXPECT_EQ(shared::philox4x32(glm::uvec4(0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u),
                               glm::uvec2(0xa4093822u, 0x299f31d0u)),
            glm::uvec4(0xd16cfe09u, 0x94fdccebu, 0x5001e420u, 0x24126ea1u));
}

// Chi-square with 255 degrees of freedom: P(X > 347.65) = 1e-4.
TEST(RandomStream, UniformPassesChiSquare) {
  RandomStream random(42, 7);
  std::array<int, 256> histogram{};
  constexpr int draws = 256 * 400;
  for (int i = 0; i < draws; ++i) ++histogram[static_cast<size_t>(random.uniform() * 256.0)];
  double chi_square = 0.0;
  for (int count : histogram) chi_square += (count - 400.0) * (count - 400.0) / 400.0;
  EXPECT_LT(chi_square, 347.65);
}

TEST(RandomStream, StreamsAndSequencesDiffer) {
  EXPECT_EQ(RandomStream(1, 2, 3).bits(), RandomStream(1, 2, 3).bits());
  EXPECT_NE(RandomStream(1, 2, 3).bits(), RandomStream(1, 2, 4).bits());
  EXPECT_NE(RandomStream(1, 2, 3).bits(), RandomStream(1, 3, 3).bits());
  EXPECT_NE(RandomStream(1, 2, 3).bits(), RandomStream(1ull << 32, 2, 3).bits());
}

}  // namespace
}  // namespace greatx
