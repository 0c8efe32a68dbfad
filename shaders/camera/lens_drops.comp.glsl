#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws drops on the glass before a lens (renderer/camera/lens_drops.h). The lens is focused on the
// distance, so the light of a pixel passes the glass over a disc as large as the pupil. The parts of that
// disc under drops show the picture where their refracted rays go.
#include "camera/stored_color.glsl"
#include "shared/camera.h"
#include "shared/lens_drops.h"

layout(local_size_x = shade_group_width, local_size_y = shade_group_height) in;
layout(set = 0, binding = drops_color_binding, scalar) buffer ColorBlock { uvec2 picture_color[]; };
layout(set = 0, binding = drops_small_binding, scalar) buffer SmallBlock { uvec2 small_color[]; };
layout(set = 0, binding = drops_words_binding, scalar) readonly buffer WordsBlock { uint words[]; };
layout(push_constant, scalar) uniform Constants { DropConstants drops; };

ivec2 small_size() { return (ivec2(drops.width, drops.height) + int(drops_block) - 1) / int(drops_block); }

void shrink(ivec2 at) {
  ivec2 first = at * int(drops_block), end = min(first + int(drops_block), ivec2(drops.width, drops.height));
  vec3 sum = vec3(0.0);
  for (int y = first.y; y < end.y; ++y)
    for (int x = first.x; x < end.x; ++x) sum += unpack_color(picture_color[y * int(drops.width) + x]).rgb;
  ivec2 size = end - first;
  small_color[at.y * small_size().x + at.x] = pack_color(vec4(sum / float(size.x * size.y), 1.0));
}

vec3 small_at(ivec2 at) {
  at = clamp(at, ivec2(0), small_size() - 1);
  return unpack_color(small_color[at.y * small_size().x + at.x]).rgb;
}

/// Returns the small picture at a place of the picture, interpolated. Beyond the rim the rim goes on.
vec3 picture_at(vec2 pixel) {
  vec2 at = clamp(pixel, vec2(0.0), vec2(drops.width, drops.height)) / float(drops_block) - 0.5;
  ivec2 first = ivec2(floor(at));
  vec2 f = at - vec2(first);
  return mix(mix(small_at(first), small_at(first + ivec2(1, 0)), f.x),
             mix(small_at(first + ivec2(0, 1)), small_at(first + ivec2(1, 1)), f.x), f.y);
}

/// Returns the light that comes through a drop.
vec3 through_drop(vec2 offset, float radius, vec3 ray) {
  DropWay way = way_through_drop(offset, radius, drops.contact, ray);
  if (way.share <= 0.0 || way.direction.z < 0.05) return vec3(0.0);
  return way.share * picture_at(way.direction.xy / way.direction.z * drops.focal + drops.center);
}

void draw(ivec2 at) {
  uint tile = uint(at.y) / drops_tile * drops.tiles_across + uint(at.x) / drops_tile;
  uint first = words[tile], end = words[tile + 1u];
  if (first == end) return;
  vec2 slope = (vec2(at) + 0.5 - drops.center) / drops.focal;
  vec3 ray = normalize(vec3(slope, 1.0));
  // Neighbours turn the pattern of points differently (J. Jimenez, "Next Generation Post Processing in Call
  // of Duty: Advanced Warfare", 2014).
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(vec2(at), vec2(0.06711056, 0.00583715))));
  vec3 sum = vec3(0.0);
  float covered = 0.0;
  for (uint k = 0u; k < drops_samples; ++k) {
    // Points of a disc, each for the same area (H. Vogel, Math. Biosci. 44 (1979), pp. 179-189).
    float angle = turn + 2.3999632 * float(k);
    float r = drops.radius * sqrt((float(k) + 0.5) / float(drops_samples));
    vec2 place = slope * drops.glass + r * vec2(cos(angle), sin(angle));
    bool found = false;
    for (uint i = first; i < end && !found; ++i) {
      uint word = words[i];
      vec2 offset = place - uintBitsToFloat(uvec2(words[word], words[word + 1u]));
      float radius = uintBitsToFloat(words[word + 2u]);
      found = dot(offset, offset) < radius * radius;
      if (found) sum += through_drop(offset, radius, ray);
    }
    covered += found ? 1.0 : 0.0;
  }
  if (covered == 0.0) return;
  uint element = uint(at.y) * drops.width + uint(at.x);
  vec4 color = unpack_color(picture_color[element]);
  color.rgb = (color.rgb * (float(drops_samples) - covered) + sum) / float(drops_samples);
  picture_color[element] = pack_color(color);
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (drops.step == 0u) {
    if (all(lessThan(at, small_size()))) shrink(at);
  } else if (all(lessThan(at, ivec2(drops.width, drops.height)))) {
    draw(at);
  }
}
