// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/place/ground/areas.h"

namespace greatx::scene::place {

/// Says what covers the ground at a place. The areas' boxes lie in square cells, so that a place is compared
/// with few polygons.
class CoverMap {
 public:
  CoverMap(const std::vector<GroundArea>& areas, const Box& rectangle);
  Cover at(const dvec2& place) const;

 private:
  int column(double x) const;
  int row(double y) const;
  size_t index(int x, int y) const;

  const std::vector<GroundArea>& areas_;
  dvec2 low_;
  int columns_ = 1, rows_ = 1;
  std::vector<std::vector<std::array<uint32_t, 2>>> cells_;  ///< (area, polygon)
};

}  // namespace greatx::scene::place
