// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps candidates on disk between runs: a static source in a static scene always sees the same ones.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rf/search/beam_search.h"

namespace greatx::rf {

/// Bounds the indices in a result.
struct SearchExtent {
  uint32_t facets = 0;  ///< facets of the FacetWorld
  uint32_t wedges = 0;  ///< wedges of the given list
};

/// Manages a folder of results, one file each, `<key>.beams`, with the key and a checksum. Files are read and
/// written whole and replaced atomically. A file that cannot serve (damaged, with another key, a folder, a
/// pipe, unreadable) counts as absent and is reported. Several processes may use the folder at the same time:
/// a file exists whole or not at all, and a process that reads a file can finish even if another removes it.
class SearchCache {
 public:
  static constexpr uint64_t default_most_bytes = 512u << 20;

  /// If `folder` is empty, nothing is kept. `most_bytes` bounds all results together; beyond it the least
  /// recently used results are removed.
  explicit SearchCache(std::filesystem::path folder, uint64_t most_bytes = default_most_bytes);
  /// Returns the cache that the environment asks for, in cache_folder(). The size is GREATX_CACHE_MIB MiB,
  /// else default_most_bytes. Throws UserError if that is not a whole number above 0.
  static SearchCache standard();

  /// Returns the result of `key`, if there is a file that fits `extent`. Counts as a use of the file.
  std::optional<BeamSearchResult> load(const std::string& key, const SearchExtent& extent) const;
  /// Writes a result. A folder that cannot be written is reported and otherwise ignored, because the result
  /// is in memory. So is a result that alone exceeds the limit.
  void store(const std::string& key, const BeamSearchResult& result) const;
  struct Size {
    uint64_t results = 0, bytes = 0;
  };
  /// Counts the results in the folder.
  Size size() const;
  /// Removes every result, and drafts that nobody will finish. Returns what is gone.
  Size clear() const;
  const std::filesystem::path& folder() const { return folder_; }
  uint64_t most_bytes() const { return most_bytes_; }

 private:
  struct Kept;
  std::vector<Kept> kept() const;
  void trim(const std::filesystem::path& newest) const;

  std::filesystem::path folder_;
  uint64_t most_bytes_;
};

}  // namespace greatx::rf
