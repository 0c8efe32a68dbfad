// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The body of lib/walk.glsl for greatx's own trees: first through the static world, then through each moving
// body whose box the ray meets. Of several triangles at the same t the one with the lowest index is met.
Hit GREATX_WALK(vec3 origin, float t_min, vec3 direction, float t_max GREATX_WALK_PARAMETERS) {
  Hit best = no_hit(t_max);
  uint later[tree_most_depth + 1u];
  later[0] = tree_none;
#ifdef GREATX_WALK_BODY
  const bool enters_bodies = false;
  uint body = GREATX_WALK_BODY;
#else
  bool enters_bodies = has_moving_bodies && (GREATX_TRACE_MASK & moving_mask) != 0u;
  if (enters_bodies) start_bodies(origin, t_min, direction, t_max);
  uint body = 0u;
  if ((GREATX_TRACE_MASK & static_mask) == 0u) body = enters_bodies ? next_body(t_min, t_max) : no_body;
#endif
  while (body != no_body) {
    QuadPair head = tree_pair(2u * body);
    uint owner = head.second.w, node = head.first.w, waiting = 1u;
#ifdef GREATX_WALK_SKIPS
    if (GREATX_WALK_SKIPS) node = tree_none;
#endif
    vec3 from = origin, along = direction;
    if (has_moving_bodies && body != 0u) enter_body(body, from, along);
    TreeShear shear = tree_shear(along);
    TreeRay box_ray =
        tree_ray(from, along, uintBitsToFloat(head.first.xyz), uintBitsToFloat(head.second.xyz));
    // Each turn of the loop visits an inner node, then a triangle. Invocations that are at the other kind
    // wait, which costs little beside their loads.
    while (node != tree_none) {
      if (node < tree_leaf) {
        MetChildren met = met_children(tree_pair(node), box_ray, t_min, best.t);
        node = met.near;
        if (met.far != tree_none) {
          later[waiting] = met.far;
          ++waiting;
        } else if (met.near == tree_none) {
          --waiting;
          node = later[waiting];
        }
      }
      if (node >= tree_leaf && node != tree_none) {
        uint quad = node & (tree_most_quads - 1u);
        uvec4 first = tree_quad(quad), second = tree_quad(quad + 1u), third = tree_quad(quad + 2u);
        TriangleMeet meet =
            meet_triangle(uintBitsToFloat(first.xyz) - from, uintBitsToFloat(second.xyz) - from,
                          uintBitsToFloat(third.xyz) - from, shear);
        node += 3u - (1u << tree_count_shift);  // the next triangle of the leaf
        bool leaf_ends = (node >> tree_count_shift & tree_most_in_leaf) == 0u;
        bool nearer = meet.t < best.t || (meet.t == best.t && best.hit && first.w < best.triangle);
        if (meet.inside && meet.t > t_min && nearer) {
          Candidate candidate = Candidate(meet.t, meet.barycentric, first.w, second.w & ~tree_masked, third.w,
                                          body, owner, (second.w & tree_masked) != 0u);
          if (GREATX_WALK_SOLID) {
            best = Hit(true, meet.t, candidate.primitive, candidate.triangle, meet.barycentric, meet.front);
#ifdef GREATX_WALK_ANY
            leaf_ends = true;
            waiting = 1u;
#endif
          }
        }
        if (leaf_ends) {
          --waiting;
          node = later[waiting];
        }
      }
    }
    body = no_body;
#ifndef GREATX_WALK_BODY
#ifdef GREATX_WALK_ANY
    enters_bodies = enters_bodies && !best.hit;
#endif
    if (enters_bodies) body = next_body(t_min, best.t);
#endif
  }
  return best;
}
