// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the triangle that a ray meets behind a lens that distorts. The ray passes between the samples of the
// pinhole picture, and the nearest sample may lie beyond an outline. The triangles that the samples of the
// four pixels around it see are therefore tested against the ray itself. The including shader has
// sample_count and visible_at().
#ifndef GREATX_CAMERA_THROUGH_LENS_GLSL
#define GREATX_CAMERA_THROUGH_LENS_GLSL
#include "camera/lens_ray.glsl"
#include "camera/outline.glsl"

/// Holds the view of a pixel's centre: planar depth, triangle + 1.
struct Center {
  float depth;
  uint id;
};

/// Holds one pixel of the pinhole picture: the place of its sample nearest to the ray, and the id that the
/// sample sees.
struct Sample {
  vec2 place;
  uint id;
};

Sample nearest_sample(ivec2 at, vec2 pixel) {
  Sample nearest = Sample(vec2(at) + 0.5, 0u);
  uint number = 0u;
  if (sample_count > 1u) {  // Vulkan's standard places of four
    const vec2 places[4] =
        vec2[4](vec2(0.375, 0.125), vec2(0.875, 0.375), vec2(0.125, 0.625), vec2(0.625, 0.875));
    float least = 1e9;
    for (uint s = 0u; s < 4u; ++s) {
      vec2 away = vec2(at) + places[s] - pixel;
      float distance = dot(away, away);
      if (distance < least) {
        nearest.place = vec2(at) + places[s];
        number = s;
        least = distance;
      }
    }
  }
  nearest.id = visible_at(at, number);
  return nearest;
}

Sample nearer(Sample a, Sample b, vec2 pixel) {
  vec2 to_a = a.place - pixel, to_b = b.place - pixel;
  if (dot(to_b, to_b) < dot(to_a, to_a)) return b;
  return a;
}

/// Returns the view along a ray. `pixel` is the ray's place in the pinhole picture.
Center through_lens(vec2 pixel, vec3 ray) {
  const Center nothing = Center(uintBitsToFloat(0x7f800000u), 0u);
  ivec2 first = ivec2(pixel - 0.5);
  Sample a = nearest_sample(first, pixel), b = nearest_sample(first + ivec2(1, 0), pixel),
         c = nearest_sample(first + ivec2(0, 1), pixel), d = nearest_sample(first + ivec2(1, 1), pixel);
  uvec4 ids = uvec4(a.id, b.id, c.id, d.id);
  bool same = all(equal(ids, uvec4(a.id)));
  if (same) {  // the ray passes between places on one triangle, or all see nothing
    if (a.id == 0u) return nothing;
    Seen seen = see(a.id - 1u);
    return Center(dot(seen.p0, seen.normal) / dot(ray, seen.normal), a.id);
  }
  Sample own = nearer(nearer(a, b, pixel), nearer(c, d, pixel), pixel);
  Center met = nothing, missed = nothing;
  bool keeps = false;
  uint left = 15u;  // samples not yet looked at
  while (left != 0u) {
    uint id = (left & 1u) != 0u ? ids.x : (left & 2u) != 0u ? ids.y : (left & 4u) != 0u ? ids.z : ids.w;
    bvec4 alike = equal(ids, uvec4(id));
    left &= ~(uint(alike.x) | uint(alike.y) << 1 | uint(alike.z) << 2 | uint(alike.w) << 3);
    if (id != 0u) {
      Seen seen = see(id - 1u);
      Outline outline = outline_of(seen);
      vec3 f = edge_functions(seen, outline.side, ray);
      bool covers = outline_covers(outline, f);
      // Most triangles narrower than a pixel are seen by no sample. Where an alpha mask has holes, only its
      // samples know of them. In both cases the nearest sample decides, so that these triangles cover their
      // share of the picture.
      bool by_sample = outline.thin;
      bool asks = covers != (id == own.id);
      if (asks) by_sample = by_sample || (triangle_record(id - 1u, 5u).w & 1u) != 0u;
      if (covers && (id == own.id || !by_sample)) {
        float depth = outline_depth(outline, f);
        if (depth < met.depth) met = Center(depth, id);
      } else if (id == own.id) {
        vec3 there = edge_functions(seen, outline.side, pixel_ray(own.place));
        missed = Center(outline_depth(outline, outline_entered(f, there)), id);
        keeps = by_sample;
      }
    }
  }
  // The nearest sample also decides where no sample sees a triangle.
  bool sky = any(equal(ids, uvec4(0u)));
  bool stays = missed.id != 0u && (keeps || (met.id == 0u && !sky));
  if (stays && missed.depth < met.depth) return missed;
  return met;
}
#endif
