#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/visibility_view.glsl"

layout(constant_id = spec_moving_bodies) const bool moving_bodies_on = true;
layout(location = 0) flat out uint out_triangle;

void main() {
  // Most of the drawn triangles never move, and for them the shader does not read the body.
  uint body = moving_bodies_on ? scene_primitive(uint(gl_InstanceIndex)).body : 0u;
  uint vertex = scene_index(uint(gl_VertexIndex));
  gl_Position = clip_from_eye(from_eye(body, scene_position(vertex)));
  out_triangle = uint(gl_VertexIndex) / 3u + 1u;
}
