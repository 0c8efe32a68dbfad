// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Sorts the shadows of moving bodies into a grid of the sun's x and y, so that a pixel looks only at the
// shadows that may fall on it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shaders/shared/camera.h"

namespace greatx::render {

/// Returns the words that shaders read (shaders/shared/camera.h, ShadowTilesHeader): the header, a word for
/// each cell, and each cell's tiles in the order of `tiles`. A cell names every tile whose square comes near
/// it. Throws UserError if a cell has more tiles than its word can count.
std::vector<uint32_t> shadow_grid(std::span<const shared::GpuShadowTile> tiles);

}  // namespace greatx::render
