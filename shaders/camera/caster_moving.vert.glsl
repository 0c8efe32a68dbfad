#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws casters that move into a map of the depths that a lamp sees.
#include "lib/scene.glsl"
#include "shared/camera.h"

layout(push_constant, scalar) uniform Constants { CasterConstants caster; };
layout(location = 0) flat out uint out_material;
layout(location = 1) out vec2 out_uv;

void main() {
  GpuPrimitive primitive = scene_primitive(uint(gl_InstanceIndex));
  vec4 p = vec4(body_point(primitive.body, scene_position(uint(gl_VertexIndex))), 1.0);
  gl_Position = vec4(dot(caster.rows[0], p), dot(caster.rows[1], p), dot(caster.rows[2], p),
                     dot(caster.rows[3], p));
  out_material = primitive.material;
  out_uv = scene_uv(uint(gl_VertexIndex));
}
