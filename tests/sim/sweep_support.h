// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Every number of a scenario's text, and every number that the schema knows, by the same names.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace greatx::sim::test {

/// A number in a text.
struct Number {
  std::string name;     ///< "nodes[].sensors[]:camera.near_m"
  std::string element;  ///< the same with indices, for messages
  size_t at = 0, length = 0;
  std::string text;
};
/// The plain scalars of a YAML document that are numbers or fractions, but for the format's version.
std::vector<Number> numbers_of(const std::string& yaml);

/// What a schema says of a number: ends that belong to it or not.
struct Range {
  bool integer = false;
  std::optional<double> least, most;
  bool least_excluded = false, most_excluded = false;
  bool holds(double value) const;
};
/// By name; several where the schema has alternatives.
using Ranges = std::map<std::string, std::vector<Range>>;
Ranges ranges_of(const nlohmann::json& schema);

/// Texts to put in a number's place: what no number should be, and the schema's ends and what lies just
/// beyond.
std::vector<std::string> ends_and_beyond(const std::vector<Range>& ranges);

}  // namespace greatx::sim::test
