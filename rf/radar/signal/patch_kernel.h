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
  /// Returns the first cell, in [0, grid), and the taps from there on for a tone of `turns` per output.
  uint32_t spread(double turns, std::array<float, taps>& weights) const;

 private:
  uint32_t count_, grid_;
  std::vector<float> correction_;
};

}  // namespace greatx::rf
