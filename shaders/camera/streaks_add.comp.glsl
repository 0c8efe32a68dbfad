#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts the streaks of rain before a picture.
#include "camera/stored_color.glsl"
#include "lib/linear.glsl"
#include "shared/weather.h"

layout(local_size_x = streak_group_size) in;
layout(set = 0, binding = streaks_depth_binding, scalar) readonly buffer DepthBlock { uint optical_depth[]; };
layout(set = 0, binding = streaks_color_binding, scalar) buffer ColorBlock { uvec2 picture_color[]; };
layout(push_constant, scalar) uniform Constants { StreakConstants rain; };

void main() {
  uint element = linear_invocation;
  if (element >= rain.width * rain.height) return;
  uint hidden = optical_depth[element];
  if (hidden == 0u) return;
  vec4 color = unpack_color(picture_color[element]);
  color.rgb = mix(rain.glow, color.rgb, exp(-float(hidden) * streak_unit));
  picture_color[element] = pack_color(color);
}
