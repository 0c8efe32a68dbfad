// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The kernel by which PatchSynthesizer spreads patches over a grid: the exponential of a semicircle (A. H.
// Barnett, J. Magland, L. af Klinteberg, "A parallel nonuniform fast Fourier transform library based on an
// 'exponential of semicircle' kernel", SIAM J. Sci. Comput. 41(5), 2019).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "rf/radar/signal/lanes.h"

namespace greatx::rf {

class PatchKernel {
 public:
  static constexpr int taps = 5;

  /// For outputs m = -count/2 (rounded down) .. count - 1 - count/2 of a transform of grid_for(count) cells.
  explicit PatchKernel(uint32_t count);
  /// Returns the number of cells: at least 1.5 count and 2 taps, with the factors 2, 3 and 5 alone.
  static uint32_t grid_for(uint32_t count);

  uint32_t count() const { return count_; }
  uint32_t grid() const { return grid_; }
  /// Returns the factors on the outputs, [count].
  const std::vector<float>& correction() const { return correction_; }
  /// Returns the first cell of spread().
  uint32_t first_cell(double turns) const { return begin_of(turns).cell; }
  /// Returns the first cell, in [0, grid), and the taps from there on for a tone of `turns` per output.
  uint32_t spread(double turns, std::array<float, taps>& weights) const;

 private:
  struct Begin {
    uint32_t cell;   ///< first cell, in [0, grid)
    double between;  ///< from half a width before the middle of the kernel to the first cell, in (0, 1]
  };
  Begin begin_of(double turns) const {
    double place = turns - nearest(turns);  // |turns| < 2^51
    if (place < 0.0) place += 1.0;
    // The middle of the kernel is place * grid cells from the origin; its first tap is the first cell within
    // half a width of it. A whole grid is added so that a cast rounds down.
    const double begin = (place + 1.0) * grid_ - 0.5 * taps;
    const uint32_t cell = static_cast<uint32_t>(begin) + 1;
    return {cell >= 2 * grid_ ? cell - 2 * grid_
            : cell >= grid_   ? cell - grid_
                              : cell,
            static_cast<double>(cell) - begin};
  }
  uint32_t count_, grid_;
  std::vector<float> correction_;
};

}  // namespace greatx::rf
