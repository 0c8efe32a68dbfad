// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a pixel sees where there is no surface.
#ifndef GREATX_CAMERA_SKY_GLSL
#define GREATX_CAMERA_SKY_GLSL
#include "camera/haze.glsl"
#include "camera/light.glsl"

/// Radiance along a ray (any length) that meets nothing.
vec3 sky_radiance(vec3 ray) {
  if (!sky_on) return vec3(0.0);
  vec3 direction = normalize(ray);
  vec3 radiance = environment_radiance(direction, 0.0);
  if (sun_on && dot(direction, lighting.sun_direction) > lighting.sun_cos_radius) radiance += lighting.sun_disc;
  if (haze_on) radiance = through_haze(radiance, direction, 1e9);
  return min(radiance, vec3(65504.0) / camera.exposure);
}
#endif
