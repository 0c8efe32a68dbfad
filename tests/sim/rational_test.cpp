// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/rational.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"

namespace greatx::sim {
namespace {

constexpr int64_t largest = std::numeric_limits<int64_t>::max();

TEST(Rational, IsReduced) {
  EXPECT_EQ(Rational::make(60, 4), (Rational{15, 1}));
  EXPECT_EQ(Rational::make(30000, 1001), (Rational{30000, 1001}));
  EXPECT_THROW(Rational::make(0, 1), ContractError);
  EXPECT_THROW(Rational::make(1, -1), ContractError);
}

TEST(Rational, ReadsText) {
  EXPECT_EQ(Rational::parse("30"), (Rational{30, 1}));
  EXPECT_EQ(Rational::parse("29.97"), (Rational{2997, 100}));
  EXPECT_EQ(Rational::parse("30000/1001"), (Rational{30000, 1001}));
  EXPECT_EQ(Rational::parse("2.5e3"), (Rational{2500, 1}));
  EXPECT_EQ(Rational::parse("1E-3"), (Rational{1, 1000}));
  EXPECT_EQ(Rational::parse("1e+2"), (Rational{100, 1}));
  EXPECT_EQ(Rational::parse(".5"), (Rational{1, 2}));
  EXPECT_EQ(Rational::parse("9223372036854775807"), (Rational{largest, 1}));
  for (const char* bad : {"",
                          "0",
                          "0.0",
                          "-1",
                          "+1",
                          "1/0",
                          "0/1",
                          "1/2/3",
                          "1.5/2",
                          "1e",
                          "e3",
                          ".",
                          "1.2.3",
                          " 1",
                          "1 ",
                          "1 Hz",
                          "nan",
                          "inf",
                          "1e+-2",
                          "1e19",
                          "0x10",
                          "9223372036854775808",
                          "1e99999999999",
                          "123456789012345678901234567890",
                          "0.00000000000000000000000000000001",
                          "1/-2",
                          "/",
                          "1/"})
    EXPECT_FALSE(Rational::parse(bad)) << bad;
}

TEST(Rational, WritesWhatItReads) {
  for (const char* text : {"30", "30000/1001", "2997/100"}) EXPECT_EQ(Rational::parse(text)->str(), text);
}

TEST(Rational, ComparesExactly) {
  // Both values are 1.0 in fp64.
  const Rational below{largest - 1, largest}, one{1, 1};
  EXPECT_EQ(below.value(), one.value());
  EXPECT_TRUE(less(below, one));
  EXPECT_FALSE(less(one, below));
  EXPECT_FALSE(less(one, one));
}

TEST(Rational, ProductsAndQuotientsSeeOverflow) {
  EXPECT_EQ(product({3, 4}, {2, 9}), (Rational{1, 6}));
  EXPECT_EQ(quotient({1000, 1}, {30000, 1001}), (Rational{1001, 30}));
  EXPECT_EQ(product({largest, 2}, {2, largest}), (Rational{1, 1}));
  EXPECT_FALSE(product({largest, 1}, {3, 1}));
  EXPECT_FALSE(quotient({1, largest}, {3, 1}));
}

}  // namespace
}  // namespace greatx::sim
