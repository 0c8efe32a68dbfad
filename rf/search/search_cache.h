// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Candidates kept on disk between runs: a static source in a static scene sees the same ones for ever.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "rf/search/beam_search.h"

namespace greatx::rf {

/// What the numbers in a result may refer to.
struct SearchExtent {
  uint32_t facets = 0;  ///< of the FacetWorld
  uint32_t wedges = 0;  ///< of the list given
};

/// A folder of results, one file each, `<key>.beams`: read and written whole, replaced at once (never half a
/// file), with the key and a checksum. What lies there and is no such file (damaged, of another key, a
/// folder, a pipe, not to be read) is as good as none and said. Several processes may use the folder at the
/// same time: a file is there whole or not at all, and who reads one keeps it even if another removes it.
class SearchCache {
 public:
  static constexpr uint64_t default_most_bytes = 512u << 20;

  /// `folder` empty: nothing is kept. `most_bytes`: of all results together; beyond it those go that were not
  /// used for longest.
  explicit SearchCache(std::filesystem::path folder, uint64_t most_bytes = default_most_bytes);
  /// GREATX_CACHE ("off": none), else $XDG_CACHE_HOME/greatx, else ~/.cache/greatx; GREATX_CACHE_MIB MiB,
  /// else default_most_bytes. Throws UserError if that is no whole number above 0.
  static SearchCache standard();

  /// Counts as a use.
  std::optional<BeamSearchResult> load(const std::string& key, const SearchExtent& extent) const;
  /// A folder that cannot be written is reported once and otherwise ignored: the result is in memory. So is a
  /// result that alone is beyond the limit.
  void store(const std::string& key, const BeamSearchResult& result) const;
  const std::filesystem::path& folder() const { return folder_; }
  uint64_t most_bytes() const { return most_bytes_; }

 private:
  void trim(const std::filesystem::path& newest) const;

  std::filesystem::path folder_;
  uint64_t most_bytes_;
};

}  // namespace greatx::rf
