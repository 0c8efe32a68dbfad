// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// An unfinished radio map: the links of its cells in the order in which they were solved, so that a map that
// was stopped goes on where it was.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/files/file.h"
#include "rf/channel/statistics.h"

namespace greatx::apps {

/// FOLDER/links.part: a line of text, what was asked for (JSON, with its length in front), then blocks of
/// links, each with its number of links and a hash: a torn block at the end is seen and dropped.
class MapJournal {
 public:
  /// A new folder (or an empty one), or with `resume` one whose map was stopped and asked for the same.
  /// Throws UserError naming the folder: it holds something else, a map that is finished, one that is not and
  /// `resume` is off, or one that asked for something else (the first difference is named, as a JSON
  /// pointer).
  MapJournal(const std::filesystem::path& folder, const nlohmann::ordered_json& request, bool resume);

  /// There is nothing left to do.
  bool finished() const { return finished_; }
  /// All links so far, [cells, tx].
  const std::vector<rf::LinkStatistics>& links() const { return links_; }
  void append(std::span<const rf::LinkStatistics> links);
  /// The map's files are in place, map.json too: takes the journal away.
  void finish();

 private:
  void open_new(const std::string& request);
  void read_blocks(uint64_t begin);

  std::filesystem::path folder_;
  io::File file_;
  uint64_t bytes_ = 0;
  bool finished_ = false;
  std::vector<rf::LinkStatistics> links_;
};

inline constexpr const char* map_description = "map.json";

}  // namespace greatx::apps
