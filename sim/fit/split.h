// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Divides positions into those that a fit uses and those that are held out, by place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "sim/fit/problem.h"

namespace greatx::sim {

/// The square of the plan in which a position lies.
struct FitBlocks {
  std::vector<uint32_t> of;    ///< [positions] number of the block
  std::vector<bool> held_out;  ///< [blocks]
  size_t count() const { return held_out.size(); }
};

/// Divides the plan into squares of `block_m`, whose corners are multiples of it, and holds out the share
/// `held_out` of the occupied ones: a whole number of them, at least one if the share is above 0 and there
/// are two or more, and never all. Which ones, depends on the seed and the numbers of the squares alone.
FitBlocks split_by_place(std::span<const dvec3> positions, const FitSplit& split);

}  // namespace greatx::sim
