#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws static casters into a map of the depths that the sun, a lamp or the rain sees.
#include "lib/scene.glsl"
#include "shared/camera.h"

layout(push_constant, scalar) uniform Constants { CasterConstants caster; };
layout(constant_id = shadow_spec_masked) const bool masked = false;
layout(location = 0) flat out uint out_material;
layout(location = 1) out vec2 out_uv;

void main() {
  vec4 p = vec4(scene_position(uint(gl_VertexIndex)), 1.0);
  gl_Position = vec4(dot(caster.rows[0], p), dot(caster.rows[1], p), dot(caster.rows[2], p),
                     dot(caster.rows[3], p));
  out_material = 0u;
  out_uv = vec2(0.0);
  if (!masked) return;
  out_material = scene_primitive(uint(gl_InstanceIndex)).material;
  out_uv = scene_uv(uint(gl_VertexIndex));
}
