// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds where a way over the picture leaves a triangle.
#ifndef GREATX_CAMERA_REACH_GLSL
#define GREATX_CAMERA_REACH_GLSL
#include "camera/triangle.glsl"

/// Returns how far from `ray` along `step` the triangle is left, in steps; 2 if it is not left within the
/// first.
float reach(Seen seen, vec3 ray, vec3 step) {
  float side = dot(ray, seen.normal) < 0.0 ? -1.0 : 1.0;
  vec3 here = side * vec3(dot(ray, seen.u_numerator), dot(ray, seen.v_numerator), dot(ray, seen.normal));
  vec3 change = side * vec3(dot(step, seen.u_numerator), dot(step, seen.v_numerator), dot(step, seen.normal));
  here.z -= here.x + here.y;
  change.z -= change.x + change.y;
  float least = 2.0;
  for (int i = 0; i < 3; ++i)
    if (change[i] < 0.0) least = min(least, max(here[i], 0.0) / -change[i]);
  return least;
}
#endif
