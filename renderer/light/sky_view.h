// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the share of the sky that a place sees, so that streets are darker than roofs in the shade. It is an
// approximation: the static world is a field of heights, with its horizon in some directions and shares at a
// few heights above the floor. Small objects (a sill, a car) and objects overhead (a bridge, a crown seen
// from below) hide nothing. docs/light.md has the errors.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

/// Holds heights over a square of cells, in metres above `floor`; 0 where nothing stands.
struct HeightField {
  dvec2 corner{0.0};  ///< local x, y of the first cell's corner
  double cell_m = 1.0, floor = 0.0;
  uint32_t width = 1, height = 1;
  std::vector<float> heights;  ///< [height, width] of the highest static surface in the cell
};
/// Returns the heights of everything static, with at most `edge` cells along a side.
HeightField height_field(const scene::Scene& scene, uint32_t edge = 256);

/// Returns the share of an unobstructed sky's illuminance on a level surface at `above` metres over a cell: 1
/// - mean over azimuth of sin^2(horizon). It is exact for the samples of the horizon.
double sky_share(const HeightField& field, uint32_t column, uint32_t row, double above);

/// Returns the map that shaders read. It is half floats [height, width, 4]: the floor over field.floor, and
/// the shares at 0, sky_view_middle and sky_view_top above it.
std::vector<uint16_t> sky_view_texels(const HeightField& field);
/// Fills in the map's part of the lighting block.
void describe_sky_view(const HeightField& field, shared::GpuLighting& block);

}  // namespace greatx::render
