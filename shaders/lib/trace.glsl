// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Traces rays, with one interface and two back ends. One is the driver's ray query (lib/driver_walk.glsl).
// The other, in the variant of a shader that is compiled with GREATX_TRACE_TREE, is trees of our own over the
// static world and the moving bodies (lib/tree_walk.glsl); it runs on devices without ray queries.
//
// These rules hold for every back end:
// - t_min < t < t_max. A hit exactly at an end may or may not be reported, so callers leave room for
//   rounding.
// - Both sides of a triangle are solid. Degenerate triangles and triangles in the ray's plane are never hit.
// - direction need not be a unit vector, but it must not be zero. Nothing may be NaN.
// - Where several triangles share the nearest t (an edge, a vertex, duplicates), one of them is returned: by
//   the trees the one of lowest index, by a driver any one.
//
// Watertightness: Vulkan asks for it. However, a traversal whose box test is not rounded outwards (T. Ize,
// "Robust BVH ray traversal", JCGT 2(2), 2013) lets a ray slip between two triangles if it passes within
// rounding errors of the place where their boxes touch. Mesa's lavapipe 25.0 does. A ray in a general
// direction has no more chance of that than of hitting a line (see tests/gpu/trace_test.cpp), so the plain
// functions trust the driver. The functions called *_watertight look again along two rays right beside the
// first. They are for rays that aim at edges and corners, and for callers that must not let anything through.
// The trees are watertight by themselves, except between two bodies.
//
// With GREATX_TRACE_ALPHA defined (which needs lib/alpha.glsl and the texture table), texels below the
// cut-off of a masked material let rays through in the functions that say so. Everywhere else masked
// triangles are solid.
#ifndef GREATX_LIB_TRACE_GLSL
#define GREATX_LIB_TRACE_GLSL
#ifndef GREATX_TRACE_TREE
#extension GL_EXT_ray_query : require
#endif
#include "lib/scene.glsl"
#ifdef GREATX_TRACE_ALPHA
#include "lib/alpha.glsl"
#endif
/// Whether bodies move. Without them the trees' walk has no second level.
layout(constant_id = has_moving_bodies_id) const bool has_moving_bodies = true;

// The bodies that the rays of this shader may meet (static_mask, moving_mask). They are all bodies unless the
// shader says otherwise.
#ifndef GREATX_TRACE_MASK
#define GREATX_TRACE_MASK 0xffu
#endif

const uint no_body = ~0u;
const uint no_facet = ~0u;

struct Hit {
  bool hit;
  float t;          // along the direction, in its lengths
  uint primitive;   // index into the scene's primitives
  uint triangle;    // index into the scene's triangles
  vec2 barycentric; // weights of the second and third corner
  bool front;       // seen from the side the winding faces
};

Hit no_hit(float t_max) { return Hit(false, t_max, 0u, 0u, vec2(0.0), true); }

/// Describes a triangle that a ray passes through, which a walk decides about (lib/walk.glsl).
struct Candidate {
  float t;
  vec2 barycentric;
  uint triangle, primitive, facet, body, owner;
  bool masked;  // its material may have holes
};

#ifdef GREATX_TRACE_TREE
#include "lib/tree.glsl"
#else
layout(set = 0, binding = tlas_binding) uniform accelerationStructureEXT tlas;
#endif

/// Returns whether a candidate stops a ray. If `masks`, texels below the cut-off of a masked material do not
/// (GREATX_TRACE_ALPHA).
bool stops_ray(Candidate candidate, bool masks) {
#ifdef GREATX_TRACE_ALPHA
  if (masks && candidate.masked)
    return alpha_is_solid(scene_primitive(candidate.primitive), candidate.triangle, candidate.barycentric);
#endif
  return true;
}

/// Hit trace_closest(vec3 origin, float t_min, vec3 direction, float t_max)
/// Returns the first triangle along origin + t * direction. Masked texels count as solid.
#define GREATX_WALK trace_closest
#define GREATX_WALK_PARAMETERS
#define GREATX_WALK_SOLID true
#define GREATX_WALK_OPAQUE
#include "lib/walk.glsl"

