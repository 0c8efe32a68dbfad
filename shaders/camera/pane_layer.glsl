// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Joins what panes reflect with the light that they let through (renderer/camera/panes.h). The pass that
// shades the nearest panes (GREATX_PANES) writes the words that the shading of what is solid reads.
#ifndef GREATX_CAMERA_PANE_LAYER_GLSL
#define GREATX_CAMERA_PANE_LAYER_GLSL
#include "camera/effects.glsl"
#include "camera/picture.glsl"

/// Mirrors of water first, then panes.
layout(set = 0, binding = shade_mirror_binding, scalar) buffer BesideBlock { uint picture_beside[]; };

uint pane_word(uint element) {
  ivec2 size = picture_size();
  uint mirror_words = mirrors_on ? 3u * uint(size.x * size.y) : 0u;
  return mirror_words + pane_pixel_words * element;
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
  uint word = pane_word(element);
  picture_beside[word] = id;
  if (id != 0u) {
    picture_beside[word + 1u] = floatBitsToUint(depth);
    stored = min(stored, vec3(65504.0));
    picture_beside[word + 2u] = packHalf2x16(stored.rg);
    picture_beside[word + 3u] = packHalf2x16(vec2(stored.b, passes.r));
    picture_beside[word + 4u] = packHalf2x16(passes.gb);
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
  uint word = pane_word(element);
  panes.id = picture_beside[word];
  bool any = panes.id != 0u;
  if (any) {
    panes.depth = uintBitsToFloat(picture_beside[word + 1u]);
    vec2 middle = unpackHalf2x16(picture_beside[word + 3u]);
    panes.radiance = vec3(unpackHalf2x16(picture_beside[word + 2u]), middle.x) / camera.exposure;
    panes.passes = vec3(middle.y, unpackHalf2x16(picture_beside[word + 4u]));
  }
  return panes;
}
#endif
#endif
