// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Joins what panes reflect with the light that they let through (renderer/camera/panes.h). The pass that
// shades the nearest panes (GREATX_PANES) writes the words that the shading of what is solid reads.
#ifndef GREATX_CAMERA_PANE_LAYER_GLSL
#define GREATX_CAMERA_PANE_LAYER_GLSL
#include "camera/effects.glsl"
#include "camera/picture.glsl"

/// Mirrors of water first, then the ids of panes, which are 0 where no group of panes was shaded, then the
/// other words of panes.
layout(set = 0, binding = shade_mirror_binding, scalar) buffer BesideBlock { uint picture_beside[]; };

uint first_pane_word() {
  ivec2 size = picture_size();
  return mirrors_on ? 3u * uint(size.x * size.y) : 0u;
}
uint pane_id_word(uint element) { return first_pane_word() + element; }
uint pane_word(uint element) {
  ivec2 size = picture_size();
  return first_pane_word() + uint(size.x * size.y) + (pane_pixel_words - 1u) * element;
}

#ifdef GREATX_PANES
#ifdef GREATX_MULTISAMPLED
layout(set = 0, binding = pane_passes_binding) uniform sampler2DMS pane_passes;
#else
layout(set = 0, binding = pane_passes_binding, rgba16f) uniform readonly image2D pane_passes;
#endif
/// Returns what the panes before a sample let through.
vec3 passes_at(ivec2 at, uint s) {
#ifdef GREATX_MULTISAMPLED
  return texelFetch(pane_passes, at, int(s)).rgb;
#else
  return imageLoad(pane_passes, at).rgb;
#endif
}

void store_panes(uint element, uint id, float depth, vec3 stored, vec3 passes) {
  picture_beside[pane_id_word(element)] = id;
  if (id != 0u) {
    uint word = pane_word(element);
    picture_beside[word] = floatBitsToUint(depth);
    stored = min(stored, vec3(65504.0));
    picture_beside[word + 1u] = packHalf2x16(stored.rg);
    picture_beside[word + 2u] = packHalf2x16(vec2(stored.b, passes.r));
    picture_beside[word + 3u] = packHalf2x16(passes.gb);
  }
}
#else
/// Holds what a pixel sees of panes; id 0: none.
struct Panes {
  uint id;
  float depth;
  vec3 radiance, passes;
};

Panes panes_before(uint element) {
  Panes panes = Panes(0u, 0.0, vec3(0.0), vec3(1.0));
  panes.id = picture_beside[pane_id_word(element)];
  bool any = panes.id != 0u;
  if (any) {
    uint word = pane_word(element);
    panes.depth = uintBitsToFloat(picture_beside[word]);
    vec2 middle = unpackHalf2x16(picture_beside[word + 2u]);
    panes.radiance = vec3(unpackHalf2x16(picture_beside[word + 1u]), middle.x) / camera.exposure;
    panes.passes = vec3(middle.y, unpackHalf2x16(picture_beside[word + 3u]));
  }
  return panes;
}
#endif
#endif
