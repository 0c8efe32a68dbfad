// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The sky where nothing else is, and the sun's disc in it.
#include "camera/light.glsl"

layout(location = 0) out vec4 out_color;
#ifdef GREATX_IDS
layout(location = 1) out uvec2 out_ids;
#endif

void main() {
  vec3 direction = normalize(camera.ray_0 + camera.ray_x * gl_FragCoord.x + camera.ray_y * gl_FragCoord.y);
  vec3 radiance = environment_radiance(direction, 0.0);
  if (sun_on && dot(direction, lighting.sun_direction) > lighting.sun_cos_radius) radiance += lighting.sun_disc;
  out_color = vec4(min(radiance * camera.exposure, vec3(65504.0)), 1.0);
#ifdef GREATX_IDS
  out_ids = uvec2(0x7f800000u, 0u);  // +inf, nothing
#endif
}
