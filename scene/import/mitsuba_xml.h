// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/vec.h"

namespace greatx::scene {

/// Represents a Mitsuba document and the places of its elements. Messages begin with file:line.
class MitsubaXml {
 public:
  /// Throws UserError if the file is not readable, not well-formed, nested deeper than 64, not UTF-8, or has
  /// no root element <scene>.
  explicit MitsubaXml(const std::filesystem::path& file);

  pugi::xml_node scene() const { return document_.child("scene"); }
  const std::filesystem::path& file() const { return file_; }
  SourceLocation where(const pugi::xml_node& node) const;

  template <typename... Args>
  [[noreturn]] void fail(const pugi::xml_node& node, fmt::format_string<Args...> format,
                         Args&&... args) const {
    throw_user_error_at(where(node), format, std::forward<Args>(args)...);
  }

  /// Returns the attribute's text. It is an error if the attribute is missing, empty or a parameter ($name).
  std::string text(const pugi::xml_node& node, const char* attribute) const;
  double number(const pugi::xml_node& node, const char* attribute) const;
  /// Returns numbers separated by blanks or commas.
  std::vector<double> numbers(const pugi::xml_node& node, const char* attribute) const;

  /// Returns the child <type name="name">, or an empty node.
  static pugi::xml_node property(const pugi::xml_node& parent, const char* type, const std::string& name);
  /// Returns the values of such children, or nothing where there is none.
  std::optional<std::string> string(const pugi::xml_node& parent, const std::string& name) const;
  std::optional<double> real(const pugi::xml_node& parent, const std::string& name) const;
  bool flag(const pugi::xml_node& parent, const std::string& name) const;  ///< false where there is none
  /// Returns an <rgb>'s value: three numbers, one for all, or #rrggbb (which is taken as linear, as in
  /// Mitsuba).
  vec3 rgb(const pugi::xml_node& node) const;
  /// Returns the matrix of a <transform>: translate, rotate, scale and matrix, each applied after those
  /// before it.
  dmat4 transform(const pugi::xml_node& node) const;

 private:
  SourceLocation location(std::ptrdiff_t offset) const;
  dvec3 xyz(const pugi::xml_node& node, double missing) const;
  dmat4 matrix(const pugi::xml_node& node) const;

  std::filesystem::path file_;
  std::string source_;
  std::vector<std::ptrdiff_t> line_ends_;
  pugi::xml_document document_;
};

}  // namespace greatx::scene
