// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the rays of a camera's pixels, with or without a lens that distorts, and the places of these
// pixels in the pinhole picture. With several views (renderer/camera/faces.h), an invocation handles one
// pixel of the view's list.
#ifndef GREATX_CAMERA_LENS_RAY_GLSL
#define GREATX_CAMERA_LENS_RAY_GLSL
#include "camera/effects.glsl"
#include "camera/visibility_view.glsl"
#include "camera/pixel_ray.glsl"

/// [height, width]: the pinhole coordinates of the pixels' centres, in pixels.
layout(set = 0, binding = lens_binding) uniform sampler2D lens;

layout(set = 0, binding = face_pixels_binding, scalar) readonly buffer FacePixelsBlock {
  FacePixel face_pixels[];
};

uint group_number() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

uint face_invocation() {
  return group_number() * (shade_group_width * shade_group_height) + gl_LocalInvocationIndex;
}

#ifdef GREATX_PANES
/// With one view: the groups of pixels that panes may cover (renderer/camera/pane_groups.h).
layout(set = 0, binding = face_pixels_binding, scalar) readonly buffer PaneGroupsBlock {
  uint pane_groups[];
};
ivec2 pixel_of_group() {
  uint number = group_number();
  uint group = number < pane_groups.length() ? pane_groups[number] : ~0u;
  return ivec2(group & 0xffffu, group >> 16) * ivec2(shade_group_width, shade_group_height) +
         ivec2(gl_LocalInvocationID.xy);
}
#endif

/// Returns the pixel that the invocation handles, which may lie outside the picture.
ivec2 own_pixel() {
#ifdef GREATX_PANES
  if (!faces_on) return pixel_of_group();
#else
  if (!faces_on) return ivec2(gl_GlobalInvocationID.xy);
#endif
  uint i = face_invocation();
  uint at = i < face_pixels.length() ? face_pixels[i].at : ~0u;
  return ivec2(at & 0xffffu, at >> 16);
}

/// Returns the coordinates of a pixel's centre in the pinhole picture. Pixels beyond the rim take those of
/// the nearest pixel within.
vec2 pinhole_place(ivec2 at) {
  if (!distortion_on) return vec2(at) + 0.5;
  return texelFetch(lens, clamp(at, ivec2(0), textureSize(lens, 0) - 1), 0).xy;
}

/// Returns the coordinates of the own pixel's centre in the pinhole picture.
vec2 own_place(ivec2 at) { return faces_on ? face_pixels[face_invocation()].place : pinhole_place(at); }

/// Returns the change of the ray from the own pixel, at `place`, to its neighbour at `step`, with several
/// views.
vec3 face_step(ivec2 step, vec2 place) {
  FacePixel pixel = face_pixels[face_invocation()];
  vec2 way = (pixel.right - place) * float(step.x) + (pixel.down - place) * float(step.y);
  return camera.ray_x * way.x + camera.ray_y * way.y;
}
#endif
