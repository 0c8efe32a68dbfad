#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws casters with holes: it leaves out the texels that the alpha mask cuts away.
#include "shared/camera.h"
layout(constant_id = shadow_spec_base_color_arrays) const uint base_color_arrays = 0u;
#include "camera/mask.glsl"

layout(location = 0) flat in uint in_material;
layout(location = 1) in vec2 in_uv;

void main() {
  if (masked_away(in_material, in_uv)) discard;
}
