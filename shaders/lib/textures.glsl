// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Samples the scene's textures (scene/device/gpu_textures.h), which are named by references
// (texture_array_shift). `arrays` is a specialization constant with one bit for each array that the texture
// may be in (GpuTextures::arrays_of); 0: any. The variant of a shader with GREATX_FEW_TEXTURES knows each
// array by a constant index, so it runs on devices that have no table of variable size or cannot index one by
// a number that differs between lanes.
#ifndef GREATX_LIB_TEXTURES_GLSL
#define GREATX_LIB_TEXTURES_GLSL
#ifndef GREATX_FEW_TEXTURES
#extension GL_EXT_nonuniform_qualifier : require
#endif
#extension GL_EXT_control_flow_attributes : require
#include "shared/scene.h"

#ifdef GREATX_FEW_TEXTURES
layout(set = 1, binding = 0) uniform sampler2DArray textures[most_tried_arrays];
#else
layout(set = 1, binding = 0) uniform sampler2DArray textures[];
#endif

uint texture_array(uint reference) { return reference >> texture_array_shift; }

/// Returns the scale from a texture's own coordinates to those of its layer, in which it may lie side by
/// side. The scale is a power of two.
vec2 texture_scale(uint reference) {
  uvec2 tiles =
      uvec2(reference >> texture_tiles_u_shift, reference >> texture_tiles_v_shift) & texture_most_log_tiles;
  return uintBitsToFloat((127u - tiles) << 23);
}
vec3 texture_place(uint reference, vec2 uv) {
  return vec3(uv, float(reference & (texture_most_layers - 1u)));
}

/// Samples trilinearly, by gradients, so that the lanes may differ in the texture.
vec4 texture_by_gradient(uint arrays, uint reference, vec2 uv, vec2 dx, vec2 dy) {
  uint array = texture_array(reference);
  vec2 scale = texture_scale(reference);
  vec3 at = texture_place(reference, uv * scale);
  dx *= scale;
  dy *= scale;
#ifndef GREATX_FEW_TEXTURES
  if (arrays == 0u) return textureGrad(textures[nonuniformEXT(array)], at, dx, dy);
#endif
  vec4 value = vec4(1.0);
  [[unroll]] for (uint i = 0u; i < most_tried_arrays; ++i)
    if ((arrays >> i & 1u) != 0u && array == i) value = textureGrad(textures[i], at, dx, dy);
  return value;
}

/// Samples the finest level bilinearly.
vec4 texture_of_level_0(uint arrays, uint reference, vec2 uv) {
  uint array = texture_array(reference);
  vec3 at = texture_place(reference, uv * texture_scale(reference));
#ifndef GREATX_FEW_TEXTURES
  if (arrays == 0u) return textureLod(textures[nonuniformEXT(array)], at, 0.0);
#endif
  vec4 value = vec4(1.0);
  [[unroll]] for (uint i = 0u; i < most_tried_arrays; ++i)
    if ((arrays >> i & 1u) != 0u && array == i) value = textureLod(textures[i], at, 0.0);
  return value;
}
#endif
