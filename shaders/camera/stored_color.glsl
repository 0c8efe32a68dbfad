// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A picture stores colour and the share of the scene as four halves.
#ifndef GREATX_CAMERA_STORED_COLOR_GLSL
#define GREATX_CAMERA_STORED_COLOR_GLSL
/// Saturates, since a half would turn what is too bright into infinity.
uvec2 pack_color(vec4 color) {
  color = min(color, vec4(65504.0));
  return uvec2(packHalf2x16(color.rg), packHalf2x16(color.ba));
}
vec4 unpack_color(uvec2 words) { return vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y)); }
#endif
