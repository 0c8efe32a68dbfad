#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Pulls a vertex of a moving body for the visibility pass. The body's pose and the view come as one matrix in
// the push constants: on a CPU driver each word that a vertex reads from a buffer costs as much as its
// arithmetic.
#include "lib/scene.glsl"
#include "shared/camera.h"

layout(push_constant, scalar) uniform Constants { BodyView view; };
layout(location = 0) flat out uint out_triangle;

void main() {
  vec4 p = vec4(scene_position(scene_index(uint(gl_VertexIndex))), 1.0);
  gl_Position = vec4(dot(view.clip_x, p), dot(view.clip_y, p), view.near_m, dot(view.forward, p));
  out_triangle = uint(gl_VertexIndex) / 3u + 1u;
}
