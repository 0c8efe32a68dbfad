#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the ground truth of the point that each pixel's centre sees: surface normal, distance along the ray,
// and optical flow to the camera's next sample. The arrays are tightly packed, so that the host only copies.
#include "lib/scene.glsl"
#include "lib/linear.glsl"
#include "shared/truth.h"

layout(local_size_x = truth_group_size) in;
layout(constant_id = truth_spec_normals) const bool want_normals = true;
layout(constant_id = truth_spec_depth_ray) const bool want_depth_ray = true;
layout(constant_id = truth_spec_flow) const bool want_flow = true;
layout(constant_id = truth_spec_moving) const bool moving = true;
layout(constant_id = truth_spec_distorted) const bool distorted = false;
layout(constant_id = truth_spec_k1) const float k1 = 0.0;
layout(constant_id = truth_spec_k2) const float k2 = 0.0;
layout(constant_id = truth_spec_p1) const float p1 = 0.0;
layout(constant_id = truth_spec_p2) const float p2 = 0.0;
layout(constant_id = truth_spec_k3) const float k3 = 0.0;
layout(constant_id = truth_spec_fold_squared) const float fold_squared = 0.0;
layout(constant_id = truth_spec_wide) const uint wide = 0u;
layout(constant_id = truth_spec_k4) const float k4 = 0.0;
layout(constant_id = truth_spec_half_angle) const float half_angle = 0.0;

