// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/words.h"

#include <algorithm>

namespace greatx::sim {

WordReader::WordReader(std::string_view text, std::string_view name, std::string_view separators)
    : lines_(text), name_(name), separators_(separators) {}

std::optional<CsvLine> WordReader::next() {
  while (const std::optional<std::string_view> content = lines_.next()) {
    CsvLine line{name_, lines_.number(), {}};
    for (size_t at = content->find_first_not_of(separators_); at != std::string_view::npos;) {
      const size_t after = std::min(content->find_first_of(separators_, at), content->size());
      line.cells.push_back({content->substr(at, after - at), at + 1});
      at = content->find_first_not_of(separators_, after);
    }
    if (!line.cells.empty()) return line;
  }
  return std::nullopt;
}

}  // namespace greatx::sim
