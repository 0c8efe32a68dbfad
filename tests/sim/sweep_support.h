// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds every number of a scenario's text and every number that the schema knows, and gives both the same
// names.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace greatx::sim::test {

/// A number in a YAML text.
struct Number {
  std::string name;     ///< name in the schema, for example "nodes[].sensors[]:camera.near_m"
  std::string element;  ///< the same name with indices, for messages
  size_t at = 0, length = 0;
  std::string text;
};
/// Returns the plain scalars of a YAML document that are numbers or fractions, except the format's version.
std::vector<Number> numbers_of(const std::string& yaml);

/// Describes the range that a schema gives a number. An excluded end does not belong to the range.
struct Range {
  bool integer = false;
  std::optional<double> least, most;
  bool least_excluded = false, most_excluded = false;
  bool holds(double value) const;
};
/// Maps a name to its ranges. A name has several ranges if the schema has alternatives.
using Ranges = std::map<std::string, std::vector<Range>>;
Ranges ranges_of(const nlohmann::json& schema);

/// Returns texts to put in a number's place: values that no number may have, the ends of `ranges`, and values
/// just beyond the ends.
std::vector<std::string> ends_and_beyond(const std::vector<Range>& ranges);

}  // namespace greatx::sim::test
