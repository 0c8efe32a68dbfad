// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#ifndef GREATX_CAMERA_OCTAHEDRAL_GLSL
#define GREATX_CAMERA_OCTAHEDRAL_GLSL

/// Unit direction of an octahedral word.
vec3 octahedral_direction(uint word) {
  vec2 p = unpackSnorm2x16(word);
  vec3 d = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float fold = max(-d.z, 0.0);
  d.x += d.x >= 0.0 ? -fold : fold;
  d.y += d.y >= 0.0 ? -fold : fold;
  return normalize(d);
}
#endif
