// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the material of a triangle around a ray.
#ifndef GREATX_CAMERA_SURFACE_GLSL
#define GREATX_CAMERA_SURFACE_GLSL
#include "camera/effects.glsl"
#include "camera/footprint.glsl"
#include "camera/octahedral.glsl"
#include "camera/triangle.glsl"
#include "lib/textures.glsl"

layout(set = 0, binding = material_records_binding, scalar) readonly buffer MaterialRecordsBlock {
  u64vec2 material_records[];
};

uvec4 material_record(uint material, uint quad) {
  return quad_of(material_records[material * material_record_quads + quad]);
}

/// Holds the place where textures are read, and the width of a pixel there.
struct Footprint {
  vec2 uv, dx, dy;
};

vec4 texel(uint arrays, uint texture_plus_1, Footprint at) {
  return texture_by_gradient(arrays, texture_plus_1 - 1u, at.uv, at.dx, at.dy);
}

struct Surface {
  vec3 p, v;          // position from the eye; unit vector towards the eye
  vec3 geometric, n;  // unit, on the eye's side
  vec3 base_color, glow;
  float metallic, roughness;
};

/// Returns the surface of a triangle around a ray.
Surface surface_at(Seen seen, vec3 ray) {
  Surface s;
  vec2 center = barycentrics(seen, ray), b = inside(center);
  vec3 weights = vec3(1.0 - b.x - b.y, b);
  s.p = seen.p0 + seen.e1 * b.x + seen.e2 * b.y;
  s.v = -normalize(s.p);
  // A surface is solid from both sides: its normals point to the side that the eye is on.
  s.geometric = normalize(seen.normal);
  s.geometric = dot(s.geometric, s.v) < 0.0 ? -s.geometric : s.geometric;

  uvec4 r4 = triangle_record(seen.triangle, 4u);
  vec3 n = octahedral_direction(seen.vertex_normals.x) * weights.x +
           octahedral_direction(seen.vertex_normals.y) * weights.y + octahedral_direction(r4.z) * weights.z;
  uvec4 m0 = material_record(seen.material, 0u);
  s.base_color = vec3(unpackHalf2x16(m0.x), unpackHalf2x16(m0.y).x);
  vec2 metallic_roughness = unpackUnorm2x16(m0.z);
  s.metallic = metallic_roughness.x;
  s.roughness = metallic_roughness.y;
  s.glow = vec3(0.0);
  uint of_glow = 0u;
  if (emissive_on) {
    uvec4 m1 = material_record(seen.material, 1u);
    s.glow = uintBitsToFloat(m1.xyz) * emissive_nits;
    of_glow = m1.w;
  }
  vec3 tangent = vec3(0.0), in_map = vec3(0.0, 0.0, 1.0);
  if (textures_on || normal_maps_on) {
    uvec4 r3 = triangle_record(seen.triangle, 3u);
    Footprint at;
    mat2 along = mat2(uintBitsToFloat(r3.zw), uintBitsToFloat(r4.xy));
    at.uv = uintBitsToFloat(r3.xy) + along * b;
    at.dx = along * (barycentrics(seen, ray + footprint_x()) - center);
    at.dy = along * (barycentrics(seen, ray + footprint_y()) - center);
    if (textures_on) {
      uint of_color = m0.w;
      uint roughness_in = m0.y >> 16;
      if (of_color != 0u) {
        vec4 color = texel(base_color_arrays, of_color, at);
        s.base_color *= color.rgb;
        s.roughness *= roughness_in == roughness_in_alpha ? color.a : 1.0;
      }
      if (roughness_in == roughness_in_texture) {
        vec4 mr = texel(metallic_roughness_arrays, material_record(seen.material, 2u).z, at);
        s.metallic *= mr.b;
        s.roughness *= mr.g;
      }
      if (of_glow != 0u) s.glow *= texel(emissive_arrays, of_glow, at).rgb;
    }
    uvec2 normal_map = normal_maps_on ? material_record(seen.material, 2u).xy : uvec2(0u);
    uint of_normal = normal_map.y;
    if (of_normal != 0u) {
      uvec4 r5 = triangle_record(seen.triangle, 5u);
      tangent = octahedral_direction(r5.x) * weights.x + octahedral_direction(r5.y) * weights.y +
                octahedral_direction(r5.z) * weights.z;
      in_map = texel(normal_arrays, of_normal, at).xyz * 2.0 - 1.0;
      in_map.xy *= uintBitsToFloat(normal_map.x);
      in_map.y = r4.w != 0u ? -in_map.y : in_map.y;
    }
  }
  bool moving = seen.body != 0u;
  if (moving) {
    n = body_direction(seen.body, n);
    tangent = body_direction(seen.body, tangent);
  }
  n = normalize(n);
  if (normal_maps_on) n = normalize(tangent * in_map.x + cross(n, tangent) * in_map.y + n * in_map.z);
  s.n = dot(n, s.geometric) < 0.0 ? -n : n;
  return s;
}
#endif
