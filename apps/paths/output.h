// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where `greatx paths` writes: receiver by receiver, nothing is kept.
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <ostream>

#include <nlohmann/json.hpp>

#include "draw/paths/facts.h"

namespace greatx::apps {

/// Sums over the receivers so far.
struct PathTotals {
  size_t receivers = 0, paths = 0, with_line_of_sight = 0, without_path = 0;
  std::array<size_t, path_kinds.size()> kinds{};  ///< paths by kind_of
  void add(const LinkFigures& figures);
  nlohmann::ordered_json json() const;
  /// "100 receivers, 1316 paths (line of sight 61, reflection 1255), 2 receivers without any"
  std::string text() const;
};

class PathsOutput {
 public:
  virtual ~PathsOutput() = default;
  /// What is known beforehand: one JSON object.
  virtual void begin(const nlohmann::ordered_json&) {}
  virtual void add(const PathLink& link) = 0;
  /// What is known at the end: one JSON object.
  virtual void end(const nlohmann::ordered_json&) {}
};

/// Everything in one object, one receiver a line: what begin() said, "receivers", what end() said.
std::unique_ptr<PathsOutput> json_output(std::ostream& out, const PathScene& scene);
/// One object a line, each with its "kind": "head", "receiver"..., "totals".
std::unique_ptr<PathsOutput> json_lines_output(std::ostream& out, const PathScene& scene);
/// One table a receiver, or one line a receiver.
std::unique_ptr<PathsOutput> table_output(std::ostream& out, const PathScene& scene, bool brief);
/// The compact CSV into a file, which appears when it is whole.
std::unique_ptr<PathsOutput> csv_output(const std::filesystem::path& file, double carrier_hz);

}  // namespace greatx::apps