/// Hit trace_closest_except(..., uint body, uint facet, bool masks)
/// Returns the first triangle that is not of `body`, its parts included, nor of `facet` (no_body, no_facet:
/// none). The exclusion is exactly by name: these triangles are passed over one by one, whatever else is at
/// the same distance. If `masks`, masked texels are passed over as well (GREATX_TRACE_ALPHA).
#define GREATX_WALK trace_closest_except
#define GREATX_WALK_PARAMETERS , uint except_body, uint except_facet, bool masks
#define GREATX_WALK_SKIPS owner == except_body
#define GREATX_WALK_SOLID \
  (except_facet == no_facet || candidate.facet != except_facet) && stops_ray(candidate, masks)
#include "lib/walk.glsl"

/// Hit trace_closest_of_body(..., uint of_body, uint except_facet, bool masks)
/// Returns the first triangle of one moving body, without those of one facet (no_facet: none). `masks` is as
/// above.
#define GREATX_WALK trace_closest_of_body
#define GREATX_WALK_PARAMETERS , uint of_body, uint except_facet, bool masks
#define GREATX_WALK_BODY of_body
#define GREATX_WALK_SOLID \
  (except_facet == no_facet || candidate.facet != except_facet) && stops_ray(candidate, masks)
#include "lib/walk.glsl"

#ifdef GREATX_TRACE_ALPHA
/// Hit trace_closest_masked(vec3 origin, float t_min, vec3 direction, float t_max)
/// Returns the first solid texel.
#define GREATX_WALK trace_closest_masked
#define GREATX_WALK_PARAMETERS
#define GREATX_WALK_MASKED
#define GREATX_WALK_SOLID stops_ray(candidate, true)
#include "lib/walk.glsl"
#endif

/// Hit meet_any(..., uint except_facet_a, uint except_facet_b)
/// Returns some triangle that is of neither facet (those at the ends of a segment; no_facet: none). Masked
/// texels count as solid.
#define GREATX_WALK meet_any
#define GREATX_WALK_PARAMETERS , uint except_facet_a, uint except_facet_b
#define GREATX_WALK_ANY
#define GREATX_WALK_SOLID \
  candidate.facet == no_facet || (candidate.facet != except_facet_a && candidate.facet != except_facet_b)
#include "lib/walk.glsl"

/// One of the looks of a ray: the given ray, then two rays beside it. At every distance these are some
/// rounding errors of the traversal away: 2^-21 of the distance to the side plus 2^-22 of the origin's
/// coordinates, which is 0.05 mm at 100 m. The two are at a right angle to each other, so that one of them
/// leaves any edge that the first ray follows. They point towards no axis in particular, since edges follow
/// the axes.
struct Ray {
  vec3 origin, direction;
};
const uint looks = 3u;
Ray look(vec3 origin, vec3 direction, uint which) {
  if (which == 0u) return Ray(origin, direction);
  float size = length(direction);
  vec3 side = cross(direction, vec3(0.36, -0.48, 0.8));
  if (dot(side, side) < 0.01 * size * size) side = cross(direction, vec3(-0.64, 0.6, 0.48));
  if (which == 2u) side = cross(direction / size, side);
  side = normalize(side);
  vec3 magnitude = abs(origin);
  float reach = max(max(magnitude.x, magnitude.y), magnitude.z);
  return Ray(origin + side * (reach * 2.3841858e-7), direction + side * (size * 4.7683716e-7));
}

/// Returns the hit of trace_closest, made watertight whatever the driver. If a ray beside the first meets
/// another facet that is clearly nearer, then the first ray has slipped past that facet.
Hit trace_closest_watertight(vec3 origin, float t_min, vec3 direction, float t_max) {
  Hit hit = no_hit(t_max);
  for (uint which = 0u; which < looks; ++which) {  // one query in a loop: drivers compile it once
    Ray ray = look(origin, direction, which);
    Hit found = trace_closest(ray.origin, t_min, ray.direction, hit.t);
    if (!found.hit) continue;
    bool other = !hit.hit || scene_facet(found.triangle) != scene_facet(hit.triangle);
    if (which == 0u || (other && found.t < hit.t * (1.0 - 1.5258789e-5))) hit = found;
  }
  return hit;
}

