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
//
// fp32 cannot tell on which side of an edge a segment passes that keeps within a rounding error of it. Such a
// segment is left open, and the host decides it in fp64 (rf/paths/exact_crossings.h). It is open if the
// segment itself meets a surface near an edge of the surface's triangle, or if one of three segments around
// it meets a surface that it does not meet itself. A straight edge that passes within half of their radius
// lies between two of the three.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear.glsl"
#include "lib/trace.glsl"
#include "lib/words.glsl"
#include "shared/rf.h"

layout(local_size_x = crossings_group) in;

layout(constant_id = 0) const bool has_walls = true;
layout(constant_id = 1) const bool has_foliage = true;
layout(constant_id = 2) const bool planes_by_address = false;

layout(set = 0, binding = crossings_segments_binding, scalar) readonly buffer SegmentsBlock {
  GpuSegment segments[];
};
layout(set = 0, binding = crossings_planes_binding, scalar) readonly buffer PlanesBlock {
  u64vec4 planes[];  // GpuFacetPlane, as few loads (lib/words.glsl)
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FarPlane { u64vec4 words; };
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

GpuFacetPlane plane_of(uint facet) {
  u64vec4 words;
  if (planes_by_address)
    words = FarPlane(constants.planes + 32ul * facet).words;
  else
    words = planes[facet];
  QuadPair quads = pair_of(words);
  return GpuFacetPlane(uintBitsToFloat(quads.first.xyz),
                       uintBitsToFloat(uvec3(quads.first.w, quads.second.xy)), quads.second.z,
                       quads.second.w);
}

/// Returns a facet's plane where its body stands.
GpuFacetPlane posed_plane(uint facet, uint body) {
  GpuFacetPlane plane = plane_of(facet);
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

/// Returns whether the ray meets a triangle at `at` so near to one of its edges that roundings decide. The
/// distance is that between two lines, the ray and the edge.
bool near_edge(uint triangle, uint body, Ray ray, float at, float band) {
  Corners corners = triangle_corners(triangle, body);
  vec3 starts[3] = vec3[3](corners.a, corners.b, corners.c);
  vec3 edges[3] = vec3[3](corners.b - corners.a, corners.c - corners.b, corners.a - corners.c);
  vec3 point = ray.origin + at * ray.direction;
  for (int i = 0; i < 3; ++i) {
    vec3 across = cross(edges[i], ray.direction);
    float apart = dot(across, point - starts[i]);
    if (apart * apart <= band * band * dot(across, across)) return true;
  }
  return false;
}

/// Returns whether an end that lies on `plane` belongs to a facet at an angle to it. Behind the edge of the
/// two the end is dark, and only fp64 can tell.
bool in_a_seam(vec3 end, uint facet, uint other, GpuFacetPlane plane) {
  if (facet == rf_none || other != rf_none || !lies_on(end, plane)) return false;
  vec3 sine = cross(posed_plane(facet, plane_of(facet).body).normal, plane.normal);
  return dot(sine, sine) >= crossings_seam_sine * crossings_seam_sine;
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

// How two walls that a segment passes stand to each other.
const uint walls_apart = 0u;
const uint walls_in_one_place = 1u;
const uint walls_unsure = 2u;  // the host decides

/// Compares two walls. Parallel walls are in one place if they lie in one plane, which a segment passes only
/// once (neighbours, duplicates). Other walls are if the segment meets their common edge. Whether they are is
/// the rule of rf/paths/exact_crossings.cpp; what roundings of the planes or of the distances could turn is
/// unsure, so that neither the order of walls nor the tracer matters. The three looks run side by side, which
/// shifts the points where they meet a wall. Four times their offset allows for 60 degrees from the normal of
/// both walls.
uint compare_walls(uint first, float first_distance, GpuFacetPlane second_plane, float second_distance,
                   float reach) {
  GpuFacetPlane first_plane = posed_plane(first, plane_of(first).body);
  vec3 sine = cross(first_plane.normal, second_plane.normal),
       between = second_plane.point - first_plane.point;
  float sine2 = dot(sine, sine);
  float off_first = abs(dot(first_plane.normal, between)),
        off_second = abs(dot(second_plane.normal, between));
  if (sine2 < 0.9e-6 && max(off_first, off_second) < 0.5 * visibility_coplanar_m) return walls_in_one_place;
  float offset = max(first_distance, second_distance) * 4.7683716e-7 + reach * 2.3841858e-7;
  bool near = abs(first_distance - second_distance) <= 2.0 * visibility_tolerance(reach) + 4.0 * offset;
  float most = max(reach, max(largest(first_plane.point), largest(second_plane.point)));
  bool off = min(off_first, off_second) > 2.0 * visibility_tolerance(most);
  if (sine2 < 0.9e-6) return off ? walls_apart : walls_unsure;
  if (sine2 > 1.1e-6) return near ? walls_unsure : walls_apart;
  return off && !near ? walls_apart : walls_unsure;
}

/// Adds a wall. Returns false if there are more than `most`. Of several walls in one place the lowest index
/// stays.
bool add_wall(inout Walls walls, uint most, uint facet, GpuFacetPlane plane, float at, float reach,
              inout bool open) {
  for (uint i = 0u; i < walls.count; ++i) {
    if (walls.facets[i] == facet) return true;
    uint known = compare_walls(walls.facets[i], walls.distances[i], plane, at, reach);
    if (known == walls_in_one_place) walls.facets[i] = min(walls.facets[i], facet);
    open = open || known == walls_unsure;
    if (known != walls_apart) return true;
  }
  if (walls.count == most) return false;
  walls.facets[walls.count] = facet;
  walls.distances[walls.count] = at;
  ++walls.count;
  return true;
}

/// Returns whether the surface met at `at` along a ray, 0 to 1, ends the segment. Walls and foliage that do
/// not end it are added. `open` is set if fp32 cannot tell. A ray beside the segment (`beside`) ends nothing:
/// what it meets and the segment has not met leaves the segment open.
bool stops(GpuSegment segment, Ray ray, bool beside, Candidate candidate, inout Walls walls,
           inout Depth depth, inout bool open) {
  vec3 direction = ray.direction;
  float at = candidate.t;
  uint facet = candidate.facet;
  if (facet == rf_none) return true;
  if (facet == segment.facet_a || facet == segment.facet_b || facet == segment.other_a ||
      facet == segment.other_b)
    return false;
  GpuFacetPlane plane = posed_plane(facet, candidate.body);
  if (has_foliage && plane.kind == facet_kind_foliage) {
    add_crossing(depth, plane, direction, at);
    return false;
  }
  if (plane.kind == facet_kind_absent) return false;
  if (lies_on(segment.a, plane) || lies_on(segment.b, plane)) {
    open = open || in_a_seam(segment.a, segment.facet_a, segment.other_a, plane) ||
           in_a_seam(segment.b, segment.facet_b, segment.other_b, plane);
    return false;
  }
  bool wall = has_walls && plane.kind == facet_kind_wall;
  if (beside) {
    bool known = false;
    for (uint i = 0u; wall && i < walls.count; ++i) known = known || walls.facets[i] == facet;
    open = open || !known;
    return !known;  // nothing more to learn from this ray
  }
  float reach = max(largest(segment.a), largest(segment.b));
  if (near_edge(candidate.triangle, candidate.body, ray, at, crossings_edge_band(reach))) {
    open = true;
    return false;
  }
  if (!wall) return true;
  return !add_wall(walls, segment.walls & ~crossings_end_in_foliage, facet, plane, at * length(direction),
                   reach, open);
}

#define GREATX_WALK meet_obstacle
#define GREATX_WALK_PARAMETERS \
  , GpuSegment segment, Ray ray, bool beside, inout Walls walls, inout Depth depth, inout bool open
#define GREATX_WALK_SKIPS owner == segment.body_a || owner == segment.body_b
#define GREATX_WALK_SOLID stops(segment, ray, beside, candidate, walls, depth, open)
#define GREATX_WALK_ANY
#include "lib/walk.glsl"

bool blocked_along(GpuSegment segment, Ray ray, bool beside, inout Walls walls, out Depth depth,
                   inout bool open) {
  depth = Depth(0, 0);
  return meet_obstacle(ray.origin, 0.0, ray.direction, 1.0, segment, ray, beside, walls, depth, open).hit;
}

/// Returns the segment itself (0), or one of three parallel segments around it, a third of a turn apart. The
/// directions follow no axis, since edges do.
Ray look_around(vec3 origin, vec3 direction, uint which, float radius) {
  if (which == 0u) return Ray(origin, direction);
  vec3 side = cross(direction, vec3(0.36, -0.48, 0.8));
  if (dot(side, side) < 0.01 * dot(direction, direction)) side = cross(direction, vec3(-0.64, 0.6, 0.48));
  side = normalize(side);
  float turn = 2.0943951 * float(which);
  return Ray(origin + radius * (cos(turn) * side + sin(turn) * cross(normalize(direction), side)), direction);
}

/// Returns whether the segment is certainly blocked. `open`: the host decides. `depth` is that of the segment
/// itself.
bool blocked(GpuSegment segment, vec3 direction, out Walls walls, out Depth depth, out bool open) {
  walls.count = 0u;
  open = false;
  float radius = crossings_look_radius(max(largest(segment.a), largest(segment.b)));
  for (uint which = 0u; which < 4u && !open; ++which) {  // one query in a loop: drivers compile it once
    Depth found;
    bool stopped = blocked_along(segment, look_around(segment.a, direction, which, radius), which > 0u, walls,
                                 found, open);
    if (which == 0u) depth = found;
    if (which == 0u && stopped) return true;
  }
  return false;
}

/// Returns where the line a + u d is inside a box, in its body's frame; x > y: nowhere.
vec2 inside_box(GpuFoliageBox box, vec3 a, vec3 d) {
  if (box.body != 0u) enter_body(box.body, a, d);
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

/// Adds a candidate of foliage, whose t is between the ends of `part`. Nothing ends the walk.
bool measures(Candidate candidate, vec3 direction, vec2 part, inout Depth depth) {
  if (candidate.facet != rf_none && plane_of(candidate.facet).kind == facet_kind_foliage)
    add_crossing(depth, posed_plane(candidate.facet, candidate.body), direction,
                 mix(part.x, part.y, candidate.t));
  return false;
}
#define GREATX_WALK measure_foliage
#define GREATX_WALK_PARAMETERS , GpuSegment segment, vec2 part, inout Depth depth
#define GREATX_WALK_SKIPS owner == segment.body_a || owner == segment.body_b
#define GREATX_WALK_SOLID measures(candidate, direction, part, depth)
#include "lib/walk.glsl"

Depth depth_along(GpuSegment segment, Ray ray, vec2 part) {
  Depth depth = Depth(0, 0);
  measure_foliage(ray.origin, 0.0, ray.direction, 1.0, segment, part, depth);
  return depth;
}

/// Returns the depth of the last look that is closed, given that of the segment itself. That counts least: it
/// meets the very tops of crowns more often than by chance, and the other looks pass beside the tops. A
/// segment that meets no foliage needs no second look.
Depth depth_on_segment(GpuSegment segment, vec3 direction, Depth depth) {
  if (depth.sum == 0 && depth.net == 0) return depth;
  for (uint which = 1u; which < looks; ++which) {
    Depth found = depth_along(segment, look(segment.a, direction, which), vec2(0.0, 1.0));
    if (is_closed(found) || !is_closed(depth)) depth = found;
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
  bool open;
  if (blocked(segment, direction, walls, depth, open)) {
    results[row] = crossings_blocked;
    return;
  }
  uint status = walls.count;
  if (open) status |= crossings_undecided;
  if (has_foliage) {
    depth = ends_in_foliage(segment, direction) ? depth_on_line(segment, direction)
                                                : depth_on_segment(segment, direction, depth);
    results[row + 1u] = uint(max(depth.sum, 0));
    if (!is_closed(depth)) status |= crossings_foliage_open;
  }
  results[row] = status;
  if (has_walls)
    for (uint i = 0u; i < walls.count; ++i) results[row + (has_foliage ? 2u : 1u) + i] = walls.facets[i];
}
