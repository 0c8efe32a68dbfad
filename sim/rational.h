// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace greatx::sim {

/// A positive rational number in lowest terms, e.g. 30000/1001 Hz. Exact arithmetic; overflow is checked.
struct Rational {
  int64_t numerator = 1;
  int64_t denominator = 1;

  static Rational make(int64_t numerator, int64_t denominator);
  double value() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
  std::string str() const;  ///< "30" or "30000/1001"
  friend bool operator==(const Rational&, const Rational&) = default;
};

/// a < b, exactly.
bool less(const Rational& a, const Rational& b);

}  // namespace greatx::sim
