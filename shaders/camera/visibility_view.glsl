// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Pulls a vertex of the scene for the visibility pass. gl_VertexIndex counts the scene's indices, so that
// every vertex knows its triangle. (With indexed draws and gl_PrimitiveID, a city takes a CPU driver a fifth
// longer.)
#ifndef GREATX_CAMERA_VISIBILITY_VIEW_GLSL
#define GREATX_CAMERA_VISIBILITY_VIEW_GLSL
#include "lib/scene.glsl"
#include "shared/camera.h"

layout(push_constant, scalar) uniform Constants { CameraConstants camera; };

/// Returns the position from the eye, in local axes. The large parts are taken off before anything is
/// rounded.
vec3 from_eye(uint body, vec3 position) {
  if (body == 0u) return (position - camera.eye_high) - camera.eye_low;
  vec3 origin = vec3(bodies[body].row0.w, bodies[body].row1.w, bodies[body].row2.w);
  return body_direction(body, position) + ((origin - camera.eye_high) - camera.eye_low);
}

vec4 clip_from_eye(vec3 p) {
  return vec4(dot(camera.clip_x, p), dot(camera.clip_y, p), camera.near_m, dot(camera.forward, p));
}
#endif
