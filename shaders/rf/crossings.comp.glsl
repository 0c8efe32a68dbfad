#version 460
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Each invocation finds the obstacles between the ends of one segment. The facets and bodies that the ends
// belong to are passed over by name. So is a surface on which an end lies as far as fp32 can tell
// (visibility_tolerance). The measure is the distance of the end to the surface's plane, not the length along
// the segment. Grazing segments then need no other bound, and nothing is cut off the segment itself.
//
// Walls are listed, and opaque facets block. The length of a segment inside foliage adds up on the way, as
// long as both ends are certainly outside. Otherwise the whole line is needed, and it is followed for those
// segments only.
#extension GL_GOOGLE_include_directive : require
#include "shared/rf.h"
#include "lib/linear.glsl"
#include "lib/trace.glsl"

layout(local_size_x = crossings_group) in;

layout(constant_id = 0) const bool has_walls = true;
layout(constant_id = 1) const bool has_foliage = true;

layout(set = 0, binding = crossings_segments_binding, scalar) readonly buffer SegmentsBlock {
  GpuSegment segments[];
};
layout(set = 0, binding = crossings_planes_binding, scalar) readonly buffer PlanesBlock {
  GpuFacetPlane planes[];
};
layout(set = 0, binding = crossings_foliage_binding, scalar) readonly buffer FoliageBlock {
  GpuFoliageBox foliage[];
};
layout(set = 0, binding = crossings_results_binding, scalar) buffer ResultsBlock { uint results[]; };
layout(set = 0, binding = crossings_leaders_binding, scalar) readonly buffer LeadersBlock { uint leaders[]; };

layout(push_constant, scalar) uniform Constants { CrossingConstants constants; };

float largest(vec3 v) {
  vec3 magnitude = abs(v);
  return max(max(magnitude.x, magnitude.y), magnitude.z);
}

/// Returns a facet's plane where its body stands.
GpuFacetPlane posed_plane(uint facet, uint body) {
  GpuFacetPlane plane = planes[facet];
  if (body != 0u) {
    plane.normal = body_direction(body, plane.normal);
    plane.point = body_point(body, plane.point);
  }
  return plane;
}

bool lies_on(vec3 end, GpuFacetPlane plane) {
  return abs(dot(plane.normal, end - plane.point)) <=
         visibility_tolerance(max(largest(end), largest(plane.point)));
}

/// Holds the walls met so far, each once.
struct Walls {
  uint count;
  uint facets[crossings_max];
  float distances[crossings_max];  // from the segment's start
};

/// Holds the length of a segment behind each crossing of a foliage's surface, + entering, - leaving, in units
/// of 1 / crossings_foliage_one. These are integers, so that their order does not matter. `net` is times
/// entered - times left.
struct Depth {
  int sum, net;
};
void add_crossing(inout Depth depth, GpuFacetPlane plane, vec3 direction, float at) {
  int behind = int(round((1.0 - clamp(at, 0.0, 1.0)) * float(crossings_foliage_one)));
  bool entering = dot(plane.normal, direction) < 0.0;
  depth.sum += entering ? behind : -behind;
  depth.net += entering ? 1 : -1;
}
/// Returns whether the line leaves closed volumes as often as it enters them. From outside to outside it
/// must. A line that does not has slipped through an edge, or has met an edge twice.
bool is_closed(Depth depth) { return depth.net == 0 && depth.sum >= 0; }

/// Returns whether a segment passes two walls in one place. Parallel walls are in one place if they lie in
/// one plane, which a segment passes only once (neighbours, duplicates). Other walls are if the segment meets
/// their common edge. The three looks run side by side, which shifts the points where they meet a wall. Four
/// times their offset allows for 60 degrees from the normal of both walls.
bool same_place(uint first, float first_distance, GpuFacetPlane second_plane, float second_distance,
                float reach) {
  GpuFacetPlane first_plane = posed_plane(first, planes[first].body);
  vec3 sine = cross(first_plane.normal, second_plane.normal);
  if (dot(sine, sine) < 1e-6) return lies_on(second_plane.point, first_plane);
  float offset = max(first_distance, second_distance) * 4.7683716e-7 + reach * 2.3841858e-7;
  return abs(first_distance - second_distance) <= visibility_coplanar_m + 4.0 * offset;
}

