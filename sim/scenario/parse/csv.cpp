// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/csv.h"

#include <algorithm>
#include <charconv>

#include "core/input_file.h"

namespace greatx::sim {
namespace {

std::vector<CsvCell> split(std::string_view line) {
  std::vector<CsvCell> cells;
  for (size_t begin = 0; begin <= line.size();) {
    const size_t end = std::min(line.find(',', begin), line.size());
    size_t first = begin, last = end;
    while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    cells.push_back({line.substr(first, last - first), first + 1});
    begin = end + 1;
  }
  return cells;
}

}  // namespace

void CsvLine::fail(size_t cell, const std::string& what) const {
  throw_user_error("{}:{}:{}: {}", file, number, cells[cell].column, what);
}

TextLines::TextLines(std::string_view text) : text_(text) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
}

std::optional<std::string_view> TextLines::next() {
  if (text_.empty()) return std::nullopt;
  const size_t end = std::min(text_.find('\n'), text_.size());
  std::string_view content = text_.substr(0, end);
  text_.remove_prefix(std::min(end + 1, text_.size()));
  ++number_;
  if (content.ends_with('\r')) content.remove_suffix(1);
  return content;
}

std::optional<CsvLine> CsvReader::next() {
  while (const std::optional<std::string_view> content = lines_.next()) {
    const size_t first = content->find_first_not_of(" \t");
    if (first == std::string_view::npos || (*content)[first] == '#') continue;
    return CsvLine{name_, lines_.number(), split(*content)};
  }
  return std::nullopt;
}

std::optional<double> csv_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

std::string read_csv_file(const std::filesystem::path& file, const std::string& what) {
  return InputFile(file, fmt::format("{}: expected a readable file of {}", file.string(), what),
                   budget::csv_file)
      .text();
}

}  // namespace greatx::sim
