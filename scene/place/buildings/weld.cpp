// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/buildings/weld.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace greatx::scene::place {

namespace {

/// Corners in square cells, for look-ups near a place.
class CornerCells {
 public:
  explicit CornerCells(double cell_m) : cell_m_(cell_m) {}
  void add(const dvec2& p) { cells_[key(cell(p.x), cell(p.y))].push_back(p); }
  template <typename Visit>
  void near(const dvec2& low, const dvec2& high, const Visit& visit) const {
    for (int64_t y = cell(low.y); y <= cell(high.y); ++y)
      for (int64_t x = cell(low.x); x <= cell(high.x); ++x)
        if (const auto found = cells_.find(key(x, y)); found != cells_.end())
          for (const dvec2& p : found->second) visit(p);
  }

 private:
  int64_t cell(double at) const { return static_cast<int64_t>(std::floor(at / cell_m_)); }
  static uint64_t key(int64_t x, int64_t y) {
    return static_cast<uint64_t>(x) << 32 ^ (static_cast<uint64_t>(y) & 0xFFFFFFFFu);
  }
  double cell_m_;
  std::unordered_map<uint64_t, std::vector<dvec2>> cells_;  ///< for look-ups alone, never iterated
};

}  // namespace

size_t weld(std::span<Ring* const> rings, double distance_m) {
  if (!(distance_m > 0.0)) return 0;
  size_t changes = 0;
  CornerCells corners(4.0);
  for (Ring* ring : rings) {
    for (dvec2& p : *ring) {
      double least = distance_m;
      dvec2 best = p;
      bool found = false;
      corners.near(p - distance_m, p + distance_m, [&](const dvec2& q) {
        if (glm::distance(p, q) >= least) return;
        least = glm::distance(p, q);
        best = q;
        found = true;
      });
      if (!found)
        corners.add(p);
      else if (best != p) {
        p = best;
        ++changes;
      }
    }
  }
  for (Ring* ring : rings) {
    Ring result;
    for (size_t i = 0; i < ring->size(); ++i) {
      const dvec2 a = (*ring)[i], b = (*ring)[(i + 1) % ring->size()];
      if (a == b) continue;  // welding has made one corner of two
      result.push_back(a);
      const double length = glm::distance(a, b);
      const dvec2 along = (b - a) / length;
      std::vector<std::pair<double, dvec2>> between;
      corners.near(glm::min(a, b) - distance_m, glm::max(a, b) + distance_m, [&](const dvec2& q) {
        const double at = glm::dot(q - a, along);
        const double off = std::abs(along.x * (q.y - a.y) - along.y * (q.x - a.x));
        if (at > distance_m && at < length - distance_m && off < distance_m) between.emplace_back(at, q);
      });
      std::sort(between.begin(), between.end(),
                [](const auto& l, const auto& r) { return l.first < r.first; });
      for (const auto& [at, q] : between) result.push_back(q);
      changes += between.size();
    }
    *ring = std::move(result);
  }
  return changes;
}

}  // namespace greatx::scene::place
