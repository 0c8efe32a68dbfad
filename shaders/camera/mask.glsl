// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Alpha masks (glTF 2.0, 3.9.4).
#ifndef GREATX_CAMERA_MASK_GLSL
#define GREATX_CAMERA_MASK_GLSL
#extension GL_EXT_nonuniform_qualifier : require
#include "lib/scene.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

bool masked_away(uint material_index, vec2 uv) {
  GpuMaterial material = scene_material(material_index);
  float alpha = material.base_color.a;
  if (material.base_color_texture >= 0) alpha *= texture(textures[nonuniformEXT(material.base_color_texture)], uv).a;
  return alpha < material.alpha_cutoff;
}
#endif
