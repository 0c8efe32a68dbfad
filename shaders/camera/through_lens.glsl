// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Which triangle a ray meets behind a lens that distorts. It passes between the samples of the pinhole picture, and the
// nearest one may lie beyond an outline; what those of the four pixels around it see is held against the ray itself.
// Whoever includes this has sample_count and visible_at().
#ifndef GREATX_CAMERA_THROUGH_LENS_GLSL
#define GREATX_CAMERA_THROUGH_LENS_GLSL
#include "camera/lens_ray.glsl"
#include "camera/outline.glsl"

/// What a pixel's centre looks at: planar depth, triangle + 1.
struct Center {
  float depth;
  uint id;
};

const uint lens_candidates = 4u * sample_count;

/// Where a candidate's sample lies (Vulkan's standard places of four).
vec2 candidate_place(ivec2 first, uint i) {
  const vec2 places[4] = vec2[4](vec2(0.375, 0.125), vec2(0.875, 0.375), vec2(0.125, 0.625), vec2(0.625, 0.875));
  vec2 within = sample_count == 1u ? vec2(0.5) : places[i >> 2];
  return vec2(first + ivec2(i & 1u, i >> 1 & 1u)) + within;
}

/// `pixel`: the ray's place in the pinhole picture.
Center through_lens(vec2 pixel, vec3 ray) {
  const Center nothing = Center(uintBitsToFloat(0x7f800000u), 0u);
  ivec2 first = ivec2(pixel - 0.5);
  uint ids[lens_candidates];
  uint own = 0u;  // of the sample nearest to the ray
  vec2 own_place = pixel;
  float own_distance = 1e9;
  bool same = true, sky = false;
  for (uint i = 0u; i < lens_candidates; ++i) {
    ids[i] = visible_at(first + ivec2(i & 1u, i >> 1 & 1u), i >> 2);
    vec2 place = candidate_place(first, i);
    float distance = dot(place - pixel, place - pixel);
    if (distance < own_distance) {
      own = ids[i];
      own_place = place;
      own_distance = distance;
    }
    same = same && ids[i] == ids[0];
    sky = sky || ids[i] == 0u;
  }
  if (same) {  // the ray passes between places on one triangle, or all see nothing
    if (own == 0u) return nothing;
    Seen seen = see(own - 1u);
    return Center(dot(seen.p0, seen.normal) / dot(ray, seen.normal), own);
  }
  Center met = nothing, missed = nothing;
  bool keeps = false;
  uint before = 0u;
  for (uint i = 0u; i < lens_candidates; ++i) {
    uint id = ids[i];
    if (id != 0u && id != before) {
      Seen seen = see(id - 1u);
      Outline outline = outline_of(seen);
      vec3 f = edge_functions(seen, outline.side, ray);
      // Of triangles narrower than a pixel most are seen by no sample, and where an alpha mask has holes its samples alone
      // know: both go by the nearest sample, so that they cover their share of the picture.
      bool by_sample = outline.thin || triangle_record(id - 1u, 5u).w != 0u;
      bool covers = outline_covers(outline, f) && (id == own || !by_sample);
      float depth = outline_depth(outline, f);
      if (covers && depth < met.depth) met = Center(depth, id);
      if (!covers && id == own) {
        vec3 there = edge_functions(seen, outline.side, pixel_ray(own_place));
        missed = Center(outline_depth(outline, outline_entered(f, there)), id);
        keeps = by_sample;
      }
    }
    before = id;
  }
  // The nearest sample also stands for what no sample sees.
  bool stays = missed.id != 0u && (keeps || (met.id == 0u && !sky));
  if (stays && missed.depth < met.depth) return missed;
  return met;
}
#endif
