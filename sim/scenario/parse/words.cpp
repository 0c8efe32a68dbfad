// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/words.h"

#include <algorithm>

namespace greatx::sim {

WordReader::WordReader(std::string_view text, std::string_view name, std::string_view separators)
    : text_(text), name_(name), separators_(separators) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
}

std::optional<CsvLine> WordReader::next() {
  while (!text_.empty()) {
    const size_t end = std::min(text_.find('\n'), text_.size());
    std::string_view content = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    ++number_;
    if (content.ends_with('\r')) content.remove_suffix(1);
    CsvLine line{name_, number_, {}};
    for (size_t at = content.find_first_not_of(separators_); at != std::string_view::npos;) {
      const size_t after = std::min(content.find_first_of(separators_, at), content.size());
      line.cells.push_back({content.substr(at, after - at), at + 1});
      at = content.find_first_not_of(separators_, after);
    }
    if (!line.cells.empty()) return line;
  }
  return std::nullopt;
}

}  // namespace greatx::sim
