// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Traces a list of rays through the scene. The consistency check compares the pictures with the result.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/trace.glsl"
#include "lib/linear.glsl"
#include "shared/probe.h"

layout(local_size_x = probe_workgroup) in;
layout(set = 0, binding = first_pass_binding, scalar) readonly buffer Rays { ProbeRay rays[]; };
layout(set = 0, binding = first_pass_binding + 1, scalar) writeonly buffer Hits { ProbeHit hits[]; };
layout(push_constant, scalar) uniform Push { ProbeConstants push; };

void main() {
  uint i = linear_invocation;
  if (i >= push.count) return;
  ProbeRay ray = rays[i];
  Hit hit = push.excluded_body == no_body
                ? trace_closest(ray.origin, 0.0, ray.direction, 1e30)
                : trace_closest_except(ray.origin, 0.0, ray.direction, 1e30, push.excluded_body, no_facet,
                                       false);
  hits[i].t = hit.hit ? hit.t : uintBitsToFloat(0x7f800000u);
  hits[i].primitive = hit.hit ? hit.primitive + 1u : 0u;
}
