#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Smooths edges from one sample a pixel. Where neighbours see different triangles, the outline of the nearer
// one is known exactly. The length by which it reaches between the two centres gives the share that it covers
// of each pixel (after E. Persson, "Geometry Buffer Anti-Aliasing", 2011).
#include "camera/effects.glsl"
#include "camera/lens_ray.glsl"
#include "camera/lines.glsl"
#include "camera/picture.glsl"
#include "camera/reach.glsl"

layout(local_size_x = shade_group_width, local_size_y = shade_group_height) in;
layout(set = 0, binding = edges_seen_binding, scalar) readonly buffer SeenBlock { uvec2 picture_seen[]; };
layout(set = 0, binding = edges_from_binding, scalar) readonly buffer FromColorBlock { uvec2 from_color[]; };
layout(set = 0, binding = edges_to_binding, scalar) writeonly buffer ToColorBlock { uvec2 to_color[]; };
layout(set = 0, binding = edges_luminance_from_binding, scalar) readonly buffer FromLuminanceBlock {
  float from_luminance[];
};
layout(set = 0, binding = edges_luminance_to_binding, scalar) writeonly buffer ToLuminanceBlock {
  float to_luminance[];
};

/// Holds colour and luminance of a pixel. A member that is not wanted is 0.
struct Shaded {
  vec4 color;
  float luminance;
};

Shaded shaded(ivec2 at) {
  uint element = picture_element(at);
  Shaded pixel = Shaded(vec4(0.0), 0.0);
  if (color_on) pixel.color = unpack_color(from_color[element]);
  if (luminance_on) pixel.luminance = from_luminance[element];
  return pixel;
}

ivec2 step_to(int k) { return ivec2(k == 0 ? -1 : k == 1 ? 1 : 0, k == 2 ? -1 : k == 3 ? 1 : 0); }
uint neighbor(ivec2 at, int k) {
  return picture_element(clamp(at + step_to(k), ivec2(0), picture_size() - 1));
}

/// Returns the pixel, mixed with the triangles of those neighbours whose bits are set in `differing`, each by
/// the share that it covers.
Shaded smoothed(ivec2 at, uvec2 mine, uint differing, Shaded pixel) {
  vec2 place = own_place(at);
  vec3 ray = pixel_ray(place);
  Shaded across = Shaded(vec4(0.0), 0.0), down = across;
  vec2 share = vec2(0.0);
  while (differing != 0u) {
    int k = findLSB(differing);
    differing &= differing - 1u;
    uvec2 other = picture_seen[neighbor(at, k)];
    // Triangles of one flat face have no edge between them.
    bool edge = mine.y == 0u || other.y == 0u || scene_facet(mine.y - 1u) != scene_facet(other.y - 1u);
    if (edge) {
      ivec2 there = at + step_to(k);
      vec3 other_ray = faces_on ? ray + face_step(step_to(k), place) : pixel_ray(pinhole_place(there));
      bool nearer = uintBitsToFloat(mine.x) <= uintBitsToFloat(other.x);
      Seen seen = see((nearer ? mine.y : other.y) - 1u);
      float covered = nearer ? reach(seen, ray, other_ray - ray) : reach(seen, other_ray, ray - other_ray);
      float weight = clamp(nearer ? 0.5 - covered : covered - 0.5, 0.0, 0.5);
      Shaded other_pixel = shaded(there);
      vec2 part = k < 2 ? vec2(weight, 0.0) : vec2(0.0, weight);
      across.color += part.x * other_pixel.color;
      across.luminance += part.x * other_pixel.luminance;
      down.color += part.y * other_pixel.color;
      down.luminance += part.y * other_pixel.luminance;
      share += part;
    }
  }
  // An edge crosses both axes. The axis to which it is steeper gives the share.
  bool steep = share.y > share.x;
  float rest = 1.0 - (steep ? share.y : share.x);
  return Shaded(pixel.color * rest + (steep ? down.color : across.color),
                pixel.luminance * rest + (steep ? down.luminance : across.luminance));
}

void main() {
  ivec2 at = own_pixel();
  if (outside_picture(at)) return;
  uint element = picture_element(at);
  uvec2 mine = picture_seen[element];
  uint differing = 0u;
  for (int k = 0; k < 4; ++k) differing |= uint(picture_seen[neighbor(at, k)].y != mine.y) << k;
  if (band_rows != 0u) {  // pixels of another band show another instant
    uint row = uint(at.y) % band_rows;
    if (row == 0u) differing &= ~4u;
    if (row == band_rows - 1u) differing &= ~8u;
  }
  bool lines = lines_on && (camera.first & camera_sees_lines) != 0u;
  if (lines && differing != 0u) {  // the pixels of thin lines have their shares
    uvec2 entries = lines_near(at);
    if (of_lines(mine.y, entries)) differing = 0u;
    for (int k = 0; k < 4; ++k) {
      bool ask = (differing & 1u << k) != 0u && entries.x < entries.y;
      if (ask && of_lines(picture_seen[neighbor(at, k)].y, entries)) differing &= ~(1u << k);
    }
  }
  Shaded pixel = shaded(at);
  if (differing != 0u) pixel = smoothed(at, mine, differing, pixel);
  if (color_on) to_color[element] = pack_color(pixel.color);
  if (luminance_on) to_luminance[element] = pixel.luminance;
}
