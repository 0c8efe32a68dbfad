#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the panes of a part of a moving caster into its owner's tile of the atlas.
#include "lib/scene.glsl"
#include "lib/words.glsl"
#include "shared/camera.h"

layout(push_constant, scalar) uniform Constants { GpuShadowPart part; };
#include "camera/pane_caster.glsl"

void main() {
  vec4 p = vec4(scene_position(uint(gl_VertexIndex)), 1.0);
  gl_Position = vec4(dot(part.row0, p), dot(part.row1, p), dot(part.row2, p), 1.0);
  put_pane(p.xyz, part.row2.xyz);
}
