// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/buildings/weld.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/place/plane/cells.h"

namespace greatx::scene::place {

size_t weld(std::span<Ring* const> rings, double distance_m) {
  if (!(distance_m > 0.0)) return 0;
  size_t changes = 0;
  std::vector<dvec2> corners;
  Cells cells(4.0);
  for (Ring* ring : rings) {
    for (dvec2& p : *ring) {
      double least = distance_m;
      dvec2 best = p;
      bool found = false;
      cells.near(p - distance_m, p + distance_m, [&](uint32_t i) {
        const dvec2& q = corners[i];
        if (glm::distance(p, q) >= least) return;
        least = glm::distance(p, q);
        best = q;
        found = true;
      });
      if (!found) {
        cells.add(p, p, static_cast<uint32_t>(corners.size()));
        corners.push_back(p);
      } else if (best != p) {
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
      cells.near(glm::min(a, b) - distance_m, glm::max(a, b) + distance_m, [&](uint32_t corner) {
        const dvec2& q = corners[corner];
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
