// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/echo_merge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/units.h"

namespace greatx::rf {
namespace {

int32_t cell(double value, double size) {
  return size > 0.0 ? static_cast<int32_t>(std::floor(std::clamp(value / size, -2e9, 2e9))) : 0;
}

/// Pack two numbers into one whose order is that of the pair.
uint64_t both(uint32_t first, uint32_t second) { return uint64_t{first} << 32 | second; }
uint64_t both_cells(int32_t first, int32_t second) {
  return both(static_cast<uint32_t>(first) ^ 0x80000000u, static_cast<uint32_t>(second) ^ 0x80000000u);
}

/// The key of a cell: instance, bounces; delay, rate; departure and arrival.
using Key = std::array<uint64_t, 5>;

Key key_of(const RawEcho& echo, double rate_mps, uint32_t instance, const MergeCells& cells) {
  std::array<int32_t, 6> ends{};
  for (int i = 0; i < 3; ++i) {
    ends[i] = cell(echo.departure[i], cells.direction);
    if (cells.compare_arrival || echo.bounces > 1) ends[3 + i] = cell(echo.arrival[i], cells.direction);
  }
  return {both(instance, echo.bounces),
          both_cells(cell(echo.length_m, cells.length_m), cell(rate_mps, cells.rate_mps)),
          both_cells(ends[0], ends[1]), both_cells(ends[2], ends[3]), both_cells(ends[4], ends[5])};
}

}  // namespace

std::vector<MergedEcho> merge(const RawEchoes& raw, std::span<const double> rate_mps,
                              std::span<const uint32_t> instance, const MergeCells& cells) {
  struct Row {
    Key key;
    uint32_t index;
    bool operator<(const Row& o) const {
      for (size_t i = 0; i < key.size(); ++i)
        if (key[i] != o.key[i]) return key[i] < o.key[i];
      return index < o.index;
    }
  };
  const bool merges = cells.length_m > 0.0;
  std::vector<Row> rows(raw.echoes.size());
  for (uint32_t i = 0; i < rows.size(); ++i)
    rows[i] = {key_of(raw.echoes[i], rate_mps[i], instance[i], cells), i};
  if (merges) std::sort(rows.begin(), rows.end());
  std::vector<MergedEcho> merged;
  const double wavenumber = 2.0 * pi / cells.wavelength_m;
  for (size_t first = 0, last = 0; first < rows.size(); first = last) {
    MergedEcho echo;
    double most = -1.0;
    for (last = first; last < rows.size() && (last == first || (merges && rows[last].key == rows[first].key));
         ++last) {
      const double power = std::norm(raw.echoes[rows[last].index].amplitude);
      if (power > most) most = power, echo.strongest = rows[last].index;
    }
    const double length = raw.echoes[echo.strongest].length_m;
    for (size_t i = first; i < last; ++i) {
      const RawEcho& member = raw.echoes[rows[i].index];
      echo.amplitude += member.amplitude * std::polar(1.0, -wavenumber * (member.length_m - length));
    }
    echo.members = static_cast<uint32_t>(last - first);
    if (std::norm(echo.amplitude) > 1e-18 * most) merged.push_back(echo);
  }
  return merged;
}

}  // namespace greatx::rf