/// Adds a wall. Returns false if there are more than `most`. Of several walls in one place the lowest index
/// stays.
bool add_wall(inout Walls walls, uint most, uint facet, GpuFacetPlane plane, float at, float reach) {
  for (uint i = 0u; i < walls.count; ++i) {
    if (walls.facets[i] == facet) return true;
    if (same_place(walls.facets[i], walls.distances[i], plane, at, reach)) {
      walls.facets[i] = min(walls.facets[i], facet);
      return true;
    }
  }
  if (walls.count == most) return false;
  walls.facets[walls.count] = facet;
  walls.distances[walls.count] = at;
  ++walls.count;
  return true;
}

/// Returns whether the surface met at `at` along a ray, 0 to 1, ends the segment. Walls and foliage that do
/// not end it are added.
bool stops(GpuSegment segment, vec3 direction, GpuPrimitive primitive, uint triangle, float at,
           inout Walls walls, inout Depth depth) {
  if (primitive.owner == segment.body_a || primitive.owner == segment.body_b) return false;
  uint facet = scene_facet(triangle);
  if (facet == rf_none) return true;
  if (facet == segment.facet_a || facet == segment.facet_b || facet == segment.other_a ||
      facet == segment.other_b)
    return false;
  GpuFacetPlane plane = posed_plane(facet, primitive.body);
  if (has_foliage && plane.kind == facet_kind_foliage) {
    add_crossing(depth, plane, direction, at);
    return false;
  }
  if (plane.kind == facet_kind_absent) return false;
  if (lies_on(segment.a, plane) || lies_on(segment.b, plane)) return false;
  if (!has_walls || plane.kind != facet_kind_wall) return true;
  return !add_wall(walls, segment.walls & ~crossings_end_in_foliage, facet, plane, at * length(direction),
                   largest(segment.a));
}

bool blocked_along(GpuSegment segment, Ray ray, inout Walls walls, out Depth depth) {
  depth = Depth(0, 0);
  rayQueryEXT query;
  rayQueryInitializeEXT(query, tlas, gl_RayFlagsNoOpaqueEXT | gl_RayFlagsTerminateOnFirstHitEXT,
                        GREATX_TRACE_MASK, ray.origin, 0.0, ray.direction, 1.0);
  while (rayQueryProceedEXT(query)) {
    GpuPrimitive primitive = scene_primitive(candidate_primitive(query));
    float at = has_walls || has_foliage ? rayQueryGetIntersectionTEXT(query, false) : 0.0;
    if (stops(segment, ray.direction, primitive, candidate_triangle(query, primitive), at, walls, depth))
      rayQueryConfirmIntersectionEXT(query);
  }
  return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}

/// Returns whether the segment is blocked. `depth` is the depth of the last look that is closed. The first
/// look counts least: it meets the very tops of crowns more often than by chance, and the other looks pass
/// beside the tops.
bool blocked(GpuSegment segment, vec3 direction, out Walls walls, out Depth depth) {
  walls.count = 0u;
  depth = Depth(0, 1);
  for (uint which = 0u; which < looks; ++which) {  // lib/trace.glsl: watertight whatever the driver
    Depth found;
    if (blocked_along(segment, look(segment.a, direction, which), walls, found)) return true;
    if (has_foliage && (is_closed(found) || !is_closed(depth))) depth = found;
  }
  return false;
}

/// Returns where the line a + u d is inside a box, in its body's frame; x > y: nowhere.
vec2 inside_box(GpuFoliageBox box, vec3 a, vec3 d) {
  if (box.body != 0u) {  // rigid: the inverse of its rotation is the transpose
    GpuBody body = bodies[box.body];
    mat3 body_from_local = mat3(body.row0.xyz, body.row1.xyz, body.row2.xyz);
    a = body_from_local * (a - vec3(body.row0.w, body.row1.w, body.row2.w));
    d = body_from_local * d;
  }
  d = mix(d, vec3(1e-30), lessThan(abs(d), vec3(1e-30)));
  vec3 first = (box.low - a) / d, second = (box.high - a) / d;
  vec3 enter = min(first, second), leave = max(first, second);
  return vec2(max(max(enter.x, enter.y), enter.z), min(min(leave.x, leave.y), leave.z));
}

