#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws moving casters, each body into its own tile of the atlas. Tile i belongs to the i-th body that has
// triangles.
#include "lib/scene.glsl"
#include "shared/camera.h"

layout(set = 0, binding = lighting_binding, scalar) uniform LightingBlock { GpuLighting lighting; };
layout(set = 0, binding = shadow_tiles_binding, scalar) readonly buffer ShadowTilesBlock {
  ShadowTilesHeader shadow_tiles_header;
  GpuShadowTile shadow_tiles[];
};
layout(push_constant, scalar) uniform Constants { uint tile_index; };
layout(location = 0) flat out uint out_material;
layout(location = 1) out vec2 out_uv;

void main() {
  GpuPrimitive primitive = scene_primitive(uint(gl_InstanceIndex));
  GpuShadowTile tile = shadow_tiles[tile_index];
  vec3 p = body_point(primitive.body, scene_position(uint(gl_VertexIndex)));
  vec3 q = vec3(dot(lighting.light_x, p), dot(lighting.light_y, p), dot(lighting.sun_direction, p));
  q = (q - tile.center) / tile.radius;
  vec2 uv = tile.uv_center + q.xy * tile.uv_radius;
  gl_Position = vec4(uv * 2.0 - 1.0, 0.5 * q.z + 0.5, 1.0);
  out_material = primitive.material;
  out_uv = scene_uv(uint(gl_VertexIndex));
}
