#version 460
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Each invocation traces one ray, reflected specularly off every facet that it meets. The sequence of facets
// is the ray's key. At a wall the ray goes both ways, one after the other: first reflected, and straight on
// when the reflected way has ended. The keys hold only reflections. Rays share nothing, and each writes to
// its own slots.
#extension GL_GOOGLE_include_directive : require
#include "shared/rf.h"

// bodies that reflect: static_mask, or moving ones as well
layout(constant_id = 0) const uint search_mask = 0xffu;
#define GREATX_TRACE_MASK search_mask
#include "lib/trace.glsl"
#include "lib/linear.glsl"

layout(constant_id = 1) const bool has_foliage = false;
layout(constant_id = 2) const uint max_transmissions = 0u;  // 0: as if there were no walls
layout(constant_id = 3) const uint way_capacity = 1u;       // max_depth, if there are walls
layout(constant_id = 4) const bool counts_left_out = false;

layout(local_size_x = candidates_group) in;

layout(set = 0, binding = candidates_directions_binding, scalar) readonly buffer DirectionsBlock {
  vec3 directions[];
};
layout(set = 0, binding = candidates_kinds_binding, scalar) readonly buffer KindsBlock { uint kinds[]; };
layout(set = 0, binding = candidates_keys_binding, scalar) writeonly buffer KeysBlock { uint keys[]; };

layout(push_constant, scalar) uniform Constants { CandidateConstants constants; };

const float infinite_range = 1e30;

/// Describes a ray under way: its next start and the facets that it has met.
struct Way {
  vec3 origin, direction;
  uint left_facet;
  uint met;            // facets reflected at or passed, <= max_depth
  uint reflections;    // facets reflected at: words of the key
  uint transmissions;  // walls passed
};

#define GREATX_WALK trace_past_foliage
#define GREATX_WALK_PARAMETERS , uint left_facet
#define GREATX_WALK_SOLID candidate.facet != left_facet && kinds[candidate.facet] < facet_kind_foliage
#include "lib/walk.glsl"

/// Returns the next hit of a way. Foliage is passed over.
Hit next_hit(Way way) {
  if (has_foliage) return trace_past_foliage(way.origin, 0.0, way.direction, infinite_range, way.left_facet);
  return trace_leaving(way.origin, way.direction, infinite_range, way.left_facet);
}

/// Splits a way at a hit into the two ways that go on from it.
void part(Hit hit, inout Way reflected, out Way through) {
  Corners corners = triangle_corners(hit.triangle, scene_primitive(hit.primitive).body);
  vec3 normal = geometric_normal(corners);
  if (dot(normal, reflected.direction) > 0.0) normal = -normal;
  HitPoint point = hit_point(corners, hit.barycentric);
  reflected.left_facet = scene_facet(hit.triangle);
  ++reflected.met;
  through = reflected;
  through.origin = offset_origin(point, -normal);
  ++through.transmissions;
  reflected.origin = offset_origin(point, normal);
  reflected.direction = normalize(reflected.direction - 2.0 * dot(reflected.direction, normal) * normal);
  ++reflected.reflections;
}

/// Returns the first word of a ray's key in a slot.
uint row(uint ray, uint slot) { return (slot * constants.rays + ray) * constants.max_depth; }

void reflect_only(uint ray, Way way) {
  uint first = row(ray, 0u), depth = 0u;
  for (; depth < constants.max_depth; ++depth) {
    Hit hit = next_hit(way);
    if (!hit.hit) break;
    Way through;
    part(hit, way, through);
    keys[first + depth] = way.left_facet;
  }
  for (; depth < constants.max_depth; ++depth) keys[first + depth] = rf_none;
}

void go_both_ways(uint ray, Way way) {
  uint key[way_capacity];
  Way waiting[way_capacity];  // at most one for each facet met, except the last of them
  uint waiting_count = 0u, written = 0u, left_out = 0u;
  uint known = 0u;  // words of the key that an earlier row already begins with
  while (true) {
    Hit hit = no_hit(infinite_range);
    if (way.met < constants.max_depth) hit = next_hit(way);
    if (hit.hit) {
      Way through;
      part(hit, way, through);
      key[way.reflections - 1u] = way.left_facet;
      // A ray that passes the last facet of all reflects nowhere any more.
      if (kinds[way.left_facet] == facet_kind_wall && through.transmissions <= max_transmissions &&
          through.met < constants.max_depth)
        waiting[waiting_count++] = through;
      continue;
    }
    if (way.reflections > known) {
      if (written < constants.slots) {
        uint first = row(ray, written);
        for (uint i = 0u; i < constants.max_depth; ++i)
          keys[first + i] = i < way.reflections ? key[i] : rf_none;
        ++written;
      } else {
        ++left_out;
      }
    }
    if (waiting_count == 0u) break;
    way = waiting[--waiting_count];
    known = way.reflections;
  }
  for (; written < constants.slots; ++written)
    for (uint i = 0u; i < constants.max_depth; ++i) keys[row(ray, written) + i] = rf_none;
  if (counts_left_out) keys[row(0u, constants.slots) + ray] = left_out;
}

void main() {
  uint ray = linear_invocation;
  if (ray >= constants.rays) return;
  Way way = Way(constants.source, directions[constants.first_ray + ray], no_facet, 0u, 0u, 0u);
  if (max_transmissions == 0u)
    reflect_only(ray, way);
  else
    go_both_ways(ray, way);
}
