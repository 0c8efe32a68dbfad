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

/// First come the steps, a pair of words for each cell: halves (top, bottom), then how far a ray may leap in
/// each octant of directions, four bits each. q stands for (1 + (q & 1) / 2) 2^(q >> 1) columns or rows of
/// cells, the own one included.
/// The colours follow, two pairs for each cell. The first holds the radiance of the top, and the albedo of
/// the wall (three bytes). The second holds the half of the shadow's height, and x and y of the wall's normal
/// (two signed bytes), and then the radiances that the wall emits below and above surroundings_glow_split, 16
/// bits each. A radiance is three bytes and an exponent: byte * 2^(exponent - 136). An emitted one has four
/// bits for each of them: q / 15 * 2^exponent cd/m^2.
const uint surroundings_color_pairs = 2u;
/// The bits of an octant's number.
const uint surroundings_negative_x = 1u;
const uint surroundings_negative_y = 2u;
const uint surroundings_along_y = 4u;  ///< y changes more than x
/// A place of bounced light is two pairs of words, for the low and for the high height. The first word has a
/// half, the constant c of the luminance, and then the square roots of red and blue over luminance (bytes
/// over surroundings_color_scale, low height) or the ground's height (a half, high height). The second word
/// has three signed bytes, the vector v of the luminance over surroundings_vector_scale c, and a byte, the
/// root of the luminance u for n = +z over surroundings_up_scale c. The luminance of a surface with normal n
/// is c + v . n + (u - c - v_z) n_z^2. The low place has the light of level ground for n = +z.
const uint surroundings_place_pairs = 2u;
const float surroundings_color_scale = 2.0f;   ///< the largest square root
const float surroundings_vector_scale = 2.0f;  ///< the longest vector over c
const float surroundings_up_scale = 4.0f;      ///< the most luminance for n = +z over c
/// The height over the bottom of a column below which its wall emits the lower one of two radiances, m: shops
/// are no higher.
const float surroundings_glow_split = 4.5f;
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
  uint first_color;    ///< pairs of words from the beginning
  uint first_place;    ///< the same
  float most_top;      ///< highest top
  vec3 key_direction;  ///< unit, to the key light
  vec3 key_over_pi;    ///< light of the key light on a facing surface, over pi
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
