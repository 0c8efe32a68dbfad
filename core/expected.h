// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Words of messages that say what was expected. A message flows one way: a reader knows which names or which
// range it accepts, these functions put them into words, and the reader throws them with file, line and
// field. suggestion() of core/text.h finds the nearest name.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/text.h"

namespace greatx {

/// Returns a number as people write it: "0.5", "77000", "1e8", "1e-30".
std::string number_words(double value);
/// Returns an integer as people write it. Large powers of ten and of two, and those less one, are shown as
/// powers: "4000000", "10^12", "2^64 - 1".
std::string integer_words(uint64_t value);

/// Returns "a number from 0 to 3", or "a number of 0 or more" if `high` is infinite or the largest of its
/// type, "a number of at most 3" if `low` is, and "a finite number" if both are.
std::string number_range(double low, double high);
/// Returns "an integer from 1 to 10^12".
std::string integer_range(uint64_t low, uint64_t high);

/// Returns "expected one of a, b, c, found 'd' (did you mean 'c'?)". If a name is near, a list of more than
/// 24 names is left out: "expected a known name, found ...".
std::string expected_one_of(const std::vector<std::string>& names, std::string_view found);
/// Does the same for any list of texts.
template <typename Names>
std::string expected_one_of(const Names& names, std::string_view found) {
  std::vector<std::string> texts;
  for (const auto& name : names) texts.emplace_back(name);
  return expected_one_of(texts, found);
}

}  // namespace greatx
