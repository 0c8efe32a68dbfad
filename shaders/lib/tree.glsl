// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Traces the tree of the static world (shared/tree.h) without the driver, one ray an invocation. It is made
// for drivers that run eight invocations in a CPU's vector registers. There a load is expensive however few
// words it brings, so a node is two quadruples. The rules for every back end (lib/trace.glsl) hold here, and
// also these:
//
// - The tracing is watertight: the triangle test is S. Woop, C. Benthin, I. Wald, "Watertight ray/triangle
//   intersection", JCGT 2(1), 2013. A ray exactly on an edge is inside both of its triangles, which needs no
//   fp64. The difference of two rounded products never has the wrong sign, so no ray between the triangles of
//   an edge or a fan is outside all of them.
// - Boxes are met with a margin above all rounding errors, of the box test and of the triangle test.
#ifndef GREATX_LIB_TREE_GLSL
#define GREATX_LIB_TREE_GLSL
#include "shared/tree.h"

layout(set = 0, binding = tree_binding, scalar) readonly buffer TreeBlock { uvec4 tree[]; };

/// Holds the rows of the shear that takes the ray to the z axis at unit speed. Their elements are 0, 1 and
/// ratios of the direction's elements, so that rows times a corner round as Woop's permuted corners do.
struct TreeShear {
  vec3 x, y, z;
};
TreeShear tree_shear(vec3 direction) {
  vec3 size = abs(direction);
  bool along_x = size.x >= size.y && size.x >= size.z, along_y = !along_x && size.y >= size.z;
  vec3 z = along_x ? vec3(1.0, 0.0, 0.0) : along_y ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
  vec3 x = z.zxy, y = z.yzx;  // even permutation: keeps the winding
  float speed = dot(z, direction);
  return TreeShear(x - z * (dot(x, direction) / speed), y - z * (dot(y, direction) / speed), z / speed);
}

struct TreeHit {
  float t;
  uint triangle, primitive;  // tree_none: nothing yet
  vec2 barycentric;
  float orientation;  // positive: wound counter-clockwise seen along the shear's -z
};

/// Keeps the triangle of the three quadruples from `quad` on if it is hit before `best`.
void tree_triangle(uint quad, vec3 origin, TreeShear shear, float t_min, uint facet, bool masks,
                   inout TreeHit best) {
  uvec4 first = tree[quad], second = tree[quad + 1u], third = tree[quad + 2u];
  vec3 a = uintBitsToFloat(first.xyz) - origin, b = uintBitsToFloat(second.xyz) - origin,
       c = uintBitsToFloat(third.xyz) - origin;
  precise float ax = a.x * shear.x.x + a.y * shear.x.y + a.z * shear.x.z;
  precise float ay = a.x * shear.y.x + a.y * shear.y.y + a.z * shear.y.z;
  precise float bx = b.x * shear.x.x + b.y * shear.x.y + b.z * shear.x.z;
  precise float by = b.x * shear.y.x + b.y * shear.y.y + b.z * shear.y.z;
  precise float cx = c.x * shear.x.x + c.y * shear.x.y + c.z * shear.x.z;
  precise float cy = c.x * shear.y.x + c.y * shear.y.y + c.z * shear.y.z;
  precise float u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
  float sum = u + v + w;
  bool inside = (min(u, min(v, w)) >= 0.0 || max(u, max(v, w)) <= 0.0) && sum != 0.0;
  float t = (u * dot(shear.z, a) + v * dot(shear.z, b) + w * dot(shear.z, c)) / sum;
  if (inside && t > t_min && t < best.t && (facet == no_facet || third.w != facet)) {
    vec2 barycentric = vec2(v, w) / sum;
    bool solid = true;
#ifdef GREATX_TRACE_ALPHA
    if (masks && (second.w & tree_masked) != 0u)
      solid = alpha_is_solid(scene_primitive(second.w & ~tree_masked), first.w, barycentric);
#endif
    if (solid) best = TreeHit(t, first.w, second.w & ~tree_masked, barycentric, sum);
  }
}

// These are selections, which are one instruction. min and max must treat NaN and are three.
float lower(float a, float b) { return a < b ? a : b; }
float upper(float a, float b) { return a > b ? a : b; }
vec3 lower(vec3 a, vec3 b) { return vec3(lower(a.x, b.x), lower(a.y, b.y), lower(a.z, b.z)); }
vec3 upper(vec3 a, vec3 b) { return vec3(upper(a.x, b.x), upper(a.y, b.y), upper(a.z, b.z)); }

