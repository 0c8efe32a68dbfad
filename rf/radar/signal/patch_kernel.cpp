// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/patch_kernel.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr double oversampling = 1.5;
/// Barnett et al., section 4.2: 0.97 pi w (1 - 1/(2 sigma)) for an oversampling sigma below 2.
constexpr double steepness = 0.97 * pi * PatchKernel::taps * (1.0 - 0.5 / oversampling);
constexpr int kernel_steps = 512;  ///< of the table, per cell

/// Returns the kernel at `z`, in half widths from its middle.
double semicircle(double z) {
  return std::abs(z) < 1.0 ? std::exp(steepness * (std::sqrt(1.0 - z * z) - 1.0)) : 0.0;
}

/// Holds the taps for places between two cells: [step][tap], with one step beyond the last.
struct KernelTable {
  std::array<std::array<float, PatchKernel::taps>, kernel_steps + 1> rows;
  KernelTable() {
    for (int step = 0; step <= kernel_steps; ++step)
      for (int tap = 0; tap < PatchKernel::taps; ++tap)
        rows[step][tap] = static_cast<float>(semicircle(
            (tap - double(step) / kernel_steps - 0.5 * PatchKernel::taps + 1.0) * 2.0 / PatchKernel::taps));
  }
};

bool smooth(uint32_t value) {
  for (const uint32_t factor : {2u, 3u, 5u})
    while (value % factor == 0) value /= factor;
  return value == 1;
}

/// Returns the Fourier transform of the kernel at `turns` per cell, by Simpson's rule.
double transformed(double turns) {
  constexpr int parts = 400;
  constexpr double half = 0.5 * PatchKernel::taps, step = 2.0 * half / parts;
  double sum = 0.0;
  for (int i = 0; i <= parts; ++i) {
    const double x = -half + i * step;
    sum += (i == 0 || i == parts ? 1.0
            : i % 2 == 1         ? 4.0
                                 : 2.0) *
           semicircle(x / half) * std::cos(2.0 * pi * turns * x);
  }
  return sum * step / 3.0;
}

}  // namespace

uint32_t PatchKernel::grid_for(uint32_t count) {
  uint32_t grid = std::max(static_cast<uint32_t>(std::ceil(oversampling * count)), 2u * taps);
  while (!smooth(grid)) ++grid;
  return grid;
}

PatchKernel::PatchKernel(uint32_t count) : count_(count), grid_(grid_for(count)), correction_(count) {
  for (uint32_t i = 0; i < count; ++i)
    correction_[i] =
        static_cast<float>(1.0 / transformed((double(i) - std::floor(0.5 * count)) / double(grid_)));
}

uint32_t PatchKernel::spread(double turns, std::array<float, taps>& weights) const {
  static const KernelTable table;
  const Begin begin = begin_of(turns);
  const double step = (1.0 - begin.between) * kernel_steps;
  const int row = std::min(static_cast<int>(step), kernel_steps - 1);
  const float part = static_cast<float>(step - row);
  for (int tap = 0; tap < taps; ++tap)
    weights[tap] = table.rows[row][tap] + part * (table.rows[row + 1][tap] - table.rows[row][tap]);
  return begin.cell;
}

}  // namespace greatx::rf
