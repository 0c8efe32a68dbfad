// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/vec.h"

namespace greatx::scene::place {

/// A box along x and y, m; empty (low > high) around no points.
struct Box {
  dvec2 low{1e300}, high{-1e300};
  void add(const dvec2& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void add(const Box& box) {
    low = glm::min(low, box.low);
    high = glm::max(high, box.high);
  }
  bool empty() const { return low.x > high.x; }
  bool holds(const dvec2& p) const { return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y; }
  bool meets(const Box& b) const {
    return b.low.x <= high.x && low.x <= b.high.x && b.low.y <= high.y && low.y <= b.high.y;
  }
  Box grown(double by) const { return {low - by, high + by}; }
};

}  // namespace greatx::scene::place
