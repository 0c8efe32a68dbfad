// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/xml_text.h"

#include <algorithm>

namespace greatx::sim {

SourceLocation XmlLines::where(std::ptrdiff_t offset) {
  const size_t end =
      std::clamp<size_t>(static_cast<size_t>(std::max<std::ptrdiff_t>(offset, 0)), at_, text_.size());
  line_ += static_cast<int>(std::ranges::count(text_.substr(at_, end - at_), '\n'));
  at_ = end;
  return {name_, line_};
}

pugi::xml_document parse_xml(std::string_view text, XmlLines& lines) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  if (!result) throw_user_error_at(lines.where(result.offset), "XML: {}", result.description());
  return document;
}

}  // namespace greatx::sim
