// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/expected.h"

#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace greatx {

namespace {

/// A bound of this size is that of a type: nothing is beyond it.
bool is_unlimited(double bound) { return std::abs(bound) >= std::numeric_limits<float>::max(); }

/// Returns k if `value` is 10^k; else 0.
int power_of_ten(uint64_t value) {
  int exponent = 0;
  for (; value >= 10 && value % 10 == 0; value /= 10) ++exponent;
  return value == 1 ? exponent : 0;
}

}  // namespace

std::string number_words(double value) {
  const double size = std::abs(value);
  const bool plain = value == 0.0 || (size >= 1e-4 && size < 1e7);
  std::string text = plain ? fmt::format("{}", value) : fmt::format("{:g}", value);
  if (parse_number(text) != value) text = fmt::format("{}", value);  // six digits do not hold it
  const size_t e = text.find('e');
  if (e == std::string::npos) return text;
  // 1e+08 becomes 1e8, and 1e-05 becomes 1e-5.
  const bool negative = text[e + 1] == '-';
  const size_t digits = text.find_first_not_of("+-0", e + 1);
  return fmt::format("{}e{}{}", text.substr(0, e), negative ? "-" : "", text.substr(digits));
}

std::string integer_words(uint64_t value) {
  constexpr uint64_t large = 10'000'000;  // shorter numbers are read at a glance
  if (value < large) return fmt::format("{}", value);
  if (const int exponent = power_of_ten(value)) return fmt::format("10^{}", exponent);
  if (std::has_single_bit(value)) return fmt::format("2^{}", std::countr_zero(value));
  if (value == std::numeric_limits<uint64_t>::max()) return "2^64 - 1";
  if (std::has_single_bit(value + 1)) return fmt::format("2^{} - 1", std::countr_zero(value + 1));
  return fmt::format("{}", value);
}

std::string number_range(double low, double high) {
  if (is_unlimited(low) && is_unlimited(high)) return "a finite number";
  if (is_unlimited(high)) return fmt::format("a number of {} or more", number_words(low));
  if (is_unlimited(low)) return fmt::format("a number of at most {}", number_words(high));
  return fmt::format("a number from {} to {}", number_words(low), number_words(high));
}

std::string integer_range(uint64_t low, uint64_t high) {
  return fmt::format("an integer from {} to {}", integer_words(low), integer_words(high));
}

std::string expected_one_of(const std::vector<std::string>& names, std::string_view found) {
  constexpr size_t most_listed = 24;
  const std::string hint = suggestion(found, names);
  const std::string list =
      !hint.empty() && names.size() > most_listed
          ? "a known name"
          : fmt::format("{}{}", names.size() > 1 ? "one of " : "", fmt::join(names, ", "));
  return fmt::format("expected {}, found '{}'{}", list, printable(found), hint);
}

}  // namespace greatx
