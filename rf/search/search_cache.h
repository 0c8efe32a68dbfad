// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Candidates kept on disk between runs: a static source in a static scene sees the same ones for ever.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "core/vec.h"
#include "rf/facet_kind.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {

/// Everything that decides the result of a search among what stands still, as one SHA-256: the scene's hash, the kinds of
/// its facets, the wedges (which depend on the effects, too), the source's 64-bit coordinates, every option but the number
/// of threads, and the version of the search itself. Not for searches among moving bodies.
std::string search_key(const std::string& scene_hash, const FacetKinds& kinds,
                       std::span<const scene::Wedge> wedges, const dvec3& source,
                       const BeamSearchOptions& options);

/// A folder of results, one file each, `<key>.beams`: read and written whole, replaced at once (never half a file), with
/// a checksum. A file that is damaged or cannot be read is as good as none.
class SearchCache {
 public:
  /// `folder` empty: nothing is kept.
  explicit SearchCache(std::filesystem::path folder);
  /// GREATX_CACHE ("off": none), else $XDG_CACHE_HOME/greatx, else ~/.cache/greatx.
  static SearchCache standard();

  std::optional<BeamSearchResult> load(const std::string& key) const;
  /// A folder that cannot be written is reported once and otherwise ignored: the result is in memory.
  void store(const std::string& key, const BeamSearchResult& result) const;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace greatx::rf
