#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Pulls a vertex of the static world for the visibility pass.
#include "camera/visibility_view.glsl"

layout(location = 0) flat out uint out_triangle;

void main() {
  uint vertex = scene_index(uint(gl_VertexIndex));
  gl_Position = clip_from_eye(from_eye(0u, scene_position(vertex)));
  out_triangle = uint(gl_VertexIndex) / 3u + 1u;
}
