// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the scene as shaders see it. A hit's primitive is instanceCustomIndex + geometryIndex (a body's
// custom index is its first primitive). Its triangle is primitives[i].first_triangle + primitiveIndex.
#ifndef GREATX_SHADERS_SHARED_SCENE_H
#define GREATX_SHADERS_SHARED_SCENE_H
#include "glsl.h"

GREATX_SHARED_BEGIN

const uint material_flag_alpha_mask = 1u;
const uint material_flag_double_sided = 2u;
// These flags are set if the file states the reflectance. Otherwise the reflectance is the luminance of the
// base colour.
const uint material_flag_reflectance_905nm = 4u;
const uint material_flag_reflectance_1550nm = 8u;
const uint material_flag_no_radio = 16u;  // scene::is_lossless()

// Instance masks name the bodies that a ray may meet.
const uint static_mask = 1u;
const uint moving_mask = 2u;

// A specialization constant of shaders that trace: whether bodies move.
const uint has_moving_bodies_id = 15u;
// Another one: whether the trees are larger than a storage buffer may be, and so are read by their address.
const uint trees_by_address_id = 16u;

/// The most texture arrays that a shader tests one by one (scene/device/gpu_textures.h). Some drivers have 32
/// samplers in a stage (Mesa before 23), of which shading needs a dozen for itself.
const uint most_tried_arrays = 16u;
/// The reference of a texture (scene/device/texture_layers.h). It holds its layer in the lowest 12 bits, then
/// the binary logarithms of how often it lies side by side in the layer along u and v, then its array.
const uint texture_tiles_u_shift = 12u;
const uint texture_tiles_v_shift = 16u;
const uint texture_array_shift = 20u;
const uint texture_most_layers = 1u << texture_tiles_u_shift;
const uint texture_most_log_tiles = 15u;
const uint texture_most_arrays = 2047u;

struct GpuMaterial {
  vec4 base_color;
  vec3 emissive;
  float metallic;
  float roughness;
  float normal_scale;
  float alpha_cutoff;
  uint flags;
  int base_color_texture;  ///< as texture_array_shift says, or -1
  float reflectance_905nm;
  float reflectance_1550nm;
};

struct GpuPrimitive {
  uint first_index;
  uint first_triangle;
  uint material;
  uint instance;
  uint semantic_class;
  uint body;
  uint owner;  ///< scene::Scene::owner_of(body); a sensor that does not see its own body compares it
};

/// Holds the place of a body at this tick: the rows of local_from_body, and those of the tick before (for
/// motion).
struct GpuBody {
  vec4 row0;
  vec4 row1;
  vec4 row2;
};

/// The buffer of the bodies holds the factors of the switched lamps (scene/description/lamps.h) behind the
/// last body, so many in each element. Factor k is number (bodies times this + k) of the whole buffer.
const uint lamp_factors_of_element = 12u;

/// Holds the addresses of the scene's buffers. One such block is a buffer of its own (binding `scene_binding`
/// of set 0).
struct GpuSceneAddresses {
  uint64_t positions;          // vec3[]
  uint64_t normals;            // vec3[]
  uint64_t tangents;           // vec4[]
  uint64_t uvs;                // vec2[]
  uint64_t indices;            // uint[]
  uint64_t primitives;         // GpuPrimitive[]
  uint64_t materials;          // GpuMaterial[]
  uint64_t facet_of_triangle;  // uint[]
  uint64_t trees;              // the buffer of tree_binding; 0 without trees
};

// Every pass over the scene shares these bindings of set 0. A pass's own bindings start at
// first_pass_binding.
const uint scene_binding = 0u;
const uint tlas_binding = 1u;       // for the driver's tracer
const uint body_tree_binding = 1u;  // for the trees, in place of the TLAS; their layout: tree.h
const uint bodies_binding = 2u;
const uint tree_binding = 3u;
const uint first_pass_binding = 4u;

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::GpuMaterial) == 60);
static_assert(sizeof(greatx::shared::GpuPrimitive) == 28);
static_assert(sizeof(greatx::shared::GpuBody) == 48);
static_assert(sizeof(greatx::shared::GpuSceneAddresses) == 72);
#endif
#endif
