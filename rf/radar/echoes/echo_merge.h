// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Merges raw echoes that no output can tell apart: those with the same instance, the same number of bounces,
// and the same cell of delay, of delay rate and of direction at both ends. The sum is exact at the carrier
// and in the middle of the frame. Elsewhere the size of a cell bounds its error (docs/radar_echoes.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/radar/echoes/tube_echoes.h"

namespace greatx::rf {

/// Holds the sizes of the cells in which echoes are merged.
struct MergeCells {
  double wavelength_m = 0.0;
  double length_m = 0.0;         ///< path length; 0: nothing is merged
  double rate_mps = 0.0;         ///< rate of the path length; 0: rates are not compared
  double direction = 0.0;        ///< components of the unit vectors of direction
  bool compare_arrival = false;  ///< true for a bistatic radar
};

struct MergedEcho {
  Complex amplitude;
  uint32_t strongest = 0;  ///< index of the raw echo that gives directions, point and delay
  uint32_t members = 0;
};

/// Returns the merged echoes in a total order: that of instance, bounces and the cells of delay, rate and
/// directions, or that of the raw echoes if nothing is merged. `rate_mps` and `instance` are [echoes]. A
/// merged echo is left out if its members cancel to less than 1e-9 of the strongest member.
std::vector<MergedEcho> merge(const RawEchoes& raw, std::span<const double> rate_mps,
                              std::span<const uint32_t> instance, const MergeCells& cells);

}  // namespace greatx::rf
