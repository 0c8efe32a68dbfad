// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads YAML strictly. Every value knows its place in the file and its path ("nodes[1].sensors[0].rate_hz"),
// and every wrong one throws UserError "file:line: path: expected ..., found ...".
#pragma once

#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "core/error.h"
#include "core/vec.h"
#include "sim/scenario/limits.h"
#include "sim/scenario/rational.h"
#include "sim/scenario/rotation.h"

namespace greatx::sim {

/// Represents one value of the document. Numbers follow YAML 1.2's core schema: they are plain (unquoted)
/// scalars, and are 0 or of a magnitude from least_number to most_number.
class Field {
 public:
  /// Returns the root of the one document in `text`. Throws UserError with the line if it is not well-formed
  /// YAML.
  static Field parse(const std::string& text, const std::string& file_name,
                     const std::filesystem::path& folder, const std::filesystem::path& assets = {});

  SourceLocation where() const { return {source_->file_name, line_}; }
  const std::string& path() const { return path_; }
  [[noreturn]] void fail(const std::string& expected) const;
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const;

  bool is_list() const { return node_.IsSequence(); }
  bool is_scalar() const { return node_.IsScalar(); }
  bool boolean() const;
  std::string text() const;  ///< not empty
  /// Returns a name that is also a folder's or file's: it has letters, digits, '_', '-', '.', and does not
  /// begin with '.' or '-'.
  std::string name() const;
  double number(double most = most_number) const;  ///< from -most
  double positive(double least = least_number, double most = most_number) const;
  double non_negative(double most = most_number) const;
  double between(double low, double high) const;  ///< inclusive
  uint64_t integer(uint64_t low, uint64_t high = std::numeric_limits<uint64_t>::max()) const;
  uint32_t integer32(uint32_t low, uint32_t high) const { return static_cast<uint32_t>(integer(low, high)); }
  /// Returns a positive rational number, from a number or a text such as 30000/1001; `expected` describes it.
  Rational rational(const std::string& expected) const;
  /// Returns the same with a sign, '-' or none.
  TurnRate turn_rate(const std::string& expected) const;
  dvec3 vector3(double most = most_number) const;  ///< each from -most
  dvec3 position() const;                          ///< a position or an extent in the world, m
  dvec3 angles_deg() const;                        ///< yaw, pitch, roll in degrees; returned in rad
  /// Returns the index of the text in `choices`.
  size_t choice(std::initializer_list<std::string_view> choices) const {
    return choice(std::span(choices.begin(), choices.size()));
  }
  size_t choice(std::span<const std::string_view> choices) const;
  /// Returns the items, of which there must be at least `least`; `of_what` names them in messages, e.g.
  /// "sensors".
  std::vector<Field> list(const std::string& of_what, size_t least = 0) const;
  /// Returns an existing regular file as an absolute path. A relative one is looked for in the scenario's
  /// folder, then among the assets.
  std::filesystem::path file() const;

 private:
  double finite() const;
  friend std::vector<std::pair<std::string, Field>> entries_of(const Field& field);
  struct Source {
    std::string file_name;
    std::filesystem::path folder;
    std::filesystem::path assets;  ///< empty: none
  };
  Field(std::shared_ptr<const Source> source, YAML::Node node, std::string path, int line);
  std::string describe() const;

  std::shared_ptr<const Source> source_;
  YAML::Node node_;
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

/// Returns the entries of a map with free keys, in the file's order. Duplicate keys throw.
std::vector<std::pair<std::string, Field>> entries_of(const Field& field);

/// Returns " (did you mean 'x'?)" for the candidate nearest to `word`, or an empty text if none is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace greatx::sim
