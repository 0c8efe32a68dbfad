// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The JSON Schema of a document, as a form needs it: for each value its kind, its bounds, its default and the
// values below it. The parser of scenarios alone decides whether a value is right; a form that shows too much
// or too little loses nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields/field_value.h"

namespace greatx::view {

/// Points at a part of a Schema, which outlives it.
class SchemaPart {
 public:
  bool known() const { return part_ != nullptr; }

 private:
  friend class Schema;
  const void* part_ = nullptr;
};

/// Describes one value of a form.
struct FormType {
  enum class Kind : uint8_t {
    text,  ///< any scalar; also exact fractions
    number,
    integer,
    boolean,
    choice,   ///< one of `choices`
    choices,  ///< a list, each item one of `choices`
    numbers,  ///< a list of `count` numbers
    list,     ///< of `items`
    map,      ///< with `members`
    fixed,    ///< a constant, which is not changed by itself
    other,    ///< the form shows YAML
  };
  struct Member {
    std::string key;
    SchemaPart part;
    bool required = false;
    std::vector<std::string> together;  ///< members that must be given with it
  };
  Kind kind = Kind::other;
  SchemaPart part;  ///< that this describes
  std::string description;
  std::optional<double> least, most;
  std::vector<std::string> choices;
  size_t count = 0;
  std::string default_line;  ///< YAML; empty: none
  std::vector<Member> members;
  SchemaPart items;
  /// Of a map that comes in several shapes: the key that tells them apart ("type"), and its values.
  std::string shape_key;
  std::vector<std::string> shapes;
};

class Schema {
 public:
  /// `text` is a JSON Schema of draft 2020-12, as docs/scenario.schema.json uses it.
  explicit Schema(std::string_view text);
  ~Schema();
  Schema(const Schema&) = delete;
  Schema& operator=(const Schema&) = delete;

  SchemaPart root() const;
  /// Returns the type of a value. `value` chooses between several shapes, and may be null.
  FormType type_of(const SchemaPart& part, const FieldValue* value) const;

 private:
  struct Document;
  std::unique_ptr<const Document> document_;
};

}  // namespace greatx::view
