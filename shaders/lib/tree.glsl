// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The parts of a walk through the trees of shared/tree.h, one ray an invocation; lib/tree_walk.glsl puts them
// together. They are made for drivers that run eight invocations in a CPU's vector registers, where loads
// take most of a walk's time. Therefore a node is 32 bytes, read as four components of 64 bits
// (lib/words.glsl). The rules for every back end (lib/trace.glsl) hold here, and also these:
//
// - The tracing is watertight: the triangle test is S. Woop, C. Benthin, I. Wald, "Watertight ray/triangle
//   intersection", JCGT 2(1), 2013. A ray exactly on an edge is inside both of its triangles, which needs no
//   fp64. The difference of two rounded products never has the wrong sign, so no ray between the triangles of
//   an edge or a fan is outside all of them.
// - Boxes are met with a margin above all rounding errors, of the box test and of the triangle test.
// - A ray is taken into the frame of a moving body, which is rigid: lengths along the ray stay.
#ifndef GREATX_LIB_TREE_GLSL
#define GREATX_LIB_TREE_GLSL
#include "lib/words.glsl"
#include "shared/tree.h"

layout(constant_id = trees_by_address_id) const bool trees_by_address = false;

// Quadruples of words, as 64 bits twice, and pairs of quadruples.
layout(set = 0, binding = tree_binding, scalar) readonly buffer TreeQuads { u64vec2 tree_quads[]; };
layout(set = 0, binding = tree_binding, scalar) readonly buffer TreePairs { u64vec4 tree_pairs[]; };
layout(set = 0, binding = body_tree_binding, scalar) readonly buffer BodyTreePairs {
  u64vec4 body_tree_pairs[];
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer FarQuad { u64vec2 words; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer FarPair { u64vec4 words; };

/// Returns the quadruple of an even index and the one after it.
QuadPair tree_pair(uint quad) {
  if (trees_by_address) return pair_of(FarPair(scene.trees + 16ul * quad).words);
  return pair_of(tree_pairs[quad >> 1]);
}
QuadPair body_tree_pair(uint quad) { return pair_of(body_tree_pairs[quad >> 1]); }
uvec4 tree_quad(uint quad) {
  u64vec2 words;
  if (trees_by_address)
    words = FarQuad(scene.trees + 16ul * quad).words;
  else
    words = tree_quads[quad];
  return quad_of(words);
}

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

/// Holds the place where a ray meets a triangle's plane.
struct TriangleMeet {
  bool inside;  // the ray passes through the triangle
  float t;
  vec2 barycentric;
  bool front;
};
TriangleMeet meet_triangle(vec3 a, vec3 b, vec3 c, TreeShear shear) {
  precise float ax = a.x * shear.x.x + a.y * shear.x.y + a.z * shear.x.z;
  precise float ay = a.x * shear.y.x + a.y * shear.y.y + a.z * shear.y.z;
  precise float bx = b.x * shear.x.x + b.y * shear.x.y + b.z * shear.x.z;
  precise float by = b.x * shear.y.x + b.y * shear.y.y + b.z * shear.y.z;
  precise float cx = c.x * shear.x.x + c.y * shear.x.y + c.z * shear.x.z;
  precise float cy = c.x * shear.y.x + c.y * shear.y.y + c.z * shear.y.z;
  precise float u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
  float sum = u + v + w;
  TriangleMeet meet;
  meet.inside = (min(u, min(v, w)) >= 0.0 || max(u, max(v, w)) <= 0.0) && sum != 0.0;
  meet.t = (u * dot(shear.z, a) + v * dot(shear.z, b) + w * dot(shear.z, c)) / sum;
  meet.barycentric = vec2(v, w) / sum;
  meet.front = (sum > 0.0) == (shear.z.x + shear.z.y + shear.z.z > 0.0);
  return meet;
}

// These are selections, which are one instruction. min and max must treat NaN and are three.
float lower(float a, float b) { return a < b ? a : b; }
float upper(float a, float b) { return a > b ? a : b; }
vec3 lower(vec3 a, vec3 b) { return vec3(lower(a.x, b.x), lower(a.y, b.y), lower(a.z, b.z)); }
vec3 upper(vec3 a, vec3 b) { return vec3(upper(a.x, b.x), upper(a.y, b.y), upper(a.z, b.z)); }

/// Describes a ray in steps of a tree's frame: t at step s of an axis is s * slope + near or far, which
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

/// Holds the children of a node that a ray meets, the nearer one first; tree_none: none.
struct MetChildren {
  uint near, far;
};
MetChildren met_children(QuadPair children, TreeRay ray, float t_min, float t_max) {
  TreeSpan in_left = tree_span(children.first, ray, t_min, t_max),
           in_right = tree_span(children.second, ray, t_min, t_max);
  bool meets_left = in_left.from <= in_left.to, meets_right = in_right.from <= in_right.to;
  bool right_first = !meets_left || (meets_right && in_right.from < in_left.from);
  uint near = right_first ? children.second.w : children.first.w,
       far = right_first ? children.first.w : children.second.w;
  return MetChildren(meets_left || meets_right ? near : tree_none,
                     meets_left && meets_right ? far : tree_none);
}

/// The walk through the tree of the tick. A shader makes one walk at a time, so there is one state.
TreeRay bodies_ray;
uint bodies_node, bodies_waiting, bodies_later[body_tree_most_depth + 1u];

void start_bodies(vec3 origin, float t_min, vec3 direction, float t_max) {
  QuadPair head = body_tree_pair(0u);
  uvec4 frame = head.first;
  bodies_later[0] = tree_none;
  bodies_waiting = 1u;
  bodies_node = frame.w;
  if (frame.w == tree_none) return;
  bodies_ray = tree_ray(origin, direction, uintBitsToFloat(frame.xyz), uintBitsToFloat(head.second.xyz));
  const uint all = 0xffffu;
  TreeSpan whole = tree_span(uvec4(0u, all << 16, all | all << 16, 0u), bodies_ray, t_min, t_max);
  if (whole.from > whole.to) bodies_node = tree_none;
}

/// Returns the next body whose box the ray meets, nearer boxes first; no_body: none is left.
uint next_body(float t_min, float t_max) {
  while (bodies_node < tree_leaf) {
    MetChildren met = met_children(body_tree_pair(bodies_node), bodies_ray, t_min, t_max);
    bodies_node = met.near;
    if (met.far != tree_none) {
      bodies_later[bodies_waiting] = met.far;
      ++bodies_waiting;
    } else if (met.near == tree_none) {
      --bodies_waiting;
      bodies_node = bodies_later[bodies_waiting];
    }
  }
  if (bodies_node == tree_none) return no_body;
  uint body = bodies_node & ~tree_leaf;
  --bodies_waiting;
  bodies_node = bodies_later[bodies_waiting];
  return body;
}

#endif
