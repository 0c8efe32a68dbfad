// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paths against the reference's: which are missing, doubled, or should not be there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace greatx::rf::reference {

/// What a path is compared by: its vertices from the transmitter to the receiver, and its length.
struct Polyline {
  std::span<const dvec3> vertices;
  double length_m = 0.0;
};
/// Of GeometricPath or Path.
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

/// Sums over receivers. Each path of the reference takes the first of the others that is the same within the
/// tolerance (found, else missing); another one that is the same as one already taken is doubled, what is
/// left is extra.
class Comparison {
 public:
  struct Counts {
    uint64_t reference = 0, found = 0, missing = 0, doubled = 0, extra = 0;
    bool perfect() const { return missing == 0 && doubled == 0 && extra == 0; }
    /// found / reference; 1 if there is nothing to find.
    double recall() const;
  };
  enum class Fault : uint8_t { missing, doubled, extra };
  struct Mismatch {
    Fault fault;
    uint32_t receiver, path;  ///< path: of the reference if missing, else of the others
  };

  explicit Comparison(uint32_t max_depth, const ComparisonTolerance& tolerance = {});
  void add(uint32_t receiver, std::span<const Polyline> reference, std::span<const Polyline> paths);

  /// [max_depth + 1] by interactions (vertices - 2); deeper ones count as the last.
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
