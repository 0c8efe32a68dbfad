#version 460
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#extension GL_GOOGLE_include_directive : require
#include "tests/trace_test.h"
#include "lib/trace.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = trace_test_rays_binding, scalar) readonly buffer RaysBlock { TraceTestRay rays[]; };
layout(set = 0, binding = trace_test_results_binding, scalar) writeonly buffer ResultsBlock {
  TraceTestResult results[];
};
layout(push_constant, scalar) uniform Constants { uint count; };

uint triangle_or_none(Hit hit) { return hit.hit ? hit.triangle : trace_test_none; }

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= count) return;
  TraceTestRay ray = rays[index];
  TraceTestResult result;
  result.plain_triangle = triangle_or_none(trace_closest(ray.origin, ray.t_min, ray.direction, ray.t_max));
  Hit hit = trace_closest_watertight(ray.origin, ray.t_min, ray.direction, ray.t_max);
  result.triangle = triangle_or_none(hit);
  result.t = hit.t;
  result.any = trace_any_watertight(ray.origin, ray.t_min, ray.direction, ray.t_max, ray.skip_facet, no_facet)
                   ? 1u
                   : 0u;
  Hit except = trace_closest_except(ray.origin, ray.t_min, ray.direction, ray.t_max, ray.skip_body,
                                    ray.skip_facet, false);
  result.except_triangle = triangle_or_none(except);
  result.except_t = except.t;
  result.next_triangle = trace_test_none;
  result.next_t = 0.0;
  result.point = vec3(0.0);
  result.error = vec3(0.0);
  result.start = vec3(0.0);
  result.bounce_triangle = trace_test_none;
  result.leaving_triangle = trace_test_none;
  if (hit.hit) {
    float beyond = hit.t * (1.0 + 4.0 * 1.1920929e-7);
    Hit next = no_hit(ray.t_max);
    if (beyond < ray.t_max) next = trace_closest(ray.origin, beyond, ray.direction, ray.t_max);
    result.next_triangle = triangle_or_none(next);
    result.next_t = next.t;
    Corners corners = triangle_corners(hit.triangle, scene_primitive(hit.primitive).body);
    vec3 normal = geometric_normal(corners);
    if (dot(normal, ray.direction) > 0.0) normal = -normal;
    HitPoint point = hit_point(corners, hit.barycentric);
    result.point = point.position;
    result.error = point.error;
    result.start = offset_origin(point, normal);
    vec3 reflected = ray.direction - 2.0 * dot(ray.direction, normal) * normal;
    result.bounce_triangle = triangle_or_none(trace_closest(result.start, 0.0, reflected, 1e30));
    result.leaving_triangle =
        triangle_or_none(trace_leaving(result.start, reflected, 1e30, scene_facet(hit.triangle)));
  }
  results[index] = result;
}
