#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws static panes of glass into a map of the depths that the sun sees.
#include "lib/scene.glsl"
#include "lib/words.glsl"
#include "shared/camera.h"

layout(push_constant, scalar) uniform Constants { CasterConstants caster; };
#include "camera/pane_caster.glsl"

void main() {
  vec4 p = vec4(scene_position(uint(gl_VertexIndex)), 1.0);
  gl_Position = vec4(dot(caster.rows[0], p), dot(caster.rows[1], p), dot(caster.rows[2], p),
                     dot(caster.rows[3], p));
  put_pane(p.xyz, caster.rows[2].xyz);
}
