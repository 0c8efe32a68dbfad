// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a triangle's material is around a ray. Loops that run once: see triangle.glsl.
#ifndef GREATX_CAMERA_SURFACE_GLSL
#define GREATX_CAMERA_SURFACE_GLSL
#extension GL_EXT_nonuniform_qualifier : require
#include "camera/effects.glsl"
#include "camera/octahedral.glsl"
#include "camera/triangle.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];
layout(set = 0, binding = material_records_binding) uniform usamplerBuffer material_records;

uvec4 material_record(uint material, uint texel) {
  return texelFetch(material_records, int(material * material_record_texels + texel));
}

/// Where textures are read, and how wide a pixel is there.
struct Footprint {
  vec2 uv, dx, dy;
};

vec4 texel(uint index, Footprint at) { return textureGrad(textures[nonuniformEXT(index)], at.uv, at.dx, at.dy); }

struct Surface {
  vec3 p, v;          // from the eye; unit towards it
  vec3 geometric, n;  // unit, on the eye's side
  vec3 base_color, glow;
  float metallic, roughness;
};

/// The surface of a triangle around a ray.
Surface surface_at(Seen seen, vec3 ray) {
  Surface s;
  vec2 center = barycentrics(seen, ray), b = inside(center);
  vec3 weights = vec3(1.0 - b.x - b.y, b);
  s.p = seen.p0 + seen.e1 * b.x + seen.e2 * b.y;
  s.v = -normalize(s.p);
  // A surface is solid from both sides: its normals look at the side that the eye is on.
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
    of_glow = m1.w >> 16;
  }
  vec3 tangent = vec3(0.0), in_map = vec3(0.0, 0.0, 1.0);
  if (textures_on || normal_maps_on) {
    uvec4 r3 = triangle_record(seen.triangle, 3u);
    Footprint at;
    mat2 along = mat2(uintBitsToFloat(r3.zw), uintBitsToFloat(r4.xy));
    at.uv = uintBitsToFloat(r3.xy) + along * b;
    at.dx = along * (barycentrics(seen, ray + camera.ray_x) - center);
    at.dy = along * (barycentrics(seen, ray + camera.ray_y) - center);
    if (textures_on) {
      uint of_color = m0.w & 0xffffu;
      while (of_color != 0u) {
        s.base_color *= texel(of_color - 1u, at).rgb;
        of_color = 0u;
      }
      bool of_roughness = (m0.y >> 16) != 0u;
      while (of_roughness) {
        vec4 mr = texel((material_record(seen.material, 1u).w & 0xffffu) - 1u, at);
        s.metallic *= mr.b;
        s.roughness *= mr.g;
        of_roughness = false;
      }
      while (of_glow != 0u) {
        s.glow *= texel(of_glow - 1u, at).rgb;
        of_glow = 0u;
      }
    }
    uint of_normal = normal_maps_on ? m0.w >> 16 : 0u;
    while (of_normal != 0u) {
      uvec4 r5 = triangle_record(seen.triangle, 5u);
      tangent = octahedral_direction(r5.x) * weights.x + octahedral_direction(r5.y) * weights.y +
                octahedral_direction(r5.z) * weights.z;
      in_map = texel(of_normal - 1u, at).xyz * 2.0 - 1.0;
      in_map.xy *= uintBitsToFloat(material_record(seen.material, 2u).x);
      in_map.y = r4.w != 0u ? -in_map.y : in_map.y;
      of_normal = 0u;
    }
  }
  bool moving = seen.body != 0u;
  while (moving) {
    n = body_direction(seen.body, n);
    tangent = body_direction(seen.body, tangent);
    moving = false;
  }
  n = normalize(n);
  if (normal_maps_on) n = normalize(tangent * in_map.x + cross(n, tangent) * in_map.y + n * in_map.z);
  s.n = dot(n, s.geometric) < 0.0 ? -n : n;
  return s;
}
#endif
