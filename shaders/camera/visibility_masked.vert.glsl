#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/visibility_view.glsl"

layout(location = 0) flat out uint out_triangle;
layout(location = 1) flat out uint out_material;
layout(location = 2) out vec2 out_uv;

void main() {
  GpuPrimitive primitive = scene_primitive(uint(gl_InstanceIndex));
  uint vertex = scene_index(uint(gl_VertexIndex));
  gl_Position = clip_from_eye(from_eye(primitive.body, scene_position(vertex)));
  out_triangle = uint(gl_VertexIndex) / 3u + 1u;
  out_material = primitive.material;
  out_uv = scene_uv(vertex);
}
