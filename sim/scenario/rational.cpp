// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/rational.h"

#include <charconv>
#include <cstdlib>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"

namespace greatx::sim {
namespace {

__extension__ typedef __int128 int128;

constexpr int64_t max_int64 = std::numeric_limits<int64_t>::max();

std::optional<Rational> reduced(int128 numerator, int128 denominator) {
  int128 a = numerator, b = denominator;
  while (b != 0) {
    const int128 rest = a % b;
    a = b;
    b = rest;
  }
  numerator /= a;
  denominator /= a;
  if (numerator > max_int64 || denominator > max_int64) return std::nullopt;
  return Rational{static_cast<int64_t>(numerator), static_cast<int64_t>(denominator)};
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Parses digits[.digits][e[+-]digits] as an exact fraction. It must use up the text.
std::optional<Rational> parse_decimal(std::string_view text) {
  // The limit leaves room for a multiplication by ten without overflow.
  constexpr int128 limit = static_cast<int128>(max_int64) * 1'000'000'000;
  int128 numerator = 0, denominator = 1;
  size_t at = 0, digits = 0;
  bool fraction = false;
  for (; at < text.size() && (is_digit(text[at]) || (text[at] == '.' && !fraction)); ++at) {
    if (text[at] == '.') {
      fraction = true;
      continue;
    }
    ++digits;
    numerator = numerator * 10 + (text[at] - '0');
    if (fraction) denominator *= 10;
    if (numerator > limit || denominator > limit) return std::nullopt;
  }
  if (digits == 0) return std::nullopt;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    std::string_view rest = text.substr(at + 1);
    if (rest.starts_with("+-")) return std::nullopt;
    if (rest.starts_with('+')) rest.remove_prefix(1);
    int exponent = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), exponent);
    if (error != std::errc{} || end != rest.data() + rest.size() || std::abs(exponent) > 18)
      return std::nullopt;
    for (; exponent > 0 && numerator <= limit; --exponent) numerator *= 10;
    for (; exponent < 0 && denominator <= limit; ++exponent) denominator *= 10;
    if (exponent != 0) return std::nullopt;
    at = text.size();
  }
  if (at != text.size() || numerator == 0) return std::nullopt;
  return reduced(numerator, denominator);
}

}  // namespace

Rational Rational::make(int64_t numerator, int64_t denominator) {
  GREATX_CHECK(numerator > 0 && denominator > 0, "{}/{} is not a positive rational number", numerator,
               denominator);
  const int64_t divisor = std::gcd(numerator, denominator);
  return {numerator / divisor, denominator / divisor};
}

std::optional<Rational> Rational::parse(std::string_view text) {
  const size_t slash = text.find('/');
  if (slash == std::string_view::npos) return parse_decimal(text);
  const auto upper = parse_decimal(text.substr(0, slash));
  const auto lower = parse_decimal(text.substr(slash + 1));
  if (!upper || !lower || upper->denominator != 1 || lower->denominator != 1) return std::nullopt;
  return make(upper->numerator, lower->numerator);
}

std::string Rational::str() const {
  return denominator == 1 ? fmt::format("{}", numerator) : fmt::format("{}/{}", numerator, denominator);
}

bool less(const Rational& a, const Rational& b) {
  return static_cast<int128>(a.numerator) * b.denominator < static_cast<int128>(b.numerator) * a.denominator;
}

std::optional<Rational> product(const Rational& a, const Rational& b) {
  return reduced(static_cast<int128>(a.numerator) * b.numerator,
                 static_cast<int128>(a.denominator) * b.denominator);
}

std::optional<Rational> quotient(const Rational& a, const Rational& b) {
  return reduced(static_cast<int128>(a.numerator) * b.denominator,
                 static_cast<int128>(a.denominator) * b.numerator);
}

}  // namespace greatx::sim
