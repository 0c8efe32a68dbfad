// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/expected.h"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace greatx {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Expected, NumbersAreShort) {
  EXPECT_EQ(number_words(0.0), "0");
  EXPECT_EQ(number_words(-0.5), "-0.5");
  EXPECT_EQ(number_words(299792.458), "299792.458");
  EXPECT_EQ(number_words(1e6), "1000000");
  EXPECT_EQ(number_words(1e8), "1e8");
  EXPECT_EQ(number_words(123456789.5), "123456789.5");
  EXPECT_EQ(number_words(-1e30), "-1e30");
  EXPECT_EQ(number_words(1e-30), "1e-30");
  EXPECT_EQ(number_words(2.5e-7), "2.5e-7");
  EXPECT_EQ(number_words(1e100), "1e100");
}

TEST(Expected, LargeIntegersArePowers) {
  EXPECT_EQ(integer_words(1000000), "1000000");
  EXPECT_EQ(integer_words(1000000000000), "10^12");
  EXPECT_EQ(integer_words(uint64_t{1} << 40), "2^40");
  EXPECT_EQ(integer_words(std::numeric_limits<uint32_t>::max()), "2^32 - 1");
  EXPECT_EQ(integer_words(std::numeric_limits<int64_t>::max()), "2^63 - 1");
  EXPECT_EQ(integer_words(std::numeric_limits<uint64_t>::max()), "2^64 - 1");
  EXPECT_EQ(integer_words(12345678), "12345678");
}

TEST(Expected, ABoundThatIsNoneIsLeftOut) {
  EXPECT_EQ(number_range(0.0, 3.0), "a number from 0 to 3");
  for (const double high :
       {infinity, std::numeric_limits<double>::max(), double{std::numeric_limits<float>::max()}}) {
    EXPECT_EQ(number_range(0.0, high), "a number of 0 or more");
    EXPECT_EQ(number_range(-high, 3.0), "a number of at most 3");
    EXPECT_EQ(number_range(-high, high), "a finite number");
  }
  EXPECT_EQ(number_range(-1e30, 1e30), "a number from -1e30 to 1e30");
  EXPECT_EQ(integer_range(1, 1000000000000), "an integer from 1 to 10^12");
}

TEST(Expected, TheNearestNameIsSuggested) {
  const std::vector<std::string> names{"auto", "driver", "tree"};
  EXPECT_EQ(expected_one_of(names, "tre"),
            "expected one of auto, driver, tree, found 'tre' (did you mean 'tree'?)");
  EXPECT_EQ(expected_one_of(names, "cuda"), "expected one of auto, driver, tree, found 'cuda'");
  EXPECT_EQ(expected_one_of(std::vector<std::string>{"csi"}, "x\n"), "expected csi, found 'x\\u000a'");
  std::vector<std::string> many;
  for (int i = 0; i < 30; ++i) many.push_back("name_" + std::string(1, static_cast<char>('a' + i)));
  EXPECT_EQ(expected_one_of(many, "nmae_a"),
            "expected a known name, found 'nmae_a' (did you mean 'name_a'?)");
}

TEST(Expected, LettersThatChangePlacesAndCaseAreNear) {
  // Two swaps cost two, where substitutions alone would cost four.
  EXPECT_EQ(suggestion("biuld", {"build", "bind"}), " (did you mean 'build'?)");
  EXPECT_EQ(suggestion("HTTPS", {"https"}), " (did you mean 'https'?)");
  EXPECT_EQ(suggestion("path-gain", {"path_gain"}), " (did you mean 'path_gain'?)");
  EXPECT_EQ(suggestion("rate", {"rate_hz"}), " (did you mean 'rate_hz'?)");
  EXPECT_EQ(suggestion("simulate", {"generate", "scene"}), "");
  EXPECT_EQ(suggestion(std::string(100000, 'x'), {std::string(100000, 'y')}), "");
}

}  // namespace
}  // namespace greatx