layout(set = 0, binding = truth_seen_binding, scalar) readonly buffer SeenBlock { uvec2 picture_seen[]; };
layout(set = 0, binding = truth_triangle_primitives_binding, scalar) readonly buffer TrianglePrimitivesBlock {
  uint triangle_primitives[];
};
layout(push_constant, scalar) uniform Constants { TruthConstants camera; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Floats { float v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Words { uint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Motions { GpuBodyMotion v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer LensTable { vec2 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Directions { vec3 v[]; };
#include "camera/pixel_ray.glsl"
#include "camera/wide_flow.glsl"

const uint infinity_bits = 0x7f800000u, nan_bits = 0x7fc00000u;

/// Returns the interpolated vertex normal where the ray meets the triangle: unit, in local axes, on the side
/// that the eye is on.
vec3 surface_normal(uint triangle, uint body, vec3 ray) {
  uvec3 vertices =
      uvec3(scene_index(3u * triangle), scene_index(3u * triangle + 1u), scene_index(3u * triangle + 2u));
  vec3 a = scene_position(vertices.x);
  vec3 e1 = scene_position(vertices.y) - a, e2 = scene_position(vertices.z) - a;
  vec3 n0 = scene_normal(vertices.x), n1 = scene_normal(vertices.y), n2 = scene_normal(vertices.z);
  vec3 p0 = (a - camera.eye_high) - camera.eye_low;
  if (moving && body != 0u) {
    vec3 origin = vec3(bodies[body].row0.w, bodies[body].row1.w, bodies[body].row2.w);
    p0 = body_direction(body, a) + ((origin - camera.eye_high) - camera.eye_low);
    e1 = body_direction(body, e1);
    e2 = body_direction(body, e2);
  }
  vec3 facing = cross(e1, e2);
  vec2 b = vec2(dot(ray, cross(e2, p0)), dot(ray, cross(p0, e1))) / dot(ray, facing);
  // A sample at the rim may see a triangle that the centre misses. A NaN (a triangle seen edge-on) becomes a
  // corner.
  b = clamp(b, vec2(0.0), vec2(1.0));
  b /= max(b.x + b.y, 1.0);
  vec3 n = n0 * (1.0 - b.x - b.y) + n1 * b.x + n2 * b.y;
  if (moving && body != 0u) n = body_direction(body, n);
  // Opposite vertex normals may cancel. The triangle's own normal is then used.
  if (dot(n, n) < 1e-12) n = facing;
  bool same_side = dot(n, facing) * dot(ray, facing) <= 0.0;
  return normalize(same_side ? n : -n);
}

/// Returns distort(n + by) - distort(n) without subtracting nearly equal numbers (renderer/lens/lens.h has
/// the model).
vec2 distorted_difference(vec2 n, vec2 by) {
  vec2 m = n + by;
  float r2 = dot(n, n), s = dot(2.0 * n + by, by), q2 = r2 + s;  // q: radius of m
  float radial = 1.0 + q2 * (k1 + q2 * (k2 + q2 * k3));
  float radial_difference = s * (k1 + k2 * (r2 + q2) + k3 * (r2 * r2 + r2 * q2 + q2 * q2));
  float product = n.x * by.y + m.y * by.x;           // difference of xy
  vec2 squares = (2.0 * n + by) * by;                // differences of x^2, y^2
  vec2 tangential = vec2(2.0 * p1 * product + p2 * (s + 2.0 * squares.x),
                         p1 * (s + 2.0 * squares.y) + 2.0 * p2 * product);
  return by * radial + n * radial_difference + tangential;
}

/// Returns the same for the point seen along a unit direction of optical axes, behind a lens of `wide`. It is
/// NaN where the point will be nearer than the near plane's distance or outside the image circle.
uvec2 wide_flow_bits(vec3 n, float inverse_range, GpuBodyMotion motion) {
  vec4 r = vec4(n, inverse_range);
  vec3 d = vec3(dot(motion.row0, r), dot(motion.row1, r), dot(motion.row2, r)), m = n + d;
  bool seen = length(m) > max(camera.near_m * inverse_range, 1e-6);
  vec2 by;
  if (wide == truth_lens_fisheye) {
    seen = seen && atan(length(m.xy), m.z) <= half_angle;
    by = fisheye_difference(n, d);
  } else {
    by = equirectangular_difference(n, d);
  }
  return seen && n != vec3(0.0) ? floatBitsToUint(camera.focal * by) : uvec2(nan_bits);
}

/// Returns the displacement, in pixels until the next sample, of the point seen at undistorted normalised
/// coordinates n. It is NaN where the point will be nearer than the near plane, behind the camera or beyond
/// the lens's fold.
uvec2 flow_bits(vec2 n, float inverse_depth, GpuBodyMotion motion) {
  // X'/z = r + d, and only the small d is computed.
  vec4 r = vec4(n, 1.0, inverse_depth);
  vec3 d = vec3(dot(motion.row0, r), dot(motion.row1, r), dot(motion.row2, r));
  float w = 1.0 + d.z;
  vec2 by = (d.xy - n * d.z) / w;
  bool seen = w > max(camera.near_m * inverse_depth, 1e-6);
  if (distorted) {
    seen = seen && dot(n + by, n + by) < fold_squared;
    by = distorted_difference(n, by);
  }
  return seen ? floatBitsToUint(camera.focal * by) : uvec2(nan_bits);
}

void main() {
  uint pixel = linear_invocation;
  if (pixel >= camera.width * camera.height) return;
  ivec2 at = ivec2(pixel % camera.width, pixel / camera.width);
  uvec2 seen = picture_seen[pixel];
  vec2 position = distorted ? LensTable(camera.lens).v[pixel] : vec2(at) + 0.5;
  vec3 direction = wide != 0u ? Directions(camera.lens).v[pixel] : vec3(0.0);
  vec3 ray = wide != 0u ? camera.ray_x * direction.x + camera.ray_y * direction.y + camera.ray_0 * direction.z
                        : pixel_ray(position);
  bool sky = seen.y == 0u;
  float depth = sky ? 1.0 : uintBitsToFloat(seen.x);
  if (want_depth_ray)
    Words(camera.depth_ray).v[pixel] =
        sky ? infinity_bits : floatBitsToUint(wide != 0u ? depth : depth * length(ray));

  uint body = 0u;
  if (moving && (want_flow || want_normals) && !sky)
    body = scene_primitive(triangle_primitives[seen.y - 1u]).body;
  if (want_normals) {
    vec3 n = vec3(0.0);
    if (!sky) n = surface_normal(seen.y - 1u, body, ray);
    for (uint c = 0u; c < 3u; ++c) Floats(camera.normals).v[3u * pixel + c] = n[c];
  }
  if (want_flow) {
    vec2 n = (position - camera.principal) / camera.focal;
    uvec2 flow;
    if (wide != 0u)
      flow = wide_flow_bits(direction, sky ? 0.0 : 1.0 / depth, Motions(camera.motions).v[body]);
    else
      flow = flow_bits(n, sky ? 0.0 : 1.0 / depth, Motions(camera.motions).v[body]);
    Words(camera.flow).v[2u * pixel] = flow.x;
    Words(camera.flow).v[2u * pixel + 1u] = flow.y;
  }
}
