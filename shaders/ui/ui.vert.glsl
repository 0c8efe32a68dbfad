#version 460
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the triangles of a user interface, whose corners are pixels of the window.
layout(push_constant) uniform Constants { vec2 pixels_to_clip; };
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 color;
layout(location = 0) out vec2 out_uv;
layout(location = 1) out vec4 out_color;

void main() {
  gl_Position = vec4(position * pixels_to_clip - 1.0, 0.0, 1.0);
  out_uv = uv;
  out_color = color;
}
