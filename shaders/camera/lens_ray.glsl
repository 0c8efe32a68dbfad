// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The rays of a camera's pixels, whether or not its lens distorts, and where the pinhole picture of what they see has
// them.
#ifndef GREATX_CAMERA_LENS_RAY_GLSL
#define GREATX_CAMERA_LENS_RAY_GLSL
#include "camera/effects.glsl"
#include "camera/visibility_view.glsl"
#include "camera/pixel_ray.glsl"

/// [height, width]: pinhole coordinates, in pixels, of the pixels' centres.
layout(set = 0, binding = lens_binding) uniform sampler2D lens;

/// Coordinates of a pixel's centre in the pinhole picture; pixels beyond the rim as the nearest within.
vec2 pinhole_place(ivec2 at) {
  if (!distortion_on) return vec2(at) + 0.5;
  return texelFetch(lens, clamp(at, ivec2(0), textureSize(lens, 0) - 1), 0).xy;
}
#endif
