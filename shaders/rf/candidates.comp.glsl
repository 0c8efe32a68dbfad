#version 460
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// One ray per invocation, reflected specularly off every facet it meets: the sequence of facets is the ray's key.
// Rays share nothing, each writes to its own slots.
#extension GL_GOOGLE_include_directive : require
#include "shared/rf.h"

layout(constant_id = 0) const uint search_mask = 0xffu;  // bodies that reflect: static_mask, or moving ones as well
#define GREATX_TRACE_MASK search_mask
#include "lib/trace.glsl"

layout(local_size_x = candidates_group) in;

layout(set = 0, binding = candidates_directions_binding, scalar) readonly buffer DirectionsBlock { vec3 directions[]; };
layout(set = 0, binding = candidates_keys_binding, scalar) writeonly buffer KeysBlock { uint keys[]; };

layout(push_constant, scalar) uniform Constants { CandidateConstants constants; };

const float infinite_range = 1e30;

void main() {
  uint ray = gl_GlobalInvocationID.x;
  if (ray >= constants.rays) return;
  vec3 origin = constants.source;
  vec3 direction = directions[ray];
  uint first_key = ray * constants.max_depth;
  uint left_facet = no_facet;
  uint depth = 0u;
  for (; depth < constants.max_depth; ++depth) {
    Hit hit = trace_leaving(origin, direction, infinite_range, left_facet);
    if (!hit.hit) break;
    Corners corners = triangle_corners(hit.triangle, scene_primitive(hit.primitive).body);
    vec3 normal = geometric_normal(corners);
    if (dot(normal, direction) > 0.0) normal = -normal;
    left_facet = scene_facet(hit.triangle);
    keys[first_key + depth] = left_facet;
    origin = offset_origin(hit_point(corners, hit.barycentric), normal);
    direction = normalize(direction - 2.0 * dot(direction, normal) * normal);
  }
  for (; depth < constants.max_depth; ++depth) keys[first_key + depth] = rf_none;
}
