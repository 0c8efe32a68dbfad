// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads lines and cells of the CSV files that users write by hand. Empty lines and lines that begin with '#'
// are skipped. A byte order mark and the line ends of Windows are allowed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace greatx::sim {

/// Describes a cell of a line, without the blanks around it.
struct CsvCell {
  std::string_view text;
  size_t column = 1;  ///< 1-based, in bytes
};

struct CsvLine {
  std::string_view file;
  int number = 0;  ///< 1-based
  std::vector<CsvCell> cells;

  /// Throws UserError "file:line:column: " and `what`; the column is that of a cell.
  [[noreturn]] void fail(size_t cell, const std::string& what) const;
};

/// Reads line by line. The text outlives it.
/// Divides a text into lines, without their ends and without a byte-order mark.
class TextLines {
 public:
  explicit TextLines(std::string_view text);
  std::optional<std::string_view> next();
  /// Returns the number of the last line, 1-based.
  int number() const { return number_; }

 private:
  std::string_view text_;
  int number_ = 0;
};

class CsvReader {
 public:
  /// `name` stands for the file in messages.
  CsvReader(std::string_view text, std::string_view name) : lines_(text), name_(name) {}
  /// Returns the next line with content, or nothing at the end.
  std::optional<CsvLine> next();

 private:
  TextLines lines_;
  std::string_view name_;
};

/// Returns a number that fills a whole cell: "12", "-.5e3", "+1", "inf", "nan". The result is empty if the
/// text is not a number.
std::optional<double> csv_number(std::string_view text);
/// Returns the text in small letters (ASCII).
std::string lower_case(std::string_view text);

/// Returns the whole file; `what` says in the message what it should hold. Throws UserError if it cannot be
/// read.
std::string read_csv_file(const std::filesystem::path& file, const std::string& what);

}  // namespace greatx::sim
