// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the values that people write, in YAML or in JSON, strictly. Every value knows its place in the file
// and its path ("nodes[1].sensors[0].rate_hz"), and every wrong one throws UserError "file:line: path:
// expected ..., found ...". io/files/untrusted_json.h reads the large JSON files that programs write.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/fields/field_value.h"
#include "core/vec.h"

namespace greatx {

/// The bounds of every number that is not an integer: squares and ratios in single precision on the device
/// can hold them. Most quantities have narrower bounds of their own.
inline constexpr double least_number = 1e-30, most_number = 1e30;

/// Says where a document comes from.
struct FieldSource {
  std::string name;              ///< of the file, for messages
  std::filesystem::path folder;  ///< where relative paths begin
  std::filesystem::path assets;  ///< where they are looked for next; empty: nowhere
};

/// Represents one value of a document. Numbers follow YAML 1.2's core schema: they are plain (unquoted)
/// scalars, and are 0 or of a magnitude from least_number to most_number.
class Field {
 public:
  /// Returns the root of the YAML document in `text`. Throws as read_yaml() does.
  static Field parse_yaml(const std::string& text, FieldSource source);
  /// Takes a document's root, whose path is `path`.
  Field(std::shared_ptr<const FieldValue> root, FieldSource source, std::string path = "");

  SourceLocation where() const { return {source_->name, line_}; }
  const std::string& path() const { return path_; }
  [[noreturn]] void fail(const std::string& expected) const;
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const;
  /// Throws UserError "file:line: path: `message`".
  [[noreturn]] void refuse(const std::string& message) const;

  const FieldValue& value() const { return *value_; }
  bool is_list() const { return value_->kind == FieldValue::Kind::list; }
  bool is_map() const { return value_->kind == FieldValue::Kind::map; }
  bool is_scalar() const { return value_->kind == FieldValue::Kind::scalar; }
  /// Returns the text of a scalar, quoted or not, and an empty text for any other value.
  std::string_view scalar() const { return value_->text; }
  bool boolean() const;
  std::string text() const;  ///< not empty
  /// Returns a name that is also a folder's or file's: it has letters, digits, '_', '-', '.', and does not
  /// begin with '.' or '-'.
  std::string name() const;
  /// Returns the number of a plain scalar that is finite. Throws "expected `expected`" for any other value.
  double finite(const std::string& expected = "a finite number") const;
  double number(double most = most_number) const;  ///< from -most
  double positive(double least = least_number, double most = most_number) const;
  double non_negative(double most = most_number) const;
  double between(double low, double high) const;  ///< inclusive
  uint64_t integer(uint64_t low, uint64_t high = std::numeric_limits<uint64_t>::max()) const;
  uint32_t integer32(uint32_t low, uint32_t high) const { return static_cast<uint32_t>(integer(low, high)); }
  dvec3 vector3(double most = most_number) const;  ///< each from -most
  /// Returns the index of the text in `choices`.
  size_t choice(std::initializer_list<std::string_view> choices) const {
    return choice(std::span(choices.begin(), choices.size()));
  }
  size_t choice(std::span<const std::string_view> choices) const;
  /// Returns the items, of which there must be at least `least`; `of_what` names them in messages, e.g.
  /// "sensors".
  std::vector<Field> list(const std::string& of_what, size_t least = 0) const;
  /// Returns the entries of a map, in the document's order. A duplicate key throws.
  std::vector<std::pair<std::string, Field>> entries() const;
  /// Returns an existing regular file as an absolute path. A relative one is looked for in the document's
  /// folder, then among the assets.
  std::filesystem::path file() const;

 private:
  Field(const Field& parent, std::shared_ptr<const FieldValue> value, std::string path, int line);
  std::string describe() const;

  std::shared_ptr<const FieldSource> source_;
  std::shared_ptr<const FieldValue> value_;
  std::string path_;
  int line_ = 0;
};

/// The keys of a map.
using Keys = std::vector<std::string_view>;
inline Keys operator+(Keys a, const Keys& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Represents a map whose keys are known beforehand. Unknown and duplicate keys throw.
class FieldMap {
 public:
  FieldMap(const Field& field, const Keys& keys);
  const Field& field() const { return field_; }
  std::optional<Field> find(std::string_view key) const;
  bool has(std::string_view key) const { return find(key).has_value(); }
  /// Throws "expected `expected`, found nothing" at the map's line if the key is missing.
  Field require(std::string_view key, const std::string& expected) const;
  /// Throws if both keys are there.
  void exclude(std::string_view key, std::string_view other) const;

 private:
  Field field_;
  std::vector<std::pair<std::string, Field>> entries_;
};

}  // namespace greatx
