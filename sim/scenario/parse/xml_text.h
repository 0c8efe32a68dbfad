// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads XML text with the lines of its elements, for errors that name them.
#pragma once

#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "core/error.h"

namespace greatx::sim {

/// Knows the line of each element. Offsets are asked for in ascending order.
class XmlLines {
 public:
  /// `text` outlives this; `name` is that of the file.
  XmlLines(std::string_view text, const std::string& name) : text_(text), name_(name) {}
  /// Returns the line of an element by its offset (pugi::xml_node::offset_debug()).
  SourceLocation where(std::ptrdiff_t offset);

 private:
  std::string_view text_;
  std::string name_;
  size_t at_ = 0;
  int line_ = 1;
};

/// Parses the text. Throws UserError naming the line where it is no XML.
pugi::xml_document parse_xml(std::string_view text, XmlLines& lines);

}  // namespace greatx::sim
