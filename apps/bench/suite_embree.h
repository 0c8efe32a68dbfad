// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Traces the rays of `greatx bench --suite` with Embree, in the same run, as a yardstick. Embree is optional
// (CMake option GREATX_EMBREE; Debian: libembree-dev).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/bench/suite_passes.h"

namespace greatx::apps {

class SuiteEmbree {
 public:
  /// Builds Embree's tree over the static triangles, with its robust mode: rays slip through no edge. `scene`
  /// outlives this. Does nothing without Embree.
  explicit SuiteEmbree(const scene::Scene& scene);
  ~SuiteEmbree();
  SuiteEmbree(const SuiteEmbree&) = delete;
  SuiteEmbree& operator=(const SuiteEmbree&) = delete;

  /// Traces one ray after the other on every core. `closest`: the nearest hit, else any.
  std::vector<SuiteAnswer> trace(const std::vector<SuiteRay>& rays, bool closest) const;

  /// Returns "3.13.5", or an empty string if the program was built without Embree.
  static std::string version();

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace greatx::apps
