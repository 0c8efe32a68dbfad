// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/split.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/random.h"

namespace greatx::sim {

FitBlocks split_by_place(std::span<const dvec3> positions, const FitSplit& split) {
  using Square = std::pair<int64_t, int64_t>;
  const auto square_of = [&](const dvec3& at) {
    return Square(static_cast<int64_t>(std::floor(at.x / split.block_m)),
                  static_cast<int64_t>(std::floor(at.y / split.block_m)));
  };
  std::map<Square, uint32_t> numbers;
  for (const dvec3& position : positions) numbers.emplace(square_of(position), 0u);
  uint32_t next = 0;
  std::vector<std::tuple<double, Square, uint32_t>> drawn;
  for (auto& [square, number] : numbers) {
    number = next++;
    RandomStream random(split.seed, static_cast<uint32_t>(square.first),
                        static_cast<uint32_t>(square.second));
    drawn.emplace_back(random.uniform(), square, number);
  }
  std::ranges::sort(drawn);
  FitBlocks blocks;
  for (const dvec3& position : positions) blocks.of.push_back(numbers.at(square_of(position)));
  blocks.held_out.assign(numbers.size(), false);
  if (split.held_out > 0.0 && numbers.size() > 1) {
    const double wanted = std::round(split.held_out * static_cast<double>(numbers.size()));
    const auto count = static_cast<size_t>(std::clamp(wanted, 1.0, static_cast<double>(numbers.size() - 1)));
    for (size_t i = 0; i < count; ++i) blocks.held_out[std::get<2>(drawn[i])] = true;
  }
  return blocks;
}

}  // namespace greatx::sim
