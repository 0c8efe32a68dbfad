#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps of a picture what is needed to look at it again from other instants: of each pixel the plane of its
// surface, its luminance and that of its neighbours, and where the outlines between them are
// (shared/reproject.h). The camera has no lens that distorts.
#extension GL_EXT_shader_explicit_arithmetic_types : require
#include "camera/picture.glsl"
#include "camera/pixel_ray.glsl"
#include "camera/reach.glsl"
#include "shared/reproject.h"

layout(local_size_x = cell_tile, local_size_y = cell_tile) in;
layout(set = 0, binding = cells_seen_binding, scalar) readonly buffer SeenBlock { uvec2 picture_seen[]; };
layout(set = 0, binding = cells_luminance_binding, scalar) readonly buffer LuminanceBlock {
  float picture_luminance[];
};
layout(set = 0, binding = cells_to_binding, scalar) writeonly buffer CellsBlock { u64vec2 cells[]; };
layout(set = 0, binding = cells_ids_binding, scalar) readonly buffer IdsBlock { uvec2 ids[]; };
/// Whether outlines are known. They are not in pictures of several samples, which are interpolated.
layout(constant_id = cells_spec_outlines) const bool outlines_on = true;

/// Returns the plane of a triangle in the picture's pixel coordinates.
vec3 plane_of(Seen seen) {
  float offset = dot(seen.normal, seen.p0);
  vec3 n = seen.normal / (abs(offset) < 1e-20 ? 1e-20 : offset);
  return vec3(dot(n, camera.ray_x), dot(n, camera.ray_y), dot(n, camera.ray_0));
}

ivec2 step_to(int k) { return ivec2(k == 0 ? 1 : k == 1 ? -1 : 0, k == 2 ? 1 : k == 3 ? -1 : 0); }

/// Returns the byte of the outline towards a neighbour that sees something else.
uint edge_towards(ivec2 at, ivec2 step, uvec2 mine, uvec2 other, vec3 plane) {
  bool edge = mine.y == 0u || other.y == 0u || scene_facet(mine.y - 1u) != scene_facet(other.y - 1u);
  if (!edge) return cell_no_edge;
  vec3 ray = pixel_ray(vec2(at) + 0.5), way = pixel_ray(vec2(at + step) + 0.5) - ray;
  bool nearer = uintBitsToFloat(mine.x) <= uintBitsToFloat(other.x);
  Seen seen = see((nearer ? mine.y : other.y) - 1u);
  float along = nearer ? min(reach(seen, ray, way), 1.0) : 1.0 - min(reach(seen, ray + way, -way), 1.0);
  uint byte_of_edge = uint(along * 126.0 + 0.5);
  if (!nearer) {
    // The two surfaces meet at the outline, or the neighbour hides mine.
    vec3 there = vec3(vec2(at) + 0.5 + vec2(step) * along, 1.0);
    float its = dot(plane_of(seen), there);
    if (its - dot(plane, there) > 0.01 * its) byte_of_edge |= cell_occluder;
  }
  return byte_of_edge;
}

uint upper_half(float x) { return (floatBitsToUint(x) + 0x8000u) >> 16; }

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (outside_picture(at)) return;
  uint element = picture_element(at);
  uvec2 mine = picture_seen[element];
  float luminance = max(picture_luminance[element], 0.0);
  vec3 plane = vec3(0.0);
  uint body = 0u;
  if (mine.y != 0u) {
    Seen seen = see(mine.y - 1u);
    plane = plane_of(seen);
    body = seen.body;
  }
  uint edges = 0u, halves[4];
  for (int k = 0; k < 4; ++k) {
    ivec2 step = step_to(k);
    ivec2 there = clamp(at + step, ivec2(0), picture_size() - 1);
    uint neighbor = picture_element(there);
    uvec2 other = picture_seen[neighbor];
    halves[k] = upper_half(max(picture_luminance[neighbor], 0.0));
    uint edge = cell_no_edge;
    if (outlines_on && other.y != mine.y) edge = edge_towards(at, step, mine, other, plane);
    edges |= edge << (8 * k);
  }
  uint word = body << 16 | ids[mine.y].x & 0xffffu;
  cells[2u * element] = u64vec2(pack64(u32vec2(floatBitsToUint(plane.xy))),
                                pack64(u32vec2(floatBitsToUint(plane.z), floatBitsToUint(luminance))));
  uvec2 around = uvec2(halves[0] | halves[1] << 16, halves[2] | halves[3] << 16);
  cells[2u * element + 1u] = u64vec2(pack64(u32vec2(around)),
                                     pack64(u32vec2(edges, word)));
}
