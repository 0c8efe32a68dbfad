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

/// The light that surfaces send to a place, for normals: luminance c + dot(shape, (n, n.z^2)), and red and
/// blue over it.
struct Bounced {
  vec4 shape;
  float c;
  vec2 red_blue;
};

/// Adds `weight` times the luminance of a place at one height: its constant, and its vector with that for
/// n = +z. It returns the place's first word.
uint add_luminance(uint pair, float weight, inout float c, inout vec4 shape) {
  uvec2 words = unpackUint2x32(surrounding_pairs[pair]);
  float part = weight * unpackHalf2x16(words.x).x;
  c += part;
  float root = float(words.y >> 24);
  shape.xyz += (surroundings_vector_scale * part) * unpackSnorm4x8(words.y).xyz;
  shape.w += (surroundings_up_scale / (255.0 * 255.0) * part) * (root * root);
  return words.x;
}

vec2 root_of_red_blue(uint word) { return surroundings_color_scale * unpackUnorm4x8(word).zw; }
float ground_of(uint word) { return unpackHalf2x16(word).y; }

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
  vec4 low = vec4(0.0), high = vec4(0.0);
  float c_low = 0.0, c_high = 0.0;
  uint low_a = add_luminance(a, weights.x, c_low, low), low_b = add_luminance(b, weights.y, c_low, low),
       low_c = add_luminance(c, weights.z, c_low, low);
  uint high_a = add_luminance(a + 1u, weights.x, c_high, high),
       high_b = add_luminance(b + 1u, weights.y, c_high, high),
       high_c = add_luminance(c + 1u, weights.z, c_high, high);
  vec2 root = root_of_red_blue(low_a) * weights.x + root_of_red_blue(low_b) * weights.y +
              root_of_red_blue(low_c) * weights.z;
  float ground = dot(vec3(ground_of(high_a), ground_of(high_b), ground_of(high_c)), weights);
  float height = p.z - surroundings.floor - ground;
  float up = clamp((height - surroundings_low) / (surroundings_high - surroundings_low), 0.0, 1.0);
  Bounced bounced;
  float above = min(1.0, surroundings_high / max(height, 1.0));
  bounced.shape = mix(low, high, up) * above;
  bounced.c = mix(c_low, c_high, up) * above;
  bounced.shape.w -= bounced.c + bounced.shape.z;
  bounced.red_blue = root * root;
  return bounced;
}

/// Returns the irradiance over pi of a surface with this normal.
vec3 bounced_over_pi(Bounced bounced, vec3 n) {
  float y = max(bounced.c + dot(bounced.shape, vec4(n, n.z * n.z)), 0.0);
  float green = (1.0 - 0.2126 * bounced.red_blue.x - 0.0722 * bounced.red_blue.y) / 0.7152;
  return y * vec3(bounced.red_blue.x, green, bounced.red_blue.y);
}

vec3 stored_radiance(uint word) {
  vec3 bytes = vec3(word & 0xffu, word >> 8 & 0xffu, word >> 16 & 0xffu);
  return bytes * exp2(float(word >> 24) - 136.0);
}

/// Returns the radiance that a wall emits above or below the height of shops.
vec3 wall_glow(uint words, bool above) {
  uint word = above ? words >> 16 : words;
  vec3 parts = vec3(word & 15u, word >> 4 & 15u, word >> 8 & 15u);
  return parts * (exp2(float(word >> 12 & 15u)) / 15.0);
}

