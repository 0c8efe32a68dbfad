#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Pulls a vertex of a pane, with its place from the eye and the colour that the pane lets through.
#include "camera/visibility_view.glsl"
#include "lib/words.glsl"

layout(set = 0, binding = material_records_binding, scalar) readonly buffer MaterialRecordsBlock {
  u64vec2 material_records[];
};
layout(location = 0) flat out uint out_triangle;
layout(location = 1) out vec3 out_place;
layout(location = 2) flat out vec3 out_color;

void main() {
  GpuPrimitive primitive = scene_primitive(uint(gl_InstanceIndex));
  out_place = from_eye(primitive.body, scene_position(scene_index(uint(gl_VertexIndex))));
  gl_Position = clip_from_eye(out_place);
  out_triangle = uint(gl_VertexIndex) / 3u + 1u;
  uint color = quad_of(material_records[primitive.material * material_record_quads + 2u]).w;
  out_color = vec3(color & 1023u, color >> 10 & 1023u, color >> 20 & 1023u) / 1023.0;
}
