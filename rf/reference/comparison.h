// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares paths with those of the reference: which paths are missing, doubled or extra.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace greatx::rf::reference {

/// Holds the properties by which a path is compared: its vertices from the transmitter to the receiver, and
/// its length.
struct Polyline {
  std::span<const dvec3> vertices;
  double length_m = 0.0;
};
/// Returns the polylines of a list of GeometricPath or Path.
template <typename AnyPath>
std::vector<Polyline> polylines(const std::vector<AnyPath>& paths) {
  std::vector<Polyline> list;
  list.reserve(paths.size());
  for (const AnyPath& path : paths) list.push_back({path.vertices, path.length_m});
  return list;
}

struct ComparisonTolerance {
  double vertex_m = 1e-4, length_m = 1e-6;
};

/// Sums the results of comparisons over receivers. Each path of the reference takes the first of the other
/// paths that is the same within the tolerance (found; else missing). An untaken path that is the same as a
/// path of the reference is doubled. Every other path is extra.
class Comparison {
 public:
  struct Counts {
    uint64_t reference = 0, found = 0, missing = 0, doubled = 0, extra = 0;
    bool perfect() const { return missing == 0 && doubled == 0 && extra == 0; }
    /// Returns found / reference; 1 if the reference has no paths.
    double recall() const;
  };
  enum class Fault : uint8_t { missing, doubled, extra };
  struct Mismatch {
    Fault fault;
    uint32_t receiver, path;  ///< path of the reference if missing, else of the other paths
  };

  explicit Comparison(uint32_t max_depth, const ComparisonTolerance& tolerance = {});
  void add(uint32_t receiver, std::span<const Polyline> reference, std::span<const Polyline> paths);

  /// Returns counts [max_depth + 1] by number of interactions (vertices - 2). Deeper paths count as the last.
  const std::vector<Counts>& by_depth() const { return by_depth_; }
  Counts all() const;
  const std::vector<Mismatch>& mismatches() const { return mismatches_; }

 private:
  Counts& at_depth(const Polyline& path);
  bool same(const Polyline& a, const Polyline& b) const;

  ComparisonTolerance tolerance_;
  std::vector<Counts> by_depth_;
  std::vector<Mismatch> mismatches_;
};

}  // namespace greatx::rf::reference
