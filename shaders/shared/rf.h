// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Radio on the GPU: what rf/candidate_search.cpp, rf/visibility.cpp and shaders/rf/ agree on.
#ifndef GREATX_SHADERS_SHARED_RF_H
#define GREATX_SHADERS_SHARED_RF_H
#include "scene.h"

GREATX_SHARED_BEGIN

const uint rf_none = 0xffffffffu;  // no facet, no body

// ------------------------------------------------------------------------------------------------ candidate search

const uint candidates_directions_binding = first_pass_binding;  // vec3[rays], unit
const uint candidates_keys_binding =
    first_pass_binding + 1u;  // uint[rays * max_depth]: facets met, then rf_none
const uint candidates_group = 64u;

struct CandidateConstants {
  vec3 source;  // local coordinates
  uint rays;
  uint max_depth;
};

// ------------------------------------------------------------------------------------------------------ visibility

const uint visibility_segments_binding = first_pass_binding;      // GpuSegment[count]
const uint visibility_planes_binding = first_pass_binding + 1u;   // GpuFacetPlane[facets]
const uint visibility_results_binding = first_pass_binding + 2u;  // uint[count]: 1 visible, 0 blocked
const uint visibility_group = 64u;

struct GpuSegment {
  vec3 a, b;  // local coordinates
  uint facet_a, facet_b;
  uint body_a, body_b;
};

/// A facet's plane in its body's frame: (x - point) . normal = 0.
struct GpuFacetPlane {
  vec3 normal;
  vec3 point;
};

struct VisibilityConstants {
  uint count;
};

/// A surface this close to an end of a segment does not block it, metres: the end lies on it as far as fp32 can tell.
/// `coordinate` is the largest absolute coordinate of the end and of the surface's reference point. Rounding the end and
/// the point moves each by at most sqrt(3) * 2^-24 * coordinate; the mesh's own corners may stand off their facet's
/// plane by `coplanar` (scene::BuildOptions::coplanar_distance_m).
const float visibility_coplanar_m = 1e-4f;
GREATX_FUNCTION float visibility_tolerance(float coordinate) {
  return visibility_coplanar_m + 4.0f * 5.9604645e-8f * coordinate;
}

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::CandidateConstants) == 20);
static_assert(sizeof(greatx::shared::GpuSegment) == 40);
static_assert(sizeof(greatx::shared::GpuFacetPlane) == 24);
#endif
#endif
