// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes a triangle as the eye sees it. Code that few pixels need (moving bodies) stands in branches: a
// device that masks its lanes jumps over a branch that no lane takes, unless it is short.
#ifndef GREATX_CAMERA_TRIANGLE_GLSL
#define GREATX_CAMERA_TRIANGLE_GLSL
#include "camera/visibility_view.glsl"
#include "lib/words.glsl"

layout(set = 0, binding = triangle_records_binding, scalar) readonly buffer TriangleRecordsBlock {
  u64vec2 triangle_records[];
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer TriangleRecords {
  u64vec2 v[];
};
layout(constant_id = spec_triangle_address) const bool triangle_address = false;

uvec4 triangle_record(uint triangle, uint quad) {
  uint at = triangle * triangle_record_quads + quad;
  u64vec2 words;
  if (triangle_address)
    words = TriangleRecords(triangle_records[0].x).v[at];
  else
    words = triangle_records[at];
  return quad_of(words);
}

/// The planar depth and the barycentrics of the second and third corner along a ray d with dot(d, forward) =
/// 1 are quotients of functions linear in d (Moeller and Trumbore 1997, sorted by d).
struct Seen {
  uint triangle;
  uint body, material;
  vec3 p0, e1, e2;  // corner from the eye and two edges, local axes
  vec3 normal;      // not unit
  vec3 u_numerator, v_numerator;
  uvec2 vertex_normals;  // octahedral, of the first two corners
};

Seen see(uint triangle) {
  Seen seen;
  seen.triangle = triangle;
  uvec4 r0 = triangle_record(triangle, 0u), r1 = triangle_record(triangle, 1u),
        r2 = triangle_record(triangle, 2u);
  seen.body = r0.w >> 16;
  seen.material = r0.w & 0xffffu;
  vec3 a = uintBitsToFloat(r0.xyz);
  seen.p0 = (a - camera.eye_high) - camera.eye_low;
  seen.e1 = uintBitsToFloat(r1.xyz);
  seen.e2 = uintBitsToFloat(r2.xyz);
  seen.vertex_normals = uvec2(r1.w, r2.w);
  bool moving = seen.body != 0u;
  if (moving) {
    seen.p0 = from_eye(seen.body, a);
    seen.e1 = body_direction(seen.body, seen.e1);
    seen.e2 = body_direction(seen.body, seen.e2);
  }
  seen.normal = cross(seen.e1, seen.e2);
  seen.u_numerator = cross(seen.e2, seen.p0);
  seen.v_numerator = cross(seen.p0, seen.e1);
  return seen;
}

vec2 barycentrics(Seen seen, vec3 ray) {
  return vec2(dot(ray, seen.u_numerator), dot(ray, seen.v_numerator)) / dot(ray, seen.normal);
}

/// Returns roughly the nearest point of the triangle: a sample at the rim may see a triangle that the centre
/// misses.
vec2 inside(vec2 b) {
  b = clamp(b, vec2(0.0), vec2(1.0));
  return b / max(b.x + b.y, 1.0);
}
#endif
