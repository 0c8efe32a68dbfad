// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds what stands behind thin lines. The including shader has visible_at().
#ifndef GREATX_CAMERA_BEHIND_LINES_GLSL
#define GREATX_CAMERA_BEHIND_LINES_GLSL
#include "camera/lines.glsl"

/// Returns triangle + 1 that stands behind the lines at a pixel whose centre sees `id`: that itself, or what
/// a neighbour sees across the line. `at` becomes the pixel that sees it.
uint behind_lines(inout ivec2 at, uint id, uvec2 entries) {
  for (uint entry = entries.x; entry < entries.y; ++entry) {
    if (!of_line(id, entry)) continue;
    uint quad = line_words[entry];
    vec2 direction = line_quads[quad].zw;
    float away = dot(vec2(at) + 0.5 - line_quads[quad].xy, vec2(-direction.y, direction.x));
    bool upright = abs(direction.y) > abs(direction.x);
    // The normal's component along the way says to which side the nearer rim lies.
    float to = (upright ? -direction.y : direction.x) * away;
    ivec2 way = (upright ? ivec2(1, 0) : ivec2(0, 1)) * (to < 0.0 ? -1 : 1);
    for (int k = 1; k <= 3; ++k) {
      ivec2 here = clamp(at + k * way, ivec2(0), picture_size() - 1),
            there = clamp(at - k * way, ivec2(0), picture_size() - 1);
      uint one = visible_at(here, 0u), other = visible_at(there, 0u);
      bool first = !of_lines(one, entries);
      if (first || !of_lines(other, entries)) {
        at = first ? here : there;
        return first ? one : other;
      }
    }
    break;
  }
  return id;
}
#endif
