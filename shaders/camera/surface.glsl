// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A triangle as the eye sees it, and what its material is at a point. What few pixels need (moving bodies, textures)
// stands in loops that run once: a device that masks its lanes executes both sides of a branch, but leaves a loop that
// no lane enters.
#ifndef GREATX_CAMERA_SURFACE_GLSL
#define GREATX_CAMERA_SURFACE_GLSL
#extension GL_EXT_nonuniform_qualifier : require
#include "camera/effects.glsl"
#include "camera/visibility_view.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];
layout(set = 0, binding = triangle_records_binding) uniform usamplerBuffer triangle_records;
layout(set = 0, binding = material_records_binding) uniform usamplerBuffer material_records;

uvec4 triangle_record(uint triangle, uint texel) {
  return texelFetch(triangle_records, int(triangle * triangle_record_texels + texel));
}
uvec4 material_record(uint material, uint texel) {
  return texelFetch(material_records, int(material * material_record_texels + texel));
}

/// Unit direction of an octahedral word.
vec3 octahedral_direction(uint word) {
  vec2 p = unpackSnorm2x16(word);
  vec3 d = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float fold = max(-d.z, 0.0);
  d.x += d.x >= 0.0 ? -fold : fold;
  d.y += d.y >= 0.0 ? -fold : fold;
  return normalize(d);
}

/// Planar depth and barycentrics of the second and third corner along a ray d with dot(d, forward) = 1 are quotients of
/// functions linear in d (Moeller and Trumbore 1997, sorted by d).
struct Seen {
  uint triangle;
  uint body, material;
  vec3 p0, e1, e2;  // from the eye, local axes
  vec3 normal;      // not unit
  vec3 u_numerator, v_numerator;
  uvec2 vertex_normals;  // octahedral, of the first two corners
};

Seen see(uint triangle) {
  Seen seen;
  seen.triangle = triangle;
  uvec4 r0 = triangle_record(triangle, 0u), r1 = triangle_record(triangle, 1u), r2 = triangle_record(triangle, 2u);
  seen.body = r0.w >> 16;
  seen.material = r0.w & 0xffffu;
  vec3 a = uintBitsToFloat(r0.xyz);
  seen.p0 = (a - camera.eye_high) - camera.eye_low;
  seen.e1 = uintBitsToFloat(r1.xyz);
  seen.e2 = uintBitsToFloat(r2.xyz);
  seen.vertex_normals = uvec2(r1.w, r2.w);
  bool moving = seen.body != 0u;
  while (moving) {
    seen.p0 = from_eye(seen.body, a);
    seen.e1 = body_direction(seen.body, seen.e1);
    seen.e2 = body_direction(seen.body, seen.e2);
    moving = false;
  }
  seen.normal = cross(seen.e1, seen.e2);
  seen.u_numerator = cross(seen.e2, seen.p0);
  seen.v_numerator = cross(seen.p0, seen.e1);
  return seen;
}

vec2 barycentrics(Seen seen, vec3 ray) {
  return vec2(dot(ray, seen.u_numerator), dot(ray, seen.v_numerator)) / dot(ray, seen.normal);
}

/// The nearest point of the triangle, roughly: a sample at the rim may see a triangle that the centre misses.
vec2 inside(vec2 b) {
  b = clamp(b, vec2(0.0), vec2(1.0));
  return b / max(b.x + b.y, 1.0);
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
  uvec4 m0 = material_record(seen.material, 0u), m1 = material_record(seen.material, 1u);
  s.base_color = uintBitsToFloat(m0.xyz);
  s.metallic = uintBitsToFloat(m0.w);
  s.glow = emissive_on ? uintBitsToFloat(m1.xyz) * emissive_nits : vec3(0.0);
  s.roughness = uintBitsToFloat(m1.w);
  vec3 tangent = vec3(0.0), in_map = vec3(0.0, 0.0, 1.0);
  if (textures_on || normal_maps_on) {
    uvec4 m2 = material_record(seen.material, 2u), r3 = triangle_record(seen.triangle, 3u);
    Footprint at;
    mat2 along = mat2(uintBitsToFloat(r3.zw), uintBitsToFloat(r4.xy));
    at.uv = uintBitsToFloat(r3.xy) + along * b;
    at.dx = along * (barycentrics(seen, ray + camera.ray_x) - center);
    at.dy = along * (barycentrics(seen, ray + camera.ray_y) - center);
    if (textures_on) {
      uint of_color = m2.y & 0xffffu, of_roughness = m2.y >> 16;
      while (of_color != 0u) {
        s.base_color *= texel(of_color - 1u, at).rgb;
        of_color = 0u;
      }
      while (of_roughness != 0u) {
        vec4 mr = texel(of_roughness - 1u, at);
        s.metallic *= mr.b;
        s.roughness *= mr.g;
        of_roughness = 0u;
      }
      uint of_glow = emissive_on ? m2.z >> 16 : 0u;
      while (of_glow != 0u) {
        s.glow *= texel(of_glow - 1u, at).rgb;
        of_glow = 0u;
      }
    }
    uint of_normal = normal_maps_on ? m2.z & 0xffffu : 0u;
    while (of_normal != 0u) {
      uvec4 r5 = triangle_record(seen.triangle, 5u);
      tangent = octahedral_direction(r5.x) * weights.x + octahedral_direction(r5.y) * weights.y +
                octahedral_direction(r5.z) * weights.z;
      in_map = texel(of_normal - 1u, at).xyz * 2.0 - 1.0;
      in_map.xy *= uintBitsToFloat(m2.x);
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
