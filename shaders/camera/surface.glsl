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
#include "shared/marks.h"
#include "shared/pane.h"

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
  bool pane;
};

layout(set = 0, binding = marks_binding, scalar) uniform MarksBlock { GpuMarks marks; };
layout(set = 0, binding = mark_map_binding) uniform sampler2D mark_map;

/// Returns the share of a pixel under markings: `middle` is its place on the ground in local x, y, and dx, dy
/// are its sides there. The map is read along the longer axis of the pixel, since pixels on far ground are
/// many times longer than wide.
float marked_share(vec2 middle, vec2 dx, vec2 dy) {
  bool down = dot(dy, dy) >= dot(dx, dx);
  vec2 along = down ? dy : dx, other = down ? dx : dy;
  float length_m = length(along);
  float width_m = abs(along.x * other.y - along.y * other.x) / length_m;
  float taps = clamp(ceil(length_m / max(width_m, marks.texel_m)), 1.0, float(marks_taps));
  float size = max(max(width_m, length_m / taps), 1e-6);
  float level = max(log2(size / marks.texel_m), 0.0);
  // Where a pixel is narrower than a texel, the borders of markings are as sharp as the pixel.
  float sharp = clamp(marks.texel_m / size, 1.0, 4.0);
  float sum = 0.0;
  // Most pixels have no marking near them, which one look at texels of a pixel's length shows.
  float around = ceil(log2(max(length_m / marks.texel_m, 1.0)));
  if (around <= float(marks_levels) &&
      textureLod(mark_map, middle * marks.scale + marks.offset, around).r == 0.0)
    return 0.0;
  for (float k = 0.5; k < taps; k += 1.0) {
    vec2 uv = (middle + along * (k / taps - 0.5)) * marks.scale + marks.offset;
    sum += clamp((textureLod(mark_map, uv, level).r - 0.5) * sharp + 0.5, 0.0, 1.0);
  }
  return sum / taps;
}

/// Replaces the colour of a road or a marking by that of the shares of both in the pixel, where the pixel is
/// long.
void mix_markings(inout Surface s, uint kind, Seen seen, vec3 ray) {
  // The pixel's sides on the triangle's plane.
  float facing = dot(ray, seen.normal);
  vec3 x = footprint_x() - ray * (dot(footprint_x(), seen.normal) / facing),
       y = footprint_y() - ray * (dot(footprint_y(), seen.normal) / facing);
  float depth = dot(seen.p0, seen.normal) / facing;
  x *= depth;
  y *= depth;
  float longest = sqrt(max(dot(x, x), dot(y, y)));
  float weight = smoothstep(marks_from_m, marks_whole_m, longest);
  if (weight > 0.0) {
    bool mark = (kind & triangle_of_mark) != 0u;
    float share = marked_share(s.p.xy + camera.eye_high.xy, x.xy, y.xy);
    vec3 mixed = mix(mark ? marks.road : s.base_color, mark ? s.base_color : marks.mark, share);
    s.base_color = mix(s.base_color, mixed, weight);
    float rough = mix(mark ? marks.road_rough : s.roughness, mark ? s.roughness : marks.mark_rough, share);
    s.roughness = mix(s.roughness, rough, weight);
  }
}

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
  s.pane = panes_on && m0.y >> 16 >= roughness_of_pane;
  s.glow = vec3(0.0);
  uint of_glow = 0u;
  if (emissive_on) {
    uvec4 m1 = material_record(seen.material, 1u);
    s.glow = uintBitsToFloat(m1.xyz) * emissive_nits;
    of_glow = m1.w;
#ifdef GREATX_PANES
    if (m0.y >> 16 == roughness_of_lit_pane) s.glow *= 1.0 - pane_shows(length(s.p) * length(camera.ray_x));
#endif
  }
  if (switched_lamps_on && (r4.w & triangle_switched) != 0u) {
    uvec4 m1 = material_record(seen.material, 1u);
    float factor = lamp_factor(triangle_record(seen.triangle, 5u).w >> 1);
    s.glow = uintBitsToFloat(m1.xyz) * (emissive_nits * factor);
    of_glow = 0u;  // they have no texture, so that nobody pays for one by day
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
      in_map.y = (r4.w & triangle_mirrored) != 0u ? -in_map.y : in_map.y;
    }
  }
  bool of_road = markings_on && (r4.w & (triangle_of_road | triangle_of_mark)) != 0u;
  if (of_road) mix_markings(s, r4.w, seen, ray);
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