/// Returns whether anything lies between t_min and t_max, except triangles of two facets.
bool trace_any(vec3 origin, float t_min, vec3 direction, float t_max, uint skip_facet_a, uint skip_facet_b) {
  return meet_any(origin, t_min, direction, t_max, skip_facet_a, skip_facet_b).hit;
}
bool trace_any_watertight(vec3 origin, float t_min, vec3 direction, float t_max, uint skip_facet_a,
                          uint skip_facet_b) {
  for (uint which = 0u; which < looks; ++which) {
    Ray ray = look(origin, direction, which);
    if (trace_any(ray.origin, t_min, ray.direction, t_max, skip_facet_a, skip_facet_b)) return true;
  }
  return false;
}

/// Holds the corners of a triangle in local coordinates.
struct Corners {
  vec3 a, b, c;
};
Corners triangle_corners(uint triangle, uint body) {
  uint first = 3u * triangle;
  Corners corners = Corners(scene_position(scene_index(first)), scene_position(scene_index(first + 1u)),
                            scene_position(scene_index(first + 2u)));
  if (body != 0u) {
    corners.a = body_point(body, corners.a);
    corners.b = body_point(body, corners.b);
    corners.c = body_point(body, corners.c);
  }
  return corners;
}

/// Returns the unit normal on the side that the winding faces (counter-clockwise), or zero for a triangle
/// without area.
vec3 geometric_normal(Corners corners) {
  vec3 normal = cross(corners.b - corners.a, corners.c - corners.a);
  float squared = dot(normal, normal);
  return squared > 0.0 ? normal * inversesqrt(squared) : vec3(0.0);
}

/// Holds the place of a hit, from its barycentric coordinates. This is far more exact than origin + t *
/// direction, whose error grows with the distance travelled. `error` bounds each coordinate by seven rounding
/// errors: of the products, the sums and the first barycentric coordinate (M. Pharr et al., "Physically Based
/// Rendering", 4th ed., section 6.8.5). The pose of a moving body adds some more, which trace_leaving makes
/// good.
struct HitPoint {
  vec3 position;
  vec3 error;
};
HitPoint hit_point(Corners corners, vec2 barycentric) {
  float first = 1.0 - barycentric.x - barycentric.y;
  HitPoint point;
  point.position = first * corners.a + barycentric.x * corners.b + barycentric.y * corners.c;
  vec3 magnitude = abs(first * corners.a) + abs(barycentric.x * corners.b) + abs(barycentric.y * corners.c);
  point.error = magnitude * (7.0 * 5.9604645e-8);
  return point;
}

/// Returns the start of a ray that leaves `point` on the side of `normal`. The start is moved along the
/// normal just beyond the error of the point, and rounded away from the surface. It is for queries only:
/// lengths and delays never use it.
vec3 offset_origin(HitPoint point, vec3 normal) {
  vec3 start = point.position + normal * dot(abs(normal), point.error);
  vec3 bumped = intBitsToFloat(floatBitsToInt(start) + mix(ivec3(1), ivec3(-1), lessThan(start, vec3(0.0))) *
                                                           ivec3(sign(normal)));
  // Next to zero the integer step would cross from -0 to NaN patterns. A denormal step is too small to matter
  // anyway.
  return mix(bumped, start, lessThan(abs(start), vec3(1e-30)));
}
/// Returns the first triangle of another facet along a ray that leaves `facet` from a start made by
/// offset_origin. The offset deals with triangles in the same plane. Passing over the facet by name deals
/// with the rest, on triangles so large or so thin that a driver's own rounding exceeds the offset.
Hit trace_leaving(vec3 origin, vec3 direction, float t_max, uint facet) {
  Hit hit = trace_closest(origin, 0.0, direction, t_max);
  if (hit.hit && facet != no_facet && scene_facet(hit.triangle) == facet)
    hit = trace_closest_except(origin, 0.0, direction, t_max, no_body, facet, false);
  return hit;
}
#endif
