// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads textures where a ray meets a triangle: alpha masks (glTF 2.0, section 3.9.4) and base colour. Set 1
// is the scene's texture table.
#ifndef GREATX_LIB_ALPHA_GLSL
#define GREATX_LIB_ALPHA_GLSL
#include "lib/scene.glsl"
#include "lib/textures.glsl"

vec2 hit_uv(uint triangle, vec2 barycentric) {
  uint first = 3u * triangle;
  return (1.0 - barycentric.x - barycentric.y) * scene_uv(scene_index(first)) +
         barycentric.x * scene_uv(scene_index(first + 1u)) +
         barycentric.y * scene_uv(scene_index(first + 2u));
}

/// Returns the linear base colour and alpha at a hit, from mip 0.
vec4 hit_base_color(GpuMaterial material, uint triangle, vec2 barycentric) {
  vec4 color = material.base_color;
  if (material.base_color_texture >= 0)
    color *= texture_of_level_0(base_color_arrays, uint(material.base_color_texture),
                                hit_uv(triangle, barycentric));
  return color;
}

/// Returns whether the texel stops a ray. It always does, except for masked materials below their cut-off.
bool alpha_is_solid(GpuPrimitive primitive, uint triangle, vec2 barycentric) {
  GpuMaterial material = scene_material(primitive.material);
  if ((material.flags & material_flag_alpha_mask) == 0u) return true;
  return hit_base_color(material, triangle, barycentric).a >= material.alpha_cutoff;
}
#endif
