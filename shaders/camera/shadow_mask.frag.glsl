#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Casters with holes: leaves out what the alpha mask cuts away.
#extension GL_EXT_nonuniform_qualifier : require
#include "lib/scene.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];
layout(location = 0) flat in uint in_material;
layout(location = 1) in vec2 in_uv;

void main() {
  GpuMaterial material = scene_material(in_material);
  float alpha = material.base_color.a;
  if (material.base_color_texture >= 0) alpha *= texture(textures[nonuniformEXT(material.base_color_texture)], in_uv).a;
  if (alpha < material.alpha_cutoff) discard;
}