/// Describes a ray in steps of the tree's frame: t at step s of an axis is s * slope + near or far, which
/// include the margin.
struct TreeRay {
  vec3 slope, near, far;
};
TreeRay tree_ray(vec3 origin, vec3 direction, vec3 low, vec3 step_size) {
  // A ray along a plane gets so steep a slope that it is inside between both planes or nowhere.
  vec3 inverse = 1.0 / mix(direction, vec3(1e-30), lessThan(abs(direction), vec3(1e-30)));
  vec3 slope = step_size * inverse, start = (low - origin) * inverse;
  // Each term is off by at most four rounding errors of 2^-24, and the corners in the triangle test are off
  // by as many. 2^-20 is twice that.
  vec3 margin = (abs(slope) * float(tree_steps) + abs(start)) * 9.5367432e-7;
  return TreeRay(slope, start - margin, start + margin);
}
struct TreeSpan {
  float from, to;  // met if from <= to
};
TreeSpan tree_span(uvec4 box, TreeRay ray, float t_min, float t_max) {
  vec3 low = vec3(ivec3(box.x & 0xffffu, box.x >> 16, box.y & 0xffffu)) * ray.slope;
  vec3 high = vec3(ivec3(box.y >> 16, box.z & 0xffffu, box.z >> 16)) * ray.slope;
  vec3 enter = lower(low, high) + ray.near, leave = upper(low, high) + ray.far;
  return TreeSpan(upper(upper(enter.x, enter.y), upper(enter.z, t_min)),
                  lower(lower(leave.x, leave.y), lower(leave.z, t_max)));
}

/// Returns the first triangle of the static world that is not of `facet` (no_facet: any). If `masks`, texels
/// below the cut-off are passed over (GREATX_TRACE_ALPHA).
Hit tree_closest(vec3 origin, float t_min, vec3 direction, float t_max, uint facet, bool masks) {
  TreeShear shear = tree_shear(direction);
  uvec4 frame = tree[0];
  TreeRay ray = tree_ray(origin, direction, uintBitsToFloat(frame.xyz), uintBitsToFloat(tree[1].xyz));
  TreeHit best = TreeHit(t_max, tree_none, 0u, vec2(0.0), 0.0);
  uint later[tree_most_depth + 1u];
  later[0] = tree_none;
  uint waiting = 1u, node = frame.w;
  while (node != tree_none) {
    while (node < tree_leaf) {
      uvec4 left = tree[node], right = tree[node + 1u];
      TreeSpan in_left = tree_span(left, ray, t_min, best.t), in_right = tree_span(right, ray, t_min, best.t);
      bool meets_left = in_left.from <= in_left.to, meets_right = in_right.from <= in_right.to;
      bool right_first = !meets_left || (meets_right && in_right.from < in_left.from);
      node = right_first ? right.w : left.w;
      if (meets_left && meets_right) {
        later[waiting] = right_first ? left.w : right.w;
        ++waiting;
      } else if (!meets_left && !meets_right) {
        --waiting;
        node = later[waiting];
      }
    }
    if (node != tree_none) {
      uint quad = node & (tree_most_quads - 1u),
           end = quad + 3u * (node >> tree_count_shift & tree_most_in_leaf);
      for (; quad < end; quad += 3u) tree_triangle(quad, origin, shear, t_min, facet, masks, best);
      --waiting;
      node = later[waiting];
    }
  }
  Hit hit = no_hit(t_max);
  if (best.triangle != tree_none)
    hit = Hit(true, best.t, best.primitive, best.triangle, best.barycentric,
              (best.orientation > 0.0) == (dot(shear.z, vec3(1.0)) > 0.0));
  return hit;
}

/// Returns whether the ray comes near a moving body that is not of `owner` (no_body: any), so that the driver
/// has to be asked.
bool tree_near_moving(vec3 origin, float t_min, vec3 direction, float t_max, uint owner) {
  float squared = dot(direction, direction), size = sqrt(squared);
  uint count = tree[1].w;
  bool meets = false;
  for (uint i = 0u; i < count; ++i) {
    vec4 sphere = uintBitsToFloat(tree[tree_bodies + 2u * i]);
    uvec4 whose = tree[tree_bodies + 2u * i + 1u];
    vec3 center = body_point(whose.x, sphere.xyz);
    // Some rounding errors of the coordinates and of the pose are added to the radius.
    float radius = sphere.w * 1.000002 + 1.9073486e-6 * dot(abs(center) + abs(origin), vec3(1.0));
    // The cross product is used, since differences of squares of hundreds of metres would lose the body.
    vec3 to = center - origin, side = cross(to, direction);
    float along = dot(to, direction), reach = radius * size;
    meets = meets || (whose.y != owner && dot(side, side) <= reach * reach &&
                      along + reach >= t_min * squared && along - reach <= t_max * squared);
  }
  return meets;
}
#endif
