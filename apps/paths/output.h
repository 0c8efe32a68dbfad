// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Outputs of `greatx paths`. They write receiver by receiver and keep nothing in memory.
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <ostream>

#include <nlohmann/json.hpp>

#include "draw/paths/facts.h"

namespace greatx::apps {

/// Holds sums over the receivers so far.
struct PathTotals {
  size_t receivers = 0, paths = 0, with_line_of_sight = 0, without_path = 0;
  std::array<size_t, path_kinds.size()> kinds{};  ///< number of paths by kind_of()
  void add(const LinkFigures& figures);
  nlohmann::ordered_json json() const;
  /// Returns a line such as "100 receivers, 1316 paths (line of sight 61, reflection 1255), 2
  /// receivers without any".
  std::string text() const;
};

/// Takes the results of `greatx paths` one by one.
class PathsOutput {
 public:
  virtual ~PathsOutput() = default;
  /// Takes the facts that are known before the first receiver, as one JSON object.
  virtual void begin(const nlohmann::ordered_json&) {}
  virtual void add(const PathLink& link) = 0;
  /// Takes the facts that are known after the last receiver, as one JSON object.
  virtual void end(const nlohmann::ordered_json&) {}
};

/// Returns an output that prints one JSON object with one receiver a line: the members of begin(), the list
/// "receivers", and the members of end().
std::unique_ptr<PathsOutput> json_output(std::ostream& out, const PathScene& scene);
/// Returns an output that prints one JSON object a line. Its "kind" is "head", "receiver" or "totals".
std::unique_ptr<PathsOutput> json_lines_output(std::ostream& out, const PathScene& scene);
/// Returns an output that prints a table for each receiver or, if `brief`, one line for each.
std::unique_ptr<PathsOutput> table_output(std::ostream& out, const PathScene& scene, bool brief);
/// Returns an output that writes the compact CSV to a file. The file appears under its name when it is
/// complete.
std::unique_ptr<PathsOutput> csv_output(const std::filesystem::path& file, const PathScene& scene);

}  // namespace greatx::apps
