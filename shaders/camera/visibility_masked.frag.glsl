#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the triangle that a sample sees, where the alpha mask leaves it.
#include "shared/camera.h"
layout(constant_id = spec_base_color_arrays) const uint base_color_arrays = 0u;
#include "camera/mask.glsl"

layout(location = 0) flat in uint in_triangle;
layout(location = 1) flat in uint in_material;
layout(location = 2) in vec2 in_uv;
layout(location = 0) out uint out_triangle;

void main() {
  if (masked_away(in_material, in_uv)) discard;
  out_triangle = in_triangle;
}
