// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Blends thin lines into a picture that is shaded without them. An invocation handles one of the pixels that
// the host lists (renderer/camera/thin_lines.h), and changes this pixel alone. Where the centre sees
// something else than a line, that keeps the share that the lines leave. Where the centre sees a line, what
// stands behind it is shaded in its place.
#ifndef GREATX_CAMERA_SHADE_LINES_GLSL
#define GREATX_CAMERA_SHADE_LINES_GLSL
#include "camera/behind_lines.glsl"
#include "lib/linear.glsl"

/// Returns what stands behind the lines at a pixel whose centre sees `id`: triangle + 1 and planar depth.
/// `at` becomes the pixel that sees it.
Center look_behind(LinesLeft lines, inout ivec2 at, vec3 ray, uint id) {
  const Center nothing = Center(uintBitsToFloat(0x7f800000u), 0u);
  Center center = nothing;
  if (id != 0u) look(center, see(id - 1u), ray);
  center.id = behind_lines(at, id, lines.entries);
  if (center.id == 0u) return nothing;
  if (center.id != id) {
    Seen behind = see(center.id - 1u);
    center.depth = dot(behind.p0, behind.normal) / dot(ray, behind.normal);
  }
  return center;
}

/// Holds what is to be added to a pixel: radiance, and the share that shows the scene and not the sky.
struct Added {
  vec3 radiance;
  float scene;
};

/// Adds a part of a pixel: the triangle (+ 1; 0: the sky) around a ray, at a planar depth.
void add_part(inout Added added, inout Mirror mirror, LinePart part, vec2 pixel, Panes panes) {
  vec3 radiance;
  Mirror its = Mirror(0.0, 0.0, vec3(0.0));
  if (part.id == 0u)
    radiance = sky_radiance(part.ray);
  else
    radiance = surface_radiance(see(part.id - 1u), part.ray, part.share, its);
  if (lamp_halos_on) {
    float stretch = length(part.ray);
    radiance += lamp_halos(pixel, part.ray / stretch, min(part.depth, 1e6) * stretch);
  }
  bool behind_pane = panes.id == pane_beside || (panes.id != 0u && panes.depth < part.depth);
  if (behind_pane)
    radiance = panes.radiance + panes.passes * radiance;
  else if (its.weight > 0.0) {
    its.weight += mirror.weight;
    mirror = its;
  }
  added.radiance += part.share * radiance;
  if (part.id != 0u || (behind_pane && panes.id != pane_beside)) added.scene += part.share;
}

/// Returns the words of a picture's mirror, of which the share `keep` stays, with `added`.
uvec3 mirror_with(uvec3 words, float keep, Mirror added) {
  vec2 old = unpackHalf2x16(words.x);
  old.x *= keep;
  if (added.weight == 0.0) return uvec3(packHalf2x16(old), words.yz);
  added.weight += old.x;
  return pack_mirror(added);
}

/// Stores the pixel, of which the share `keep` stays.
void store_with(uint element, float keep, Added added, Mirror mirror) {
  added.radiance *= camera.weight;
  added.scene *= camera.weight;
  if (color_on) {
    vec4 color = vec4(added.radiance * camera.exposure, added.scene) +
                 keep * unpack_color(picture_color[element]);
    picture_color[element] = pack_color(max(color, vec4(0.0)));
  }
  if (luminance_on) {
    float luminance = dot(added.radiance, vec3(0.2126, 0.7152, 0.0722)) + keep * picture_luminance[element];
    picture_luminance[element] = max(luminance, 0.0);
  }
  if (mirrors_on) {
    uvec3 words = uvec3(picture_beside[3u * element], picture_beside[3u * element + 1u],
                        picture_beside[3u * element + 2u]);
    words = mirror_with(words, keep, mirror);
    for (uint i = 0u; i < 3u; ++i) picture_beside[3u * element + i] = words[i];
  }
}

void main() {
  uint number = linear_invocation;
  if (number >= line_words[line_pixel_count_word]) return;
  uint word = line_words[line_words[line_pixels_word] + number];
  ivec2 at = ivec2(word & 0xffffu, word >> 16);
  uint element = picture_element(at), id = visible_at(at, 0u);
  vec2 pixel = vec2(at) + 0.5;
  vec3 ray = pixel_ray(pixel);
  LinesLeft lines = LinesLeft(lines_near(at), 0u, 1.0, id, 0.0);
  ivec2 there = at;
  Center behind = look_behind(lines, there, ray, id);
  lines.behind = behind.depth;
  LinePart part = next_part(lines, pixel);
  bool repaints = behind.id != id;
  if (part.share == 0.0 && !repaints) return;

  // A pane behind the line that the centre sees covers the neighbour's centre and not this one.
  Panes panes = Panes(0u, 0.0, vec3(0.0), vec3(1.0));
  if (panes_on && (camera.first & camera_sees_panes) != 0u) panes = panes_before(picture_element(there));
  Added added = Added(vec3(0.0), 0.0);
  Mirror mirror = Mirror(0.0, 0.0, vec3(0.0));
  // After the lines comes what stands behind them, if it takes the place of what the centre sees. A picture
  // that is the sum of parts of an exposure has earlier parts, too, so what is shown there is taken away.
  uint backgrounds = blend_on ? 2u : repaints ? 1u : 0u;
  bool more = true;
  while (more) {
    if (part.share == 0.0) {
      bool shown = backgrounds == 2u;
      --backgrounds;
      part = LinePart(behind.id, lines.through, ray, behind.depth);
      if (shown) {
        part = LinePart(id, -1.0, ray, uintBitsToFloat(0x7f800000u));
        if (id != 0u) {
          Seen seen = see(id - 1u);
          part.depth = dot(seen.p0, seen.normal) / dot(ray, seen.normal);
        }
      }
    }
    add_part(added, mirror, part, pixel, panes);
    part = LinePart(0u, 0.0, ray, 0.0);
    if (lines.entries.x < lines.entries.y) part = next_part(lines, pixel);
    more = part.share != 0.0 || backgrounds > 0u;
  }
  store_with(element, blend_on ? 1.0 : repaints ? 0.0 : lines.through, added, mirror);
}
#endif
