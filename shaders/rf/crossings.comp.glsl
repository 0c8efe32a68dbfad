#version 460
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// One segment per invocation: does anything stand between its ends? The facets and bodies that the ends belong to are
// passed over by name. So is a surface on which an end lies as far as fp32 can tell (visibility_tolerance): measured as
// the distance of the end to the surface's plane, not along the segment, so that grazing segments need no other bound
// and nothing is cut off the segment itself.
#extension GL_GOOGLE_include_directive : require
#include "shared/rf.h"
#include "lib/trace.glsl"

layout(local_size_x = visibility_group) in;

layout(set = 0, binding = visibility_segments_binding, scalar) readonly buffer SegmentsBlock { GpuSegment segments[]; };
layout(set = 0, binding = visibility_planes_binding, scalar) readonly buffer PlanesBlock { GpuFacetPlane planes[]; };
layout(set = 0, binding = visibility_results_binding, scalar) writeonly buffer ResultsBlock { uint results[]; };

layout(push_constant, scalar) uniform Constants { VisibilityConstants constants; };

float largest(vec3 v) {
  vec3 magnitude = abs(v);
  return max(max(magnitude.x, magnitude.y), magnitude.z);
}

bool lies_on(vec3 end, vec3 normal, vec3 point) {
  return abs(dot(normal, end - point)) <= visibility_tolerance(max(largest(end), largest(point)));
}

bool blocks(GpuSegment segment, GpuPrimitive primitive, uint triangle) {
  if (primitive.body == segment.body_a || primitive.body == segment.body_b) return false;
  uint facet = scene_facet(triangle);
  if (facet == rf_none) return true;
  if (facet == segment.facet_a || facet == segment.facet_b) return false;
  GpuFacetPlane plane = planes[facet];
  if (primitive.body != 0u) {
    plane.normal = body_direction(primitive.body, plane.normal);
    plane.point = body_point(primitive.body, plane.point);
  }
  return !lies_on(segment.a, plane.normal, plane.point) && !lies_on(segment.b, plane.normal, plane.point);
}

bool blocked_along(GpuSegment segment, vec3 origin, vec3 direction) {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, tlas, gl_RayFlagsNoOpaqueEXT | gl_RayFlagsTerminateOnFirstHitEXT, GREATX_TRACE_MASK,
                        origin, 0.0, direction, 1.0);
  while (rayQueryProceedEXT(query)) {
    GpuPrimitive primitive = scene_primitive(candidate_primitive(query));
    if (blocks(segment, primitive, candidate_triangle(query, primitive))) rayQueryConfirmIntersectionEXT(query);
  }
  return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}

bool visible(GpuSegment segment) {
  vec3 direction = segment.b - segment.a;
  if (direction == vec3(0.0)) return true;  // nothing fits between a point and itself
  for (uint which = 0u; which < looks; ++which) {  // lib/trace.glsl: watertight whatever the driver
    Ray ray = look(segment.a, direction, which);
    if (blocked_along(segment, ray.origin, ray.direction)) return false;
  }
  return true;
}

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index < constants.count) results[index] = visible(segments[index]) ? 1u : 0u;
}
