#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws static casters into the sun's orthographic map.
#include "lib/scene.glsl"
#include "shared/camera.h"

layout(push_constant, scalar) uniform Constants { ShadowConstants shadow; };
layout(constant_id = shadow_spec_masked) const bool masked = false;
layout(location = 0) flat out uint out_material;
layout(location = 1) out vec2 out_uv;

void main() {
  vec4 p = vec4(scene_position(uint(gl_VertexIndex)), 1.0);
  gl_Position = vec4(dot(shadow.row0, p), dot(shadow.row1, p), dot(shadow.row2, p), 1.0);
  out_material = 0u;
  out_uv = vec2(0.0);
  if (!masked) return;
  out_material = scene_primitive(uint(gl_InstanceIndex)).material;
  out_uv = scene_uv(uint(gl_VertexIndex));
}
