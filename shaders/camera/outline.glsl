// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the outline of a triangle in the pinhole picture: whether a place lies within it, and where the
// way to a place within enters it. Edges are functions linear in pixels, so nothing is projected, and corners
// behind the eye do no harm.
#ifndef GREATX_CAMERA_OUTLINE_GLSL
#define GREATX_CAMERA_OUTLINE_GLSL
#include "camera/triangle.glsl"

/// The step to which the rasteriser snaps corners, in pixels. A place this far outside counts as inside,
/// since neighbours would otherwise have a gap.
const float outline_slack = 1.0 / 256.0;

struct Outline {
  float side;      // sign that makes its edge functions positive inside
  float offset;    // offset of its plane: depth = offset / sum of the edge functions
  vec3 slope;      // slope of each edge function, per pixel
  float nearest;   // least planar depth of its corners, not nearer than the near plane
  float farthest;
  bool thin;       // less than a pixel across
};

/// Returns one value an edge, positive on the inner side, for a ray with planar depth 1.
vec3 edge_functions(Seen seen, float side, vec3 ray) {
  vec3 f = side * vec3(dot(ray, seen.u_numerator), dot(ray, seen.v_numerator), dot(ray, seen.normal));
  f.z -= f.x + f.y;
  return f;
}

Outline outline_of(Seen seen) {
  Outline outline;
  float offset = dot(seen.p0, seen.normal);
  outline.side = offset < 0.0 ? -1.0 : 1.0;
  outline.offset = abs(offset);
  vec3 across = edge_functions(seen, outline.side, camera.ray_x),
       down = edge_functions(seen, outline.side, camera.ray_y);
  outline.slope = sqrt(across * across + down * down);
  // Takes the depth of each corner beside the edge that the corner does not lie on.
  vec3 depths =
      dot(camera.forward, seen.p0) + vec3(dot(camera.forward, seen.e1), dot(camera.forward, seen.e2), 0.0);
  outline.nearest = max(min(depths.x, min(depths.y, depths.z)), camera.near_m);
  outline.farthest = max(depths.x, max(depths.y, depths.z));
  // At its corner an edge function is offset / depth. Divided by the slope, it is the corner's distance from
  // the edge in pixels.
  outline.thin = any(greaterThan(depths * outline.slope, vec3(outline.offset)));
  return outline;
}

/// Returns the planar depth where the edge functions have these values. It lies on the triangle whatever the
/// rounding.
float outline_depth(Outline outline, vec3 f) {
  float depth = outline.offset / (f.x + f.y + f.z);
  return depth >= outline.nearest ? min(depth, outline.farthest) : outline.nearest;
}

/// Returns whether a ray meets the triangle beyond the near plane.
bool outline_covers(Outline outline, vec3 f) {
  float sum = f.x + f.y + f.z;
  return all(greaterThanEqual(f, -outline_slack * outline.slope)) && sum > 0.0 &&
         outline.offset >= camera.near_m * sum;
}

/// Returns the edge functions where the way from a place outside (`from`) to one inside (`to`) enters.
vec3 outline_entered(vec3 from, vec3 to) {
  float way = 0.0;
  for (int i = 0; i < 3; ++i)
    if (from[i] < 0.0) way = max(way, from[i] / (from[i] - max(to[i], 0.0)));
  return mix(from, to, way);
}
#endif
