// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Looks up the light that the static world reflects: the light of one bounce at a place, and the mirror image
// in smooth surfaces (renderer/light/surroundings.h makes the data).
#ifndef GREATX_CAMERA_SURROUNDINGS_GLSL
#define GREATX_CAMERA_SURROUNDINGS_GLSL
#include "camera/effects.glsl"
#include "camera/visibility_view.glsl"
#include "shared/surroundings.h"

layout(set = 0, binding = surroundings_binding, scalar) readonly buffer SurroundingsBlock {
  SurroundingsHeader surroundings;
};
layout(set = 0, binding = surroundings_binding, scalar) readonly buffer SurroundingPairsBlock {
  uint64_t surrounding_pairs[];
};

/// The light that surfaces send to a place, for normals: luminance c.x + dot(c.yzw, n), and red and blue over
/// it.
struct Bounced {
  vec4 luminance;
  vec2 red_blue;
};

vec4 four_halves(uint64_t pair) {
  uvec2 words = unpackUint2x32(pair);
  return vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y));
}

/// Returns the bounced light at a point. Three places of the grid stand around it: the corners of the half of
/// a square in which it lies.
Bounced bounced_at(vec3 p_eye, vec3 n) {
  vec3 p = p_eye + camera.eye_high + n * surroundings.step_m;
  vec2 most = vec2(surroundings.place_columns, surroundings.place_rows) - 1.001;
  float places_a_metre = surroundings.inverse_cell / float(surroundings_place_cells);
  vec2 at = (p.xy - surroundings.corner) * places_a_metre - 0.5;
  at = clamp(at, vec2(0.0), most);
  vec2 whole = floor(at), part = at - whole;
  bool right = part.x > part.y;
  uint first = uint(whole.y) * surroundings.place_columns + uint(whole.x);
  uint last = first + surroundings.place_columns + 1u;
  uint middle = right ? first + 1u : last - 1u;
  float big = max(part.x, part.y), small = min(part.x, part.y);
  vec3 weights = vec3(1.0 - big, big - small, small);
  uint a = surroundings.first_place + surroundings_place_pairs * first;
  uint b = surroundings.first_place + surroundings_place_pairs * middle;
  uint c = surroundings.first_place + surroundings_place_pairs * last;
  vec4 low = four_halves(surrounding_pairs[a]) * weights.x + four_halves(surrounding_pairs[b]) * weights.y +
             four_halves(surrounding_pairs[c]) * weights.z;
  vec4 high = four_halves(surrounding_pairs[a + 1u]) * weights.x +
              four_halves(surrounding_pairs[b + 1u]) * weights.y +
              four_halves(surrounding_pairs[c + 1u]) * weights.z;
  vec4 rest = four_halves(surrounding_pairs[a + 2u]) * weights.x +
              four_halves(surrounding_pairs[b + 2u]) * weights.y +
              four_halves(surrounding_pairs[c + 2u]) * weights.z;
  float height = p.z - surroundings.floor - rest.z;
  float up = clamp((height - surroundings_low) / (surroundings_high - surroundings_low), 0.0, 1.0);
  Bounced bounced;
  bounced.luminance = mix(low, high, up) * min(1.0, surroundings_high / max(height, 1.0));
  bounced.red_blue = rest.xy;
  return bounced;
}

/// Returns the irradiance over pi of a surface with this normal.
vec3 bounced_over_pi(Bounced bounced, vec3 n) {
  float y = max(bounced.luminance.x + dot(bounced.luminance.yzw, n), 0.0);
  float green = (1.0 - 0.2126 * bounced.red_blue.x - 0.0722 * bounced.red_blue.y) / 0.7152;
  return y * vec3(bounced.red_blue.x, green, bounced.red_blue.y);
}

vec3 stored_radiance(uint word) {
  vec3 bytes = vec3(word & 0xffu, word >> 8 & 0xffu, word >> 16 & 0xffu);
  return bytes * exp2(float(word >> 24) - 136.0);
}

/// Returns the radiance of what stands in a cell where a ray meets it.
vec3 met_radiance(uint cell, float shadow, float top, float height, vec3 direction) {
  uvec2 words = unpackUint2x32(surrounding_pairs[cell + 1u]);
  bool from_above = height > top - 0.5 * surroundings.cell_m && direction.z < 0.0;
  if (from_above) return stored_radiance(words.x);
  float turn = float(words.y >> 24) * (6.28318531 / 256.0);
  vec3 normal = vec3(cos(turn), sin(turn), 0.0);
  normal = dot(normal, direction) > 0.0 ? -normal : normal;
  vec3 albedo = vec3(words.y & 0xffu, words.y >> 8 & 0xffu, words.y >> 16 & 0xffu) * (1.0 / 255.0);
  float lit = clamp(height - shadow + 0.5, 0.0, 1.0);
  float facing = max(dot(normal, surroundings.key_direction), 0.0);
  return albedo * (surroundings.key_over_pi * (facing * lit) + surroundings.wall_sky);
}

/// Returns the radiance that comes to a surface along a mirrored ray: that of the surroundings which the ray
/// meets, or else `sky`. A ray leaps as far as nothing stands near, and steps from cell to cell elsewhere.
vec3 mirrored_surroundings(vec3 p_eye, vec3 n, vec3 direction, vec3 sky) {
  vec3 p = p_eye + camera.eye_high + n * surroundings.step_m;
  p.z -= surroundings.floor;
  vec2 at = (p.xy - surroundings.corner) * surroundings.inverse_cell;
  float level = max(length(direction.xy), 1e-3);
  vec3 along = direction / level;  // for a metre on the level
  vec2 size = vec2(surroundings.columns, surroundings.rows);
  float gone = 0.0;
  vec3 radiance = direction.z > 0.0 ? sky : surroundings.beyond;
  for (uint i = 0u; i < surroundings_most_steps; ++i) {
    vec2 here = at + along.xy * (gone * surroundings.inverse_cell);
    float height = p.z + along.z * gone;
    bool outside = any(lessThan(here, vec2(0.0))) || any(greaterThanEqual(here, size)) ||
                   (along.z > 0.0 && height > surroundings.most_top);
    if (outside) break;
    uint cell = surroundings_header_pairs +
                surroundings_cell_pairs * (uint(here.y) * surroundings.columns + uint(here.x));
    uvec2 words = unpackUint2x32(surrounding_pairs[cell]);
    vec2 top_shadow = unpackHalf2x16(words.x);
    float bottom = unpackHalf2x16(words.y & 0xffffu).x;
    bool met = height < top_shadow.x && (height > bottom || height < 0.0);
    if (met) {
      radiance = met_radiance(cell, top_shadow.y, top_shadow.x, height, direction);
      break;
    }
    float leap = max(float(words.y >> 16) - 1.0, 0.7) * surroundings.cell_m;
    // A ray that goes down stops at the ground, where it meets the next cell from above.
    float down = along.z < 0.0 ? max((height - min(top_shadow.x, 0.5)) / -along.z, 0.0) + 0.05 : 1e9;
    gone += min(leap, down);
  }
  return radiance;
}
#endif
