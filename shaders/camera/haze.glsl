// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Fog and rain between a surface and the eye.
#ifndef GREATX_CAMERA_HAZE_GLSL
#define GREATX_CAMERA_HAZE_GLSL
#include "camera/light.glsl"

/// What is left of `radiance` after `distance` metres along `direction` (unit, from the eye), and the air's own light.
vec3 through_haze(vec3 radiance, vec3 direction, float distance) { return radiance; }
#endif
