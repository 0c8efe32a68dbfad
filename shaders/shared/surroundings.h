// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The coarse model of the static world for reflected light (renderer/light/surroundings.h), as shaders see
// it.
#ifndef GREATX_SHADERS_SHARED_SURROUNDINGS_H
#define GREATX_SHADERS_SHARED_SURROUNDINGS_H
#include "glsl.h"

GREATX_SHARED_BEGIN

const uint surroundings_binding = 22u;  // storage: SurroundingsHeader, then cells, then places

/// A cell is two pairs of words. The first holds halves (top, shadow; bottom) and then the distance in cells
/// to the nearest cell in which something stands. The second holds the radiance of the top, and the albedo of
/// the wall (three bytes) with the turn of its normal (a byte). A radiance is three bytes and an exponent:
/// byte * 2^(exponent - 136).
const uint surroundings_cell_pairs = 2u;
/// A place of bounced light is three pairs of words in halves: luminance at the low and at the high height
/// (constant, x, y, z each), then red and blue over luminance, the ground's height, nothing.
const uint surroundings_place_pairs = 3u;
/// The heights over the ground at which bounced light is known, m.
const float surroundings_low = 1.5f;
const float surroundings_high = 16.0f;
/// The cells from place to place.
const uint surroundings_place_cells = 2u;
/// The most steps of a mirrored ray.
const uint surroundings_most_steps = 16u;
/// Surfaces up to this roughness mirror the surroundings; beyond it the image fades.
const float surroundings_most_roughness = 0.25f;
const float surroundings_fade = 0.1f;

struct SurroundingsHeader {
  vec2 corner;         ///< local x, y of the first cell's corner
  float inverse_cell;  ///< cells a metre
  float cell_m;
  float floor;   ///< local z from which heights are counted
  float step_m;  ///< m along the normal from a surface to the place that is looked up
  uint columns;
  uint rows;
  uint place_columns;
  uint place_rows;
  uint first_place;    ///< pairs of words from the beginning
  float most_top;      ///< highest top
  vec3 key_direction;  ///< unit, to the key light
  float pad;
  vec3 key_over_pi;  ///< light of the key light on a facing surface, over pi
  float pad0;
  vec3 wall_sky;  ///< radiance of a white wall in the shade
  float pad1;
  vec3 beyond;  ///< radiance of the ground beyond the cells
  float pad2;
};
const uint surroundings_header_pairs = 14u;

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::SurroundingsHeader) == 8 * greatx::shared::surroundings_header_pairs);
#endif
#endif
