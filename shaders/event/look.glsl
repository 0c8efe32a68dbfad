// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds what a pixel sees at an instant between two pictures (docs/events.md, "Reconstructed instants").
#ifndef GREATX_EVENT_LOOK_GLSL
#define GREATX_EVENT_LOOK_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#include "lib/words.glsl"
#include "shared/reproject.h"

layout(set = 0, binding = event_reproject_binding, scalar) readonly buffer ReprojectBlock {
  ReprojectInterval between;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer CellList { u64vec2 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer PathList { PixelPath v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer TileList { vec4 v[]; };

/// Planes whose points lie that close in the picture, in pixels, are one surface.
const float same_surface_px = 0.05;
/// A plane that was tried last is taken if its point is off by less.
const float near_surface_px = 0.5;
const int most_tries = 3;

/// Holds a curve of vectors: the coefficients of 1, t, t^2, t^3.
struct Curve {
  vec3 c0, c1, c2, c3;
};
vec3 value_at(Curve curve, float t) { return curve.c0 + t * (curve.c1 + t * (curve.c2 + t * curve.c3)); }

/// Holds what the loops over instants read of the interval, in registers: a driver must load from a buffer
/// anew after each event that is stored.
struct Looks {
  vec2 size;  ///< of the pictures
  uint width;
  float dark;
  float sharpness;
  bool exact_world;
  uint grid, bodies;
  uint64_t paths;
  uint64_t cells[2];
  Curve origins[2];  ///< of the camera, by picture
};
Looks looks;

Curve origin_curve(uint first) {
  return Curve(between.world[first].o, between.world[first + 1u].o, between.world[first + 2u].o,
               between.world[first + 3u].o);
}

/// Loads `looks`. It comes before everything else.
void begin_looks() {
  looks.size = vec2(float(model.width), float(model.height));
  looks.width = model.width;
  looks.dark = model.dark;
  looks.sharpness = between.sharpness;
  looks.exact_world = between.exact_world != 0u;
  looks.grid = between.grid;
  looks.bodies = between.bodies;
  looks.paths = between.paths;
  looks.cells = between.cells;
  looks.origins = Curve[2](origin_curve(0u), origin_curve(4u));
}

struct Cell {
  vec3 plane;
  float luminance;
  uvec2 around;
  uint edges;
  uint ids;
};

/// Holds a surface: its plane in a picture and the body that carries it.
struct Patch {
  vec3 plane;
  uint body;
};

/// Holds what a pixel sees through one picture.
struct Look {
  bool found;
  float inverse_depth;  ///< at the instant
  float luminance;
  uint ids;
};

/// Holds an instant: its place on the grid, and the fraction of the interval.
struct Instant {
  uint index;
  float t;
};

Cell cell_at(uint picture, uint pixel) {
  CellList list = CellList(looks.cells[picture]);
  uvec4 a = quad_of(list.v[cell_quads * pixel]), b = quad_of(list.v[cell_quads * pixel + 1u]);
  vec4 f = uintBitsToFloat(a);
  return Cell(f.xyz, f.w, b.xy, b.z, b.w);
}
Patch patch_of(Cell cell) { return Patch(cell.plane, cell.ids >> 16); }

vec3 ray_part(uint i, vec2 pixel) {
  return between.world[i].r0 + between.world[i].rx * pixel.x + between.world[i].ry * pixel.y;
}
/// Returns a pixel's ray through a picture while the world goes through the interval.
Curve ray_curve(uint picture, vec2 pixel) {
  uint i = 4u * picture;
  return Curve(ray_part(i, pixel), ray_part(i + 1u, pixel), ray_part(i + 2u, pixel),
               ray_part(i + 3u, pixel));
}

/// Holds a pixel's ray and the camera, both in a picture's coordinates as seen from a body.
struct Ray {
  vec3 along;
  vec3 o;
};

Ray ray_of(uint picture, Curve curve, Instant at, uint body, vec2 pixel) {
  Ray ray;
  if (body == 0u && !looks.exact_world) {
    ray.along = value_at(curve, at.t);
    ray.o = value_at(looks.origins[picture], at.t);
  } else {
    PixelPath path =
        PathList(looks.paths).v[(picture * (looks.grid + 1u) + at.index) * looks.bodies + body];
    ray.along = path.r0 + path.rx * pixel.x + path.ry * pixel.y;
    ray.o = path.o;
  }
  return ray;
}

/// Describes where a pixel looks at a surface.
struct Spot {
  vec2 place;           ///< in the picture, pixels
  float inverse_depth;  ///< at the instant
  vec2 arm;             ///< how far the place moves with the inverse depth in the picture
};

Spot spot_of(Ray ray, vec3 plane) {
  float along = dot(plane, ray.along), behind = 1.0 - dot(plane, ray.o);
  vec3 p = ray.o * along + behind * ray.along;
  Spot spot;
  spot.place = p.xy / p.z;
  spot.inverse_depth = along / behind;
  spot.arm = ray.o.xy - spot.place * ray.o.z;
  return spot;
}

/// Returns how far a place d pixels from a cell's centre reaches towards its neighbours: right, left, down,
/// up.
vec4 reach_of(vec2 d) { return vec4(d.x, -d.x, d.y, -d.y); }
uvec4 edges_of(Cell cell) { return uvec4(cell.edges, cell.edges >> 8, cell.edges >> 16, cell.edges >> 24); }
vec4 along_of(uvec4 edges) { return vec4(edges & 127u) * (1.0 / 126.0); }

/// Returns the luminance at a place of the cell's pixel, d pixels from its centre. `over` is how far the
/// place reaches over the outlines, towards each neighbour.
float luminance_of(Cell cell, vec2 d, vec4 over) {
  // Between neighbours without an outline the luminance is the parabola through them.
  vec4 ratio = 0.5 * (d.xxyy * d.xxyy + reach_of(d));
  vec4 others = vec4(uintBitsToFloat(cell.around.x << 16), uintBitsToFloat(cell.around.x & 0xffff0000u),
                     uintBitsToFloat(cell.around.y << 16), uintBitsToFloat(cell.around.y & 0xffff0000u));
  if (cell.edges != 0x7f7f7f7fu) {
    uvec4 e = edges_of(cell);
    vec4 share = clamp((over - along_of(e)) * looks.sharpness + 0.5, 0.0, 1.0);
    bvec4 plain = equal(e & 127u, uvec4(cell_no_edge));
    share = mix(share, vec4(0.0), plain);
    bool steep = share.z + share.w > share.x + share.y;
    share *= steep ? vec4(0.0, 0.0, 1.0, 1.0) : vec4(1.0, 1.0, 0.0, 0.0);
    bvec4 straight = notEqual(e.yxwz & 127u, uvec4(cell_no_edge));  // an outline lies on the other side
    ratio = mix(share, mix(ratio, max(reach_of(d), 0.0), straight), plain);
  }
  return max(cell.luminance + dot(ratio, others - cell.luminance), 0.0);
}

/// Returns how far the place reaches over the cell's outlines at the instant. Those of occluders have moved
/// since the picture, against the surface of the cell.
vec4 over_outlines(uint picture, Cell cell, vec2 corner, vec2 d, Spot spot) {
  vec4 over = reach_of(d);
  if ((cell.edges & 0x80808080u) == 0u) return over;
  uvec4 e = edges_of(cell);
  vec4 along = along_of(e);
  for (int k = 0; k < 4; ++k) {
    bool may_touch = (e[k] & cell_occluder) != 0u && over[k] + 1.5 > along[k];
    if (may_touch) {
      ivec2 step = ivec2(k == 0 ? 1 : k == 1 ? -1 : 0, k == 2 ? 1 : k == 3 ? -1 : 0);
      ivec2 there = clamp(ivec2(corner) + step, ivec2(0), ivec2(looks.size) - 1);
      uint pixel = uint(there.y) * looks.width + uint(there.x);
      CellList list = CellList(looks.cells[picture]);
      vec4 other = uintBitsToFloat(quad_of(list.v[cell_quads * pixel]));
      vec2 shift = spot.arm * dot(other.xyz - cell.plane, vec3(spot.place, 1.0));
      over[k] += dot(shift, vec2(step));
    }
  }
  return over;
}

/// Returns whether the outline of an occluder comes within half a pixel of the place.
bool touches(Cell cell, vec2 d) {
  if ((cell.edges & 0x80808080u) == 0u) return false;
  uvec4 e = edges_of(cell);
  bvec4 near = greaterThan(reach_of(d) + 0.5, along_of(e));
  return any(near) && any(equal(uvec4(near) * (e & cell_occluder), uvec4(cell_occluder)));
}

/// Looks for the surface that the pixel sees through a picture. It begins with `patch_`, follows the planes
/// that it finds there, and leaves the last one in `patch_`.
Look look_through(uint picture, Curve curve, Instant at, vec2 pixel, inout Patch patch_) {
  Look look = Look(false, 0.0, 0.0, 0u);
  bool done = false;
  for (int i = 0; i < most_tries && !done; ++i) {
    Spot spot = spot_of(ray_of(picture, curve, at, patch_.body, pixel), patch_.plane);
    vec2 corner = floor(spot.place);
    bool inside = all(greaterThanEqual(corner, vec2(0.0))) &&
                  all(lessThan(corner, looks.size));
    if (!inside) {
      done = true;
    } else {
      Cell cell = cell_at(picture, uint(corner.y) * looks.width + uint(corner.x));
      vec2 d = spot.place - corner - 0.5;
      float gap = dot(cell.plane - patch_.plane, vec3(spot.place, 1.0));
      gap *= max(abs(spot.arm.x), abs(spot.arm.y));
      bool same = (cell.ids >> 16) == patch_.body;
      bool last = i == most_tries - 1;
      bool hit = same && abs(gap) < (last ? near_surface_px : same_surface_px);
      bool on_rim = !hit && gap < -same_surface_px && touches(cell, d);
      if (hit || on_rim) {
        vec4 over = reach_of(d);
        if (hit) over = over_outlines(picture, cell, corner, d, spot);
        look = Look(true, spot.inverse_depth, luminance_of(cell, d, over), cell.ids);
        done = true;
      } else {
        patch_ = patch_of(cell);
      }
    }
  }
  return look;
}
#endif
