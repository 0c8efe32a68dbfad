#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Spreads a part of the light over the picture, as a lens does. One dispatch is one step of
// renderer/camera/glare.h: it shrinks a level, adds a coarser level to a level, or adds the sum to the
// picture.
#include "camera/stored_color.glsl"
#include "shared/camera.h"
#include "shared/weather.h"

layout(local_size_x = shade_group_width, local_size_y = shade_group_height) in;
layout(set = 0, binding = glare_from_binding, scalar) readonly buffer FromBlock { uvec2 from_color[]; };
layout(set = 0, binding = glare_to_binding, scalar) buffer ToBlock { uvec2 to_color[]; };
layout(push_constant, scalar) uniform Constants { GlareConstants glare; };

vec3 from_at(ivec2 at) {
  ivec2 p = clamp(at, ivec2(0), ivec2(glare.width, glare.height) - 1);
  return unpack_color(from_color[uint(p.y) * glare.width + uint(p.x)]).rgb;
}

/// Returns a pixel of the level above: 4 x 4 pixels weighed by 1, 3, 3, 1.
vec3 shrunk(ivec2 at) {
  const float weights[4] = float[](0.125, 0.375, 0.375, 0.125);
  vec3 sum = vec3(0.0);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) sum += weights[i] * weights[j] * from_at(2 * at + ivec2(i - 1, j - 1));
  return sum;
}

/// Returns the coarser level at the middle of a pixel, interpolated.
vec3 enlarged(ivec2 at) {
  ivec2 first = (at + 1) / 2 - 1;
  vec2 f = 0.25 + 0.5 * vec2((at + 1) & 1);
  vec3 low = mix(from_at(first), from_at(first + ivec2(1, 0)), f.x);
  vec3 high = mix(from_at(first + ivec2(0, 1)), from_at(first + ivec2(1, 1)), f.x);
  return mix(low, high, f.y);
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, ivec2(glare.to_width, glare.to_height)))) return;
  uint element = uint(at.y) * glare.to_width + uint(at.x);
  vec4 color = vec4(0.0);
  if (glare.step == 0u) {
    color.rgb = shrunk(at);
  } else {
    color = unpack_color(to_color[element]);
    color.rgb = mix(enlarged(at), color.rgb, glare.keep);
  }
  to_color[element] = pack_color(color);
}
