#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws drops that fall while a picture is exposed. Each drop sweeps a strip, and a point of the strip is
// behind the drop for a part of the exposure. The sum of what a drop hides is the area of its disc, whatever
// the exposure. Optical depths are added as whole numbers, so their order does not matter.
#include "lib/linear.glsl"
#include "shared/random.h"
#include "shared/weather.h"

layout(local_size_x = streak_group_size) in;
layout(set = 0, binding = streaks_seen_binding, scalar) readonly buffer SeenBlock { uvec2 picture_seen[]; };
layout(set = 0, binding = streaks_depth_binding, scalar) buffer DepthBlock { uint optical_depth[]; };
layout(push_constant, scalar) uniform Constants { StreakConstants rain; };

const float disc = 0.785398;  // area of a disc over the square around it
const int most_steps = 1024;
const int most_across = 64;

void add(vec2 pixel, float hidden, float z) {
  if (pixel.x < 0.0 || pixel.y < 0.0 || pixel.x >= float(rain.width) || pixel.y >= float(rain.height)) return;
  uint element = uint(pixel.y) * rain.width + uint(pixel.x);
  if (uintBitsToFloat(picture_seen[element].x) < z) return;
  atomicAdd(optical_depth[element], uint(-log(1.0 - hidden) * (1.0 / streak_unit) + 0.5));
}

void main() {
  uint i = linear_invocation;
  if (i >= rain.count) return;
  uvec4 a = random_bits(rain.key.x, rain.key.y, rain.tick, i, 0u);
  float z = rain.reach * pow(unit_float(a.x), 1.0 / 3.0);
  if (z < rain.nearest) return;
  vec2 size = vec2(float(rain.width), float(rain.height));
  vec2 pixel = (0.5 + streak_margin * (vec2(unit_float(a.y), unit_float(a.z)) - 0.5)) * size;
  vec3 p = vec3((pixel - rain.center) / rain.focal, 1.0) * z;
  float diameter_mm = min(least_drop_mm - log(1.0 - unit_float(a.w)) / rain.slope, most_drop_mm);
  float diameter = 1e-3 * diameter_mm;
  vec3 velocity = rain.fall * terminal_velocity(diameter_mm) + rain.drift;
  float speed = max(length(velocity), 1e-3);
  vec3 half_way = velocity * (0.5 * (rain.shutter + diameter / speed));
  vec3 begin = p - half_way, end = p + half_way;
  if (min(begin.z, end.z) < 0.5 * rain.nearest) return;
  vec2 b = begin.xy / begin.z * rain.focal + rain.center, e = end.xy / end.z * rain.focal + rain.center;
  vec2 way = e - b;
  float width = diameter / z * rain.focal.x, far = length(way);
  if (far < 0.01) return;
  float hides = disc * min(width / far, 1.0);
  bool steep = abs(way.y) > abs(way.x);
  float along = steep ? abs(way.y) : abs(way.x);
  float across = 0.5 * width * far / along;
  int steps = clamp(int(ceil(along)), 1, most_steps);
  float share = hides * along / float(steps);
  for (int k = 0; k < steps; ++k) {
    vec2 c = b + way * ((float(k) + 0.5) / float(steps));
    float middle = steep ? c.x : c.y, low = middle - across, high = middle + across;
    float first = floor(low);
    for (int j = 0; j < most_across; ++j) {
      float cell = first + float(j);
      if (cell >= high) break;
      float covered = min(high, cell + 1.0) - max(low, cell);
      add(steep ? vec2(cell, floor(c.y)) : vec2(floor(c.x), cell), min(share * covered, 0.99), z);
    }
  }
}
