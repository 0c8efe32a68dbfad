// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds fog and rain between a surface and the eye (docs/light.md).
#ifndef GREATX_CAMERA_HAZE_GLSL
#define GREATX_CAMERA_HAZE_GLSL
#include "camera/light.glsl"

/// Returns the radiance of endless haze from a unit direction.
vec3 airlight(vec3 direction) {
  float g = lighting.haze_asymmetry;
  float root = inversesqrt(1.0 + g * g - 2.0 * g * dot(direction, lighting.sun_direction));
  return lighting.haze_ambient + lighting.haze_directed * (root * root * root);
}

/// Returns the share of light that is left after `distance` metres. Drops that are drawn as streaks take
/// their part there.
float haze_passes(float distance) {
  float drawn = weather.drop_extinction * min(distance, weather.drop_reach);
  return exp(drawn - lighting.haze_extinction * distance);
}

/// Returns the rest of `radiance` after `distance` metres along `direction` (unit, from the eye), plus the
/// light of the air.
vec3 through_haze(vec3 radiance, vec3 direction, float distance) {
  return mix(airlight(direction), radiance, haze_passes(distance));
}
#endif
