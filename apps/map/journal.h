// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Stores an unfinished radio map: the links of its cells in the order in which they were solved. A map that
// was stopped can then be resumed.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/files/file.h"
#include "sim/channel/map_precoder.h"

namespace greatx::apps {

/// Reads and appends to FOLDER/links.part. The file holds a line of text, the length of the request, the
/// request (JSON), and blocks of links. Each block begins with its number of links and a hash, so that an
/// incomplete block at the end is detected and dropped.
class MapJournal {
 public:
  /// Opens a journal in a new or empty folder or, with `resume`, in the folder of a map with the same
  /// request. Throws UserError, which names the folder, if
  /// - the folder holds other files, or another process is writing the map;
  /// - the folder holds a map, finished or not, and `resume` is off;
  /// - the map in the folder has a different request. The message names the first difference as a JSON
  ///   pointer.
  MapJournal(const std::filesystem::path& folder, const nlohmann::ordered_json& request, bool resume);

  /// Returns true if the folder holds the finished map.
  bool finished() const { return finished_; }
  /// Returns all links so far, [cells, tx].
  const std::vector<sim::MapLink>& links() const { return links_; }
  /// Appends a block of links, in memory and on disk.
  void append(std::span<const sim::MapLink> links);
  /// Removes the journal. Called when all files of the map, including map.json, are in place.
  void finish();

 private:
  void open_new(const std::string& request);
  void read_blocks(uint64_t begin);

  std::filesystem::path folder_;
  io::File file_;
  uint64_t bytes_ = 0;
  bool finished_ = false;
  std::vector<sim::MapLink> links_;
};

/// The file that describes a finished map.
inline constexpr const char* map_description = "map.json";

}  // namespace greatx::apps
