// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads untrusted JSON. The size, the depth and the number of values are checked before the text is parsed.
// The getters throw errors that name the file, the line and the field of an unexpected value.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/error.h"

namespace greatx::io {

struct JsonLimits {
  uint64_t bytes = uint64_t{64} << 20;
  uint64_t values = uint64_t{1} << 23;
  int depth = 64;
};

class JsonDocument;

/// Refers to a value of a JsonDocument, which must outlive it. Every getter throws UserError if the value is
/// not of its type or range: "FILE:LINE: sensors[0].name: expected a string, found 7".
class JsonValue {
 public:
  bool is_object() const;
  bool has(std::string_view key) const;            ///< false if the value is not an object
  JsonValue at(std::string_view key) const;        ///< member of an object
  std::vector<JsonValue> list(size_t most) const;  ///< elements of an array of at most `most`
  /// Returns the elements of an array of exactly `count`.
  std::vector<JsonValue> tuple(size_t count) const;
  std::string text() const;
  bool boolean() const;
  int64_t integer(int64_t least, int64_t most) const;
  double number(double least, double most) const;
  const nlohmann::ordered_json& json() const { return *json_; }
  std::string dump() const;
  /// Throws UserError with the place, the given expectation and the value that was found.
  [[noreturn]] void fail(std::string_view expected) const;

 private:
  friend class JsonDocument;
  JsonValue(const JsonDocument& document, const nlohmann::ordered_json& json)
      : document_(&document), json_(&json) {}
  const JsonDocument* document_;
  const nlohmann::ordered_json* json_;
};

class JsonDocument {
 public:
  /// Parses `text`. `where` is the file and the line on which the text begins; if the line is 0, messages
  /// name no line. Throws UserError if the text exceeds a limit or is not JSON.
  JsonDocument(std::string text, const SourceLocation& where, const JsonLimits& limits = {});
  ~JsonDocument();
  JsonDocument(const JsonDocument&) = delete;
  JsonDocument& operator=(const JsonDocument&) = delete;

  JsonValue root() const { return {*this, *root_}; }

 private:
  friend class JsonValue;
  [[noreturn]] void fail(const nlohmann::ordered_json* value, std::string_view member,
                         std::string_view expected, const std::string& found) const;
  int line_of_value(uint64_t number) const;

  std::string text_;
  SourceLocation where_;
  std::unique_ptr<nlohmann::ordered_json> root_;
};

}  // namespace greatx::io
