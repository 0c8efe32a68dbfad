// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lines and cells of the CSV files that users write by hand. Empty lines and lines that begin with '#' are skipped; a
// byte order mark and the line ends of Windows are fine.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace greatx::sim {

/// A cell of a line without the blanks around it.
struct CsvCell {
  std::string_view text;
  size_t column = 1;  ///< 1-based, in bytes
};

struct CsvLine {
  std::string_view file;
  int number = 0;  ///< 1-based
  std::vector<CsvCell> cells;

  /// UserError "file:line:column: " and `what`; the column is that of a cell.
  [[noreturn]] void fail(size_t cell, const std::string& what) const;
};

/// Reads line by line; the text outlives it.
class CsvReader {
 public:
  /// `name` stands for the file in messages.
  CsvReader(std::string_view text, std::string_view name);
  /// The next line that has something to say; empty at the end.
  std::optional<CsvLine> next();

 private:
  std::string_view text_, name_;
  int number_ = 0;
};

/// A number as a whole cell: "12", "-.5e3", "+1", "inf", "nan"; empty if it is none.
std::optional<double> csv_number(std::string_view text);
/// In small letters (ASCII).
std::string lower_case(std::string_view text);

/// The whole file; `what` says what it should hold, for the message. Throws UserError if it cannot be read.
std::string read_csv_file(const std::filesystem::path& file, const std::string& what);

}  // namespace greatx::sim
