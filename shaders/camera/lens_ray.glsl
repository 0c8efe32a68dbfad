// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the rays of a camera's pixels, with or without a lens that distorts, and the places of these
// pixels in the pinhole picture.
#ifndef GREATX_CAMERA_LENS_RAY_GLSL
#define GREATX_CAMERA_LENS_RAY_GLSL
#include "camera/effects.glsl"
#include "camera/visibility_view.glsl"
#include "camera/pixel_ray.glsl"

/// [height, width]: the pinhole coordinates of the pixels' centres, in pixels.
layout(set = 0, binding = lens_binding) uniform sampler2D lens;

/// Returns the coordinates of a pixel's centre in the pinhole picture. Pixels beyond the rim take those of
/// the nearest pixel within.
vec2 pinhole_place(ivec2 at) {
  if (!distortion_on) return vec2(at) + 0.5;
  return texelFetch(lens, clamp(at, ivec2(0), textureSize(lens, 0) - 1), 0).xy;
}
#endif
