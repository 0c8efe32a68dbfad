#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws panes into a map of shadows. A map holds one depth a texel, so a pane fills as many texels of every
// square of 2 x 2 as quarters of the light do not pass it. A filter that weighs the four alike then lets
// the rest through (shadow_filter of camera/light.glsl).
#include "shared/pane.h"

layout(location = 0) in vec3 in_place;
layout(location = 1) flat in vec3 in_to_light;
layout(location = 2) flat in vec3 in_color;

void main() {
  vec3 normal = cross(dFdx(in_place), dFdy(in_place));
  float size = length(normal);
  float cosine = size > 0.0 ? min(abs(dot(normal, in_to_light)) / size, 1.0) : 0.0;
  uvec2 odd = uvec2(gl_FragCoord.xy) & 1u;
  // The first is a corner, the second lies across from it.
  uint number = odd.x == odd.y ? odd.x : 2u + odd.x;
  if (number >= pane_filled_quarters(in_color, cosine)) discard;
}
