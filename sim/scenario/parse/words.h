// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads lines of words, as other programs write them. Empty lines are skipped. A byte order mark and the line
// ends of Windows are allowed.
#pragma once

#include <optional>
#include <string_view>

#include "sim/scenario/parse/csv.h"

namespace greatx::sim {

/// Reads line by line; the cells of a line are its words. The text outlives it.
class WordReader {
 public:
  /// `name` stands for the file in messages; `separators` stand between words.
  WordReader(std::string_view text, std::string_view name, std::string_view separators);
  /// Returns the next line that has words, or nothing at the end.
  std::optional<CsvLine> next();
  /// Returns the number of the last line, 1-based.
  int line() const { return lines_.number(); }

 private:
  TextLines lines_;
  std::string_view name_, separators_;
};

}  // namespace greatx::sim
