// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/vec.h"

namespace greatx::scene::place {

/// Numbers of things in square cells of the plane, for look-ups near a place. The order of a look-up depends
/// on the order of the additions alone.
class Cells {
 public:
  explicit Cells(double cell_m) : cell_m_(cell_m) {}
  /// Adds a thing that lies within a box.
  void add(const dvec2& low, const dvec2& high, uint32_t index) {
    each(low, high, [&](uint64_t key) { cells_[key].push_back(index); });
  }
  /// Calls visit(index) for the things in all cells that the box meets; for some of them more than once.
  template <typename Visit>
  void near(const dvec2& low, const dvec2& high, const Visit& visit) const {
    each(low, high, [&](uint64_t key) {
      if (const auto found = cells_.find(key); found != cells_.end())
        for (const uint32_t index : found->second) visit(index);
    });
  }
  /// Returns the things in the cell of a place.
  const std::vector<uint32_t>& at(const dvec2& place) const {
    static const std::vector<uint32_t> none;
    const auto found = cells_.find(key(cell(place.x), cell(place.y)));
    return found != cells_.end() ? found->second : none;
  }

 private:
  int64_t cell(double at) const { return static_cast<int64_t>(std::floor(at / cell_m_)); }
  static uint64_t key(int64_t x, int64_t y) {
    return static_cast<uint64_t>(x) << 32 ^ (static_cast<uint64_t>(y) & 0xFFFFFFFFu);
  }
  template <typename Act>
  void each(const dvec2& low, const dvec2& high, const Act& act) const {
    for (int64_t y = cell(low.y); y <= cell(high.y); ++y)
      for (int64_t x = cell(low.x); x <= cell(high.x); ++x) act(key(x, y));
  }

  double cell_m_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;  ///< for look-ups alone, never iterated
};

}  // namespace greatx::scene::place
