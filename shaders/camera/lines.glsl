// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the shares of a pixel under thin lines (renderer/camera/thin_lines.h). The camera has one view,
// whose lens does not distort; the words of its lines stand where other cameras have the pixels of their
// views.
#ifndef GREATX_CAMERA_LINES_GLSL
#define GREATX_CAMERA_LINES_GLSL
#include "camera/effects.glsl"
#include "camera/picture.glsl"
#include "camera/pixel_ray.glsl"
#include "camera/triangle.glsl"
#include "shared/lines.h"

layout(set = 0, binding = face_pixels_binding, scalar) readonly buffer LineWordsBlock { uint line_words[]; };
layout(set = 0, binding = face_pixels_binding, scalar) readonly buffer LineQuadsBlock { vec4 line_quads[]; };

/// Returns the first entry of the lines near a pixel, and the one after the last.
uvec2 lines_near(ivec2 at) {
  uvec2 tile = uvec2(at) / line_tile_pixels;
  uint word = line_header_words + 2u * (tile.y * line_words[line_columns_word] + tile.x);
  uint first = line_words[word];
  return uvec2(first, first + line_words[word + 1u]);
}

/// Returns whether a triangle (+ 1; 0: none) belongs to the line of an entry.
bool of_line(uint id, uint entry) {
  uint word = 4u * line_words[entry] + 10u;
  return id - 1u - line_words[word] < line_words[word + 1u];
}
bool of_lines(uint id, uvec2 entries) {
  bool found = false;
  for (uint entry = entries.x; entry < entries.y && !found; ++entry) found = of_line(id, entry);
  return found;
}

float ramp(float x) { return x > 0.0 ? 0.5 * x * x : 0.0; }

/// Returns the share of a unit square below a straight line `t` above its middle, along a unit normal whose
/// larger and smaller component are wide + slim and wide - slim, up to their signs.
float share_below(float t, float wide, float slim) {
  t = clamp(t, -wide, wide);
  return (ramp(t + wide) - ramp(t + slim) - ramp(t - slim)) / (wide * wide - slim * slim);
}

/// Holds the shares of a pixel under the two halves of a line, and its place there: from 0 to 1 along it,
/// pixels from the axis to the pixel's middle, half its width, and one over its planar depth.
struct LineShares {
  vec2 shares;
  float place, away, half_width, nearness;
};

LineShares line_shares(uint quad, vec2 pixel) {
  vec4 axis = line_quads[quad], sizes = line_quads[quad + 1u];
  float length_px = line_quads[quad + 3u].x;
  vec2 from_start = pixel - axis.xy;
  float along = dot(from_start, axis.zw);
  LineShares line;
  line.shares = vec2(0.0);
  line.place = clamp(along / length_px, 0.0, 1.0);
  line.away = dot(from_start, vec2(-axis.w, axis.z));
  line.half_width = mix(sizes.x, sizes.y, line.place);
  line.nearness = mix(sizes.z, sizes.w, line.place);
  vec2 sides = max(abs(axis.zw), vec2(1e-3));
  float wide = 0.5 * (sides.x + sides.y), slim = 0.5 * abs(sides.x - sides.y);
  bool near = abs(line.away) < line.half_width + wide && along > -wide && along < length_px + wide;
  if (near) {
    float between = share_below(length_px - along, wide, slim) - share_below(-along, wide, slim);
    float low = share_below(-line.away - line.half_width, wide, slim),
          middle = share_below(-line.away, wide, slim),
          high = share_below(-line.away + line.half_width, wide, slim);
    line.shares = between * vec2(middle - low, high - middle);
  }
  return line;
}

/// Holds what is left of a pixel's lines: entries, the half that comes next, the share that lines have left,
/// triangle + 1 that the centre sees, and the planar depth of what stands behind.
struct LinesLeft {
  uvec2 entries;
  uint half_of_line;
  float through;
  uint seen;
  float behind;
};

/// Holds the half of a line in a pixel: the triangle + 1, the share, the ray to its middle, and its planar
/// depth.
struct LinePart {
  uint id;
  float share;
  vec3 ray;
  float depth;
};

/// Returns the next half of a line that covers a part of the pixel; its share is 0 if there is none. Shares
/// of several lines add up, to the whole at most.
LinePart next_part(inout LinesLeft left, vec2 pixel) {
  LinePart part = LinePart(0u, 0.0, vec3(0.0), 0.0);
  while (left.entries.x < left.entries.y && part.share == 0.0) {
    uint entry = left.entries.x, quad = line_words[entry], number = left.half_of_line;
    LineShares line = line_shares(quad, pixel);
    bool hidden = line.nearness * left.behind < 0.999 && !of_line(left.seen, entry);
    bool none = hidden || line.shares.x + line.shares.y < line_least_share;
    if (none || number == 1u) ++left.entries.x;
    left.half_of_line = none || number == 1u ? 0u : 1u;
    float share = none ? 0.0 : min(number == 0u ? line.shares.x : line.shares.y, left.through);
    if (share > 0.0) {
      left.through -= share;
      vec2 direction = line_quads[quad].zw, normal = vec2(-direction.y, direction.x);
      // The place on the half's middle that is nearest to the pixel's.
      float along = dot(pixel - line_quads[quad].xy, direction), length_px = line_quads[quad + 3u].x;
      vec2 place = pixel + normal * ((number == 0u ? -0.5 : 0.5) * line.half_width - line.away) +
                   direction * (clamp(along, 0.0, length_px) - along);
      part.share = share;
      part.depth = 1.0 / line.nearness;
      part.ray = pixel_ray(place);
      part.id = line_words[4u * quad + 8u + number];
      vec2 b = barycentrics(see(part.id - 1u), part.ray);
      bool beside = b.x < 0.0 || b.y < 0.0 || b.x + b.y > 1.0;
      if (beside) ++part.id;  // the other triangle of the side
    }
  }
  return part;
}
#endif
