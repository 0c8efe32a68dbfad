// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Radio on the GPU. rf/search/candidate_search.cpp, rf/paths/crossings.cpp and shaders/rf/ share these
// definitions.
#ifndef GREATX_SHADERS_SHARED_RF_H
#define GREATX_SHADERS_SHARED_RF_H
#include "scene.h"

GREATX_SHARED_BEGIN

const uint rf_none = 0xffffffffu;  // no facet, no body

// ----------------------------------------------------------------------------------------- candidate search

const uint candidates_directions_binding = first_pass_binding;  // vec3[all rays], unit
const uint candidates_kinds_binding = first_pass_binding + 1u;  // uint[facets]: rf::FacetKind
// uint[slots * rays * max_depth]: the facets of the reflections, then rf_none; the rays of a slot stand side
// by side. If asked for, uint[rays] follows: the ways that found no slot.
const uint candidates_keys_binding = first_pass_binding + 2u;
const uint candidates_group = 64u;

struct CandidateConstants {
  vec3 source;  // local coordinates
  uint first_ray;
  uint rays;  // rays of this dispatch
  uint max_depth;
  uint slots;
};

// The values of rf::FacetKind that matter here.
const uint facet_kind_wall = 1u;
const uint facet_kind_foliage = 2u;
const uint facet_kind_absent = 3u;

// ------------------------------------------------------------------------------------------------ crossings

const uint crossings_segments_binding = first_pass_binding;      // GpuSegment[count]
const uint crossings_planes_binding = first_pass_binding + 1u;   // GpuFacetPlane[facets]
const uint crossings_foliage_binding = first_pass_binding + 2u;  // GpuFoliageBox[foliage_boxes]
const uint crossings_results_binding = first_pass_binding + 3u;  // uint[count * row_words]
const uint crossings_leaders_binding = first_pass_binding + 4u;  // uint[]: results of a part before
const uint crossings_group = 64u;
const uint crossings_max = 8u;  // walls on a segment, at most

// A row of the results begins with crossings_blocked if the segment is blocked (also if the segment on which
// it depends is blocked); the rest is undefined. Otherwise it holds the number of walls (plus
// crossings_foliage_open and crossings_undecided), then, if the pass has foliage, the fraction of the segment
// inside it, then, if it has walls, the facets passed.
const uint crossings_blocked = 0xffffffffu;
// Flag: the line leaves foliage more or less often than it enters.
const uint crossings_foliage_open = 0x100u;
// Flag: the segment passes an edge within the roundings of fp32. Its walls are undefined, and it may be
// blocked; the host decides. A segment that depends on it is traced.
const uint crossings_undecided = 0x200u;
const uint crossings_foliage_one = 1u << 24;  // the whole segment, once

const uint crossings_end_in_foliage = 0x100u;  // flag: an end may be inside foliage of the static world

struct GpuSegment {
  vec3 a, b;  // local coordinates
  uint facet_a, facet_b;
  uint body_a, body_b;
  uint other_a, other_b;
  uint walls;  // most walls that it may pass, <= crossings_max; plus crossings_end_in_foliage
  // Row of the leaders' part, or rf_none. If the segment of that row is blocked, so is this one, without a
  // test.
  uint only_if;
};

/// Describes a facet's plane in its body's frame: (x - point) . normal = 0.
struct GpuFacetPlane {
  vec3 normal;
  vec3 point;
  uint kind;  // rf::FacetKind
  uint body;
};

/// Describes a box around all foliage of a body, in its frame, with room to spare.
struct GpuFoliageBox {
  vec3 low, high;
  uint body;
  uint owner;  // as GpuPrimitive's
};

struct CrossingConstants {
  uint count;  // rows of this part
  uint row_words;
  uint foliage_boxes;
  uint64_t planes;  // address of the planes, if they are larger than a storage buffer may be
};

/// A surface this close to an end of a segment does not block it, metres: the end lies on it as far as fp32
/// can tell. `coordinate` is the largest absolute coordinate of the end and of the surface's reference point.
/// Rounding the end and the point moves each by at most sqrt(3) * 2^-24 * coordinate. The mesh's own corners
/// may stand off their facet's plane by `coplanar` (scene::BuildOptions::coplanar_distance_m).
const float visibility_coplanar_m = 1e-4f;
GREATX_FUNCTION float visibility_tolerance(float coordinate) {
  return visibility_coplanar_m + 4.0f * 5.9604645e-8f * coordinate;
}

/// Sine of the least angle of two facets that make a seam: what lies behind their edge is dark.
const float crossings_seam_sine = 0.1f;
/// Rounding a corner and the ends moves each by at most sqrt(3) 2^-24 of the largest coordinate, `reach`, and
/// the traversal adds some roundings of distances: together less than 2^-20 reach. Edges at half of this
/// radius are noticed.
GREATX_FUNCTION float crossings_look_radius(float reach) { return 1.9073486e-6f * reach; }
/// A hit this far from all edges is certain. The corners may stand off their facet's plane by
/// visibility_coplanar_m, which moves them sideways by as much at 45 degrees.
GREATX_FUNCTION float crossings_edge_band(float reach) {
  return 2.0f * visibility_coplanar_m + crossings_look_radius(reach);
}

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::CandidateConstants) == 28);
static_assert(sizeof(greatx::shared::GpuSegment) == 56);
static_assert(sizeof(greatx::shared::GpuFacetPlane) == 32);
static_assert(sizeof(greatx::shared::GpuFoliageBox) == 32);
#endif
#endif
