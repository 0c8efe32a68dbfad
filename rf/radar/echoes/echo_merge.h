// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Raw echoes that no output can tell apart become one: same instance, same number of bounces, one cell of
// delay, of delay rate and of direction at both ends. The sum is exact at the carrier and the middle of the
// frame; what differs elsewhere is bounded by the size of a cell (docs/radar_echoes.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/radar/echoes/tube_echoes.h"

namespace greatx::rf {

struct MergeCells {
  double wavelength_m = 0.0;
  double length_m = 0.0;         ///< of path; 0: nothing is merged
  double rate_mps = 0.0;         ///< of path length; 0: no cells of rate
  double direction = 0.0;        ///< of unit vectors' components
  bool compare_arrival = false;  ///< bistatic
};

struct MergedEcho {
  Complex amplitude;
  uint32_t strongest = 0;  ///< the raw echo that stands for all: its directions, point and delay
  uint32_t members = 0;
};

/// `rate_mps`, `instance`: [echoes]. In the order of their cells, which are in that of instance, bounces,
/// delay, ...: a total order. Echoes whose members cancel to less than 1e-9 of the strongest one are left
/// out.
std::vector<MergedEcho> merge(const RawEchoes& raw, std::span<const double> rate_mps,
                              std::span<const uint32_t> instance, const MergeCells& cells);

}  // namespace greatx::rf
