// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the sky with its clouds as pictures show it: the half above the horizon, finer than the environment
// map.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "renderer/light/sky.h"

namespace greatx::render {

/// Returns the unit direction of a place u, v in [0, 1] of the panorama: the upper half of an octahedron,
/// turned by 45 degrees so that it fills the square.
dvec3 panorama_direction(double u, double v);
/// Returns u, v of a direction with z >= 0 of any length but 0.
dvec2 panorama_uv(const dvec3& direction);

/// Returns half floats [size, size, 4]: the sky's radiance over `scale`, and the share of light from beyond
/// the clouds that they let pass.
std::vector<uint16_t> bake_panorama(const Sky& sky, uint32_t size, double scale);

}  // namespace greatx::render
