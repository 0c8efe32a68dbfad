// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/glow_average.h"

#include <algorithm>
#include <cmath>

namespace greatx::render {

namespace {

/// Walls face the same way if the cosine between their normals is larger than this.
constexpr double same_way = 0.7;

}  // namespace

GlowAverage::GlowAverage(uint32_t width, std::span<const dvec2> normals, std::span<const WallGlow> glows) {
  if (std::ranges::none_of(glows, &WallGlow::any)) return;
  row_of_cell_.resize(glows.size(), 0);
  levels_.resize(1);
  const dvec2 size(width, double(glows.size() / width));
  for (size_t i = 0; i < glows.size(); ++i) {
    if (normals[i] == dvec2(0.0)) continue;
    const dvec2 middle(double(i % width) + 0.5, double(i / width) + 0.5), along(-normals[i].y, normals[i].x);
    WallGlow sum = glows[i];
    double count = 1.0;
    std::array<WallGlow, level_count> levels{sum};
    int aside = 1;
    for (size_t level = 1; level < level_count; ++level) {
      for (; aside <= 1 << (level - 1); ++aside)
        for (const int side : {-1, 1}) {
          const dvec2 at = middle + along * double(side * aside);
          if (at.x < 0.0 || at.y < 0.0 || at.x >= size.x || at.y >= size.y) continue;
          const size_t other = static_cast<size_t>(at.y) * width + static_cast<size_t>(at.x);
          if (glm::dot(normals[other], normals[i]) < same_way) continue;
          sum.low += glows[other].low;
          sum.high += glows[other].high;
          count += 1.0;
        }
      levels[level] = {sum.low / count, sum.high / count};
    }
    if (!sum.any()) continue;
    row_of_cell_[i] = static_cast<uint32_t>(levels_.size());
    levels_.push_back(levels);
  }
}

const WallGlow& GlowAverage::at(size_t cell, double cells_aside) const {
  static const WallGlow none;
  const uint32_t row = row_of_cell_.empty() ? 0 : row_of_cell_[cell];
  if (row == 0) return none;
  const int level = cells_aside < 0.5 ? 0 : 1 + static_cast<int>(std::lround(std::log2(cells_aside)));
  return levels_[row][std::min(static_cast<size_t>(std::max(level, 0)), level_count - 1)];
}

}  // namespace greatx::render
