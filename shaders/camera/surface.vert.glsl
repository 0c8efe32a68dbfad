#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Pulls a vertex of the scene. gl_InstanceIndex is the primitive.
#include "camera/surface_interface.glsl"

layout(location = 0) flat out uint out_primitive;
layout(location = 1) flat out uint out_material;
layout(location = 2) out vec3 out_normal;
layout(location = 3) out vec2 out_uv;
layout(location = 4) out vec4 out_tangent;

void main() {
  uint primitive_index = uint(gl_InstanceIndex);
  uint vertex = uint(gl_VertexIndex);
  GpuPrimitive primitive = scene_primitive(primitive_index);
  // body_point, but relative to the eye before the large parts are added up.
  vec3 position = scene_position(vertex);
  vec3 origin = vec3(bodies[primitive.body].row0.w, bodies[primitive.body].row1.w, bodies[primitive.body].row2.w);
  vec3 p = body_direction(primitive.body, position);
  p = primitive.body == 0u ? (position - camera.eye_high) - camera.eye_low
                           : p + ((origin - camera.eye_high) - camera.eye_low);
  gl_Position = vec4(dot(camera.clip_x, p), dot(camera.clip_y, p), camera.near_m, dot(camera.forward, p));
  out_primitive = primitive_index;
  out_material = primitive.material;
  out_normal = body_direction(primitive.body, scene_normal(vertex));
  out_uv = textures_on || alpha_mask_on || normal_maps_on ? scene_uv(vertex) : vec2(0.0);
  out_tangent = vec4(0.0);
  if (normal_maps_on) {
    vec4 tangent = scene_tangent(vertex);
    out_tangent = vec4(body_direction(primitive.body, tangent.xyz), tangent.w);
  }
}