/// Returns the radiance of what stands in a cell where a ray meets it.
vec3 met_radiance(uint cell, vec2 top_bottom, float height, vec3 direction) {
  float top = top_bottom.x;
  uint at = surroundings.first_color + surroundings_color_pairs * cell;
  uvec2 words = unpackUint2x32(surrounding_pairs[at]);
  bool from_above = height > top - 0.5 * surroundings.cell_m && direction.z < 0.0;
  if (from_above) return stored_radiance(words.x);
  uvec2 wall = unpackUint2x32(surrounding_pairs[at + 1u]);
  float shadow = unpackHalf2x16(wall.x).x;
  vec3 normal = vec3(unpackSnorm4x8(wall.x).zw, 0.0);
  normal = dot(normal, direction) > 0.0 ? -normal : normal;
  vec3 albedo = unpackUnorm4x8(words.y).xyz;
  float lit = clamp(height - shadow + 0.5, 0.0, 1.0);
  float facing = max(dot(normal, surroundings.key_direction), 0.0);
  vec3 radiance = albedo * (surroundings.key_over_pi * (facing * lit) + surroundings.wall_sky);
  if (emissive_on) radiance += wall_glow(wall.y, height > top_bottom.y + surroundings_glow_split);
  return radiance;
}

/// Returns the number of a cell, or that of one in the field if the place is outside. CPU drivers convert
/// lane by lane, so floats give the number by their digits, below 2^22.
uint cell_of(vec2 at, vec2 size) {
  vec2 whole = clamp(floor(at), vec2(0.0), size - 1.0);
  return floatBitsToUint(whole.y * size.x + whole.x + 8388608.0) & 0x7fffffu;
}

/// Returns the radiance that comes to a surface along a mirrored ray: that of the surroundings which the ray
/// meets, or else `sky`. A ray leaps as far as nothing stands in its octant, and steps from cell to cell
/// elsewhere.
vec3 mirrored_surroundings(vec3 p_eye, vec3 n, vec3 direction, vec3 sky) {
  vec3 p = p_eye + camera.eye_high + n * surroundings.step_m;
  p.z -= surroundings.floor;
  p.xy = (p.xy - surroundings.corner) * surroundings.inverse_cell;
  vec3 along = direction / max(length(direction.xy), 1e-3);  // for a metre on the level
  vec2 aside = abs(along.xy);
  uint octant = (along.x < 0.0 ? surroundings_negative_x : 0u) |
                (along.y < 0.0 ? surroundings_negative_y : 0u) |
                (aside.y > aside.x ? surroundings_along_y : 0u);
  float leap_m = surroundings.cell_m / max(max(aside.x, aside.y), 0.5), least_m = 0.7 * surroundings.cell_m;
  float down_m = along.z < 0.0 ? -1.0 / along.z : 0.0;  // the way on the level for a metre down
  along.xy *= surroundings.inverse_cell;
  vec2 size = vec2(surroundings.columns, surroundings.rows);
  // The ray ends where it leaves the field, or rises above everything.
  vec2 room = (mix(p.xy, size - p.xy, greaterThan(along.xy, vec2(0.0)))) / max(abs(along.xy), vec2(1e-6));
  float end = min(room.x, room.y), up = (surroundings.most_top - p.z) / max(along.z, 1e-6);
  end = along.z > 0.0 ? min(end, up) : end;
  float gone = 0.0, height = 0.0;
  vec2 top_bottom = vec2(-1.0);
  uint cell = 0u;
  bool met = false;
  for (uint i = 0u; i < surroundings_most_steps && gone < end && !met; ++i) {
    vec3 here = p + along * gone;
    height = here.z;
    cell = cell_of(here.xy, size);
    uvec2 words = unpackUint2x32(surrounding_pairs[surroundings_header_pairs + cell]);
    top_bottom = unpackHalf2x16(words.x);
    met = height < top_bottom.x && (height > top_bottom.y || height < 0.0);
    float free = uintBitsToFloat(((words.y >> (4u * octant) & 15u) << 22) + 0x3f800000u) - 1.0;
    // A ray that goes down stops at the ground, where it meets the next cell from above.
    float down = along.z < 0.0 ? max((height - min(top_bottom.x, 0.5)) * down_m, 0.0) + 0.05 : 1e9;
    gone += min(max(free * leap_m, least_m), down);
  }
  vec3 radiance = direction.z > 0.0 ? sky : surroundings.beyond;
  if (met) radiance = met_radiance(cell, top_bottom, height, direction);
  return radiance;
}
#endif
