// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace greatx::sim {

/// Describes a positive rational number in lowest terms, e.g. 30000/1001 Hz. Arithmetic is exact, and
/// overflow is checked.
struct Rational {
  int64_t numerator = 1;
  int64_t denominator = 1;

  /// Returns the number reduced to lowest terms. Both arguments must be positive (ContractError).
  static Rational make(int64_t numerator, int64_t denominator);
  /// Parses "30", "29.97", "2.5e3" (exact decimals) or "30000/1001". The result is empty if the text is
  /// anything else, not positive, or does not fit 64-bit integers.
  static std::optional<Rational> parse(std::string_view text);
  double value() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
  std::string str() const;  ///< "30" or "30000/1001"
  friend bool operator==(const Rational&, const Rational&) = default;
};

/// Returns whether a < b, exactly.
bool less(const Rational& a, const Rational& b);
/// Return a * b and a / b in lowest terms. The result is empty if it does not fit 64-bit integers.
std::optional<Rational> product(const Rational& a, const Rational& b);
std::optional<Rational> quotient(const Rational& a, const Rational& b);

}  // namespace greatx::sim
