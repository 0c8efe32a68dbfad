#version 460
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#extension GL_GOOGLE_include_directive : require
#include "tests/trace_test.h"
#include "lib/trace.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = trace_test_rays_binding, scalar) readonly buffer RaysBlock { TraceTestRay rays[]; };
layout(set = 0, binding = trace_test_results_binding, scalar) writeonly buffer ResultsBlock {
  TreeTestResult results[];
};
layout(push_constant, scalar) uniform Constants { uint count; };

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= count) return;
  TraceTestRay ray = rays[index];
  Hit hit = trace_closest_except(ray.origin, ray.t_min, ray.direction, ray.t_max, ray.skip_body,
                                 ray.skip_facet, false);
  results[index] = TreeTestResult(hit.hit ? hit.triangle : trace_test_none, hit.primitive, hit.t,
                                  hit.barycentric, hit.front ? 1u : 0u);
}
