#version 460
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Each invocation traces one ray, reflected specularly off every facet that it meets. The pass finds which
// facets a path meets. The host computes in fp64 the exact points and the phase.
#extension GL_GOOGLE_include_directive : require
#include "shared/radar.h"
#include "lib/trace.glsl"
#include "lib/linear.glsl"

layout(constant_id = 0) const bool monostatic = false;  // the receiver is where the source is
layout(constant_id = 1) const bool has_own_body = true;
layout(constant_id = 2) const bool has_leaves = false;  // surfaces that radio does not see

layout(local_size_x = radar_group) in;

layout(set = 0, binding = radar_directions_binding, scalar) readonly buffer DirectionsBlock {
  vec3 directions[];
};
layout(set = 0, binding = radar_hits_binding, scalar) writeonly buffer HitsBlock { uint hits[]; };

layout(push_constant, scalar) uniform Constants { EchoConstants constants; };

const float infinite_range = 1e30;

bool radio_sees(uint primitive) {
  return !has_leaves ||
         (scene_material(scene_primitive(primitive).material).flags & material_flag_no_radio) == 0u;
}

// Returns the first surface that radio sees, but for one body and one facet.
#define GREATX_WALK meet_past_leaves
#define GREATX_WALK_PARAMETERS , uint except_body, uint except_facet
#define GREATX_WALK_SKIPS owner == except_body
#define GREATX_WALK_SOLID candidate.facet != except_facet && radio_sees(candidate.primitive)
#include "lib/walk.glsl"

Hit next_hit(vec3 origin, vec3 direction, uint facet) {
  Hit hit = trace_leaving(origin, direction, infinite_range, facet);
  // Only rays that meet the own body pay for looking at every triangle on their way.
  if (has_leaves && hit.hit && !radio_sees(hit.primitive))
    return meet_past_leaves(origin, 0.0, direction, infinite_range,
                            has_own_body ? constants.source_body : no_body, facet);
  if (has_own_body && hit.hit && scene_primitive(hit.primitive).owner == constants.source_body)
    hit = meet_past_leaves(origin, 0.0, direction, infinite_range, constants.source_body, facet);
  return hit;
}

#define GREATX_WALK meet_obstacle
#define GREATX_WALK_PARAMETERS , uint except_facet
#define GREATX_WALK_SKIPS owner == constants.source_body || owner == constants.receiver_body
#define GREATX_WALK_SOLID candidate.facet != except_facet && radio_sees(candidate.primitive)
#define GREATX_WALK_ANY
#include "lib/walk.glsl"
bool sees_receiver(vec3 start, uint facet) {
  return !meet_obstacle(start, 0.0, constants.receiver - start, 1.0, facet).hit;
}

void main() {
  uint ray = linear_invocation;
  if (ray >= constants.rays) return;
  if (ray == 0u)
    hits[constants.max_bounces * constants.rays] =
        !monostatic && sees_receiver(constants.source, no_facet) ? 1u : 0u;
  vec3 origin = constants.source, direction = directions[ray];
  uint facet = no_facet, bounce = 0u;
  for (; bounce < constants.max_bounces; ++bounce) {
    Hit hit = next_hit(origin, direction, facet);
    if (!hit.hit) break;
    facet = scene_facet(hit.triangle);
    if (facet == no_facet) break;
    Corners corners = triangle_corners(hit.triangle, scene_primitive(hit.primitive).body);
    vec3 normal = geometric_normal(corners);
    if (dot(normal, direction) > 0.0) normal = -normal;
    origin = offset_origin(hit_point(corners, hit.barycentric), normal);
    bool seen = monostatic && bounce == 0u;
    // From behind the surface nothing is seen. The surface itself may be passed over by name.
    if (!monostatic && dot(constants.receiver - origin, normal) > 0.0) seen = sees_receiver(origin, facet);
    hits[bounce * constants.rays + ray] = facet | (seen ? radar_sees_receiver : 0u);
    direction = normalize(direction - 2.0 * dot(direction, normal) * normal);
  }
  for (; bounce < constants.max_bounces; ++bounce) hits[bounce * constants.rays + ray] = radar_none;
}
