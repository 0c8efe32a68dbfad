// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Applies alpha masks (glTF 2.0, 3.9.4).
#ifndef GREATX_CAMERA_MASK_GLSL
#define GREATX_CAMERA_MASK_GLSL
#include "lib/scene.glsl"
#include "lib/textures.glsl"

bool masked_away(uint material_index, vec2 uv) {
  vec2 dx = dFdx(uv), dy = dFdy(uv);
  GpuMaterial material = scene_material(material_index);
  float alpha = material.base_color.a;
  if (material.base_color_texture >= 0)
    alpha *= texture_by_gradient(base_color_arrays, uint(material.base_color_texture), uv, dx, dy).a;
  return alpha < material.alpha_cutoff;
}
#endif
