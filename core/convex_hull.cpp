// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/convex_hull.h"

#include <algorithm>

namespace greatx {

std::vector<dvec2> convex_hull(std::vector<dvec2> points) {
  std::ranges::sort(points,
                    [](const dvec2& a, const dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<dvec2> hull;
  const auto chain = [&](auto first, auto end) {
    const size_t start = hull.size();
    for (auto point = first; point != end; ++point) {
      while (hull.size() >= start + 2) {
        const dvec2 a = hull.back() - hull[hull.size() - 2], b = *point - hull.back();
        if (a.x * b.y - a.y * b.x > 0.0) break;
        hull.pop_back();
      }
      hull.push_back(*point);
    }
    hull.pop_back();  // the other chain begins with this point
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  return hull;
}

}  // namespace greatx
