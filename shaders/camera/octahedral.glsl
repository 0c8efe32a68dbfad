// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Maps directions to a square, with z up, as renderer/surface/octahedral.h does.
#ifndef GREATX_CAMERA_OCTAHEDRAL_GLSL
#define GREATX_CAMERA_OCTAHEDRAL_GLSL

/// Returns the unit direction of a place in [-1, 1]^2.
vec3 octahedral_direction(vec2 p) {
  vec3 d = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float fold = max(-d.z, 0.0);
  d.x += d.x >= 0.0 ? -fold : fold;
  d.y += d.y >= 0.0 ? -fold : fold;
  return normalize(d);
}
/// Returns the unit direction of a place in a word of two signed fractions.
vec3 octahedral_direction(uint word) { return octahedral_direction(unpackSnorm2x16(word)); }

/// Returns a map's coordinates, in [0, 1]^2, of a unit direction.
vec2 octahedral_uv(vec3 d) {
  vec2 p = d.xy / (abs(d.x) + abs(d.y) + abs(d.z));
  vec2 signs = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  if (d.z < 0.0) p = (1.0 - abs(p.yx)) * signs;
  return p * 0.5 + 0.5;
}
#endif
