// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace greatx::sim {

/// A positive rational number in lowest terms, e.g. 30000/1001 Hz. Exact arithmetic; overflow is checked.
struct Rational {
  int64_t numerator = 1;
  int64_t denominator = 1;

  /// Reduced to lowest terms. Both must be positive (ContractError).
  static Rational make(int64_t numerator, int64_t denominator);
  /// "30", "29.97", "2.5e3" (exact decimals) or "30000/1001". Empty if the text is anything else, not
  /// positive, or does not fit 64-bit integers.
  static std::optional<Rational> parse(std::string_view text);
  double value() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
  std::string str() const;  ///< "30" or "30000/1001"
  friend bool operator==(const Rational&, const Rational&) = default;
};

/// a < b, exactly.
bool less(const Rational& a, const Rational& b);
/// a * b and a / b in lowest terms. Empty if the result does not fit 64-bit integers.
std::optional<Rational> product(const Rational& a, const Rational& b);
std::optional<Rational> quotient(const Rational& a, const Rational& b);

}  // namespace greatx::sim
