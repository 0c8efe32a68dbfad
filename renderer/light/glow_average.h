// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What walls emit, averaged along them. Who gathers light looks along few azimuths, so far away a look stands
// for many columns: lit windows and dark ones that a single look would hit or miss.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/light/wall_glow.h"

namespace greatx::render {

class GlowAverage {
 public:
  GlowAverage() = default;
  /// `normals` and `glows` are those of the walls in rows of `width` cells; a zero normal is no wall.
  GlowAverage(uint32_t width, std::span<const dvec2> normals, std::span<const WallGlow> glows);

  /// Returns the mean over the walls that face the same way within a number of cells to both sides, rounded
  /// to 0 or to a power of 2 up to 16.
  const WallGlow& at(size_t cell, double cells_aside) const;

 private:
  static constexpr size_t level_count = 6;
  std::vector<uint32_t> row_of_cell_;  ///< the row of levels_; 0: nothing near glows. Empty: nothing glows
  std::vector<std::array<WallGlow, level_count>> levels_;
};

}  // namespace greatx::render