/// Returns whether an end may be inside foliage. The host has tested the static world; a moving body is
/// tested by its box.
bool ends_in_foliage(GpuSegment segment, vec3 direction) {
  if ((segment.walls & crossings_end_in_foliage) != 0u) return true;
  for (uint i = 0u; i < constants.foliage_boxes; ++i) {
    GpuFoliageBox box = foliage[i];
    if (box.body == 0u || box.owner == segment.body_a || box.owner == segment.body_b) continue;
    vec2 inside = inside_box(box, segment.a, direction);
    if (inside.x <= inside.y &&
        ((inside.x <= 0.0 && inside.y >= 0.0) || (inside.x <= 1.0 && inside.y >= 1.0)))
      return true;
  }
  return false;
}

/// Returns the part of the line a + u d that holds every box that it passes through.
vec2 line_through_foliage(GpuSegment segment, vec3 d) {
  vec2 part = vec2(0.0, 1.0);
  for (uint i = 0u; i < constants.foliage_boxes; ++i) {
    GpuFoliageBox box = foliage[i];
    if (box.body != 0u && (box.owner == segment.body_a || box.owner == segment.body_b)) continue;
    vec2 inside = inside_box(box, segment.a, d);
    if (inside.x <= inside.y) part = vec2(min(part.x, inside.x), max(part.y, inside.y));
  }
  return part;
}

Depth depth_along(GpuSegment segment, Ray ray, vec2 part) {
  Depth depth = Depth(0, 0);
  rayQueryEXT query;
  rayQueryInitializeEXT(query, tlas, gl_RayFlagsNoOpaqueEXT, GREATX_TRACE_MASK, ray.origin, 0.0,
                        ray.direction, 1.0);
  while (rayQueryProceedEXT(query)) {
    GpuPrimitive primitive = scene_primitive(candidate_primitive(query));
    if (primitive.owner == segment.body_a || primitive.owner == segment.body_b) continue;
    uint facet = scene_facet(candidate_triangle(query, primitive));
    if (facet == rf_none || planes[facet].kind != facet_kind_foliage) continue;
    add_crossing(depth, posed_plane(facet, primitive.body), ray.direction,
                 mix(part.x, part.y, rayQueryGetIntersectionTEXT(query, false)));
  }
  return depth;
}

/// Returns the depth of foliage along the whole line, from outside of all foliage to outside, beyond both
/// ends of the segment. Ends inside a volume or on its surface then need no rule of their own.
Depth depth_on_line(GpuSegment segment, vec3 direction) {
  vec2 part = line_through_foliage(segment, direction);
  vec3 origin = segment.a + part.x * direction;
  Depth depth = Depth(0, 1);
  for (uint which = 0u; which < looks && !is_closed(depth); ++which)
    depth = depth_along(segment, look(origin, (part.y - part.x) * direction, (which + 1u) % looks), part);
  return depth;
}

void main() {
  uint index = linear_invocation;
  if (index >= constants.count) return;
  GpuSegment segment = segments[index];
  uint row = index * constants.row_words;
  if (segment.only_if != rf_none && leaders[segment.only_if * constants.row_words] == crossings_blocked) {
    results[row] = crossings_blocked;
    return;
  }
  vec3 direction = segment.b - segment.a;
  if (direction == vec3(0.0)) {  // a segment without length has no obstacles
    results[row] = 0u;
    if (has_foliage) results[row + 1u] = 0u;
    return;
  }
  Walls walls;
  Depth depth;
  if (blocked(segment, direction, walls, depth)) {
    results[row] = crossings_blocked;
    return;
  }
  uint status = walls.count;
  if (has_foliage) {
    if (ends_in_foliage(segment, direction)) depth = depth_on_line(segment, direction);
    results[row + 1u] = uint(max(depth.sum, 0));
    if (!is_closed(depth)) status |= crossings_foliage_open;
  }
  results[row] = status;
  if (has_walls)
    for (uint i = 0u; i < walls.count; ++i) results[row + (has_foliage ? 2u : 1u) + i] = walls.facets[i];
}
