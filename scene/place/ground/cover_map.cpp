// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/ground/cover_map.h"

#include <algorithm>
#include <cmath>

namespace greatx::scene::place {

namespace {
constexpr double cell_m = 50.0;
}

CoverMap::CoverMap(const std::vector<GroundArea>& areas, const Box& rectangle)
    : areas_(areas), low_(rectangle.low) {
  columns_ = static_cast<int>((rectangle.high.x - low_.x) / cell_m) + 1;
  rows_ = static_cast<int>((rectangle.high.y - low_.y) / cell_m) + 1;
  cells_.resize(index(0, rows_));
  for (uint32_t a = 0; a < areas.size(); ++a)
    for (uint32_t p = 0; p < areas[a].polygons.size(); ++p) {
      const Box box = box_of(areas[a].polygons[p]);
      if (!box.meets(rectangle)) continue;
      for (int y = row(box.low.y); y <= row(box.high.y); ++y)
        for (int x = column(box.low.x); x <= column(box.high.x); ++x) cells_[index(x, y)].push_back({a, p});
    }
}

int CoverMap::column(double x) const {
  return static_cast<int>(std::clamp(std::floor((x - low_.x) / cell_m), 0.0, columns_ - 1.0));
}
int CoverMap::row(double y) const {
  return static_cast<int>(std::clamp(std::floor((y - low_.y) / cell_m), 0.0, rows_ - 1.0));
}
size_t CoverMap::index(int x, int y) const {
  return static_cast<size_t>(y) * static_cast<size_t>(columns_) + static_cast<size_t>(x);
}

Cover CoverMap::at(const dvec2& place) const {
  Cover best = Cover::base;
  for (const auto& [a, p] : cells_[index(column(place.x), row(place.y))])
    if (areas_[a].cover > best && contains(areas_[a].polygons[p], place)) best = areas_[a].cover;
  return best;
}

}  // namespace greatx::scene::place
