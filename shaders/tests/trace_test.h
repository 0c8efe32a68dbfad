// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the queries that tests/gpu/trace_test.cpp makes of lib/trace.glsl.
#ifndef GREATX_SHADERS_TESTS_TRACE_TEST_H
#define GREATX_SHADERS_TESTS_TRACE_TEST_H
#include "../shared/scene.h"

GREATX_SHARED_BEGIN

const uint trace_test_rays_binding = first_pass_binding;
const uint trace_test_results_binding = first_pass_binding + 1u;
const uint trace_test_none = 0xffffffffu;

struct TraceTestRay {
  vec3 origin;
  float t_min;
  vec3 direction;
  float t_max;
  uint skip_facet;  // for any_*, except_* and nothing else
  uint skip_body;   // for except_*
};

struct TraceTestResult {
  uint plain_triangle;  // trace_closest; trace_test_none: nothing
  uint triangle;        // trace_closest_watertight
  float t;
  uint next_triangle;  // trace_closest from just beyond that hit
  float next_t;
  uint any;              // trace_any_watertight with skip_facet
  uint except_triangle;  // trace_closest_except with skip_facet and skip_body
  float except_t;
  vec3 point;  // hit_point
  vec3 error;
  vec3 start;             // offset_origin towards the side that the ray came from
  uint bounce_triangle;   // trace_closest from there, reflected: uses the offset alone
  uint leaving_triangle;  // trace_leaving
};

/// Holds the result of tests/tree.comp.glsl: trace_closest_except with skip_facet and skip_body, by the
/// tracer that its pipeline has.
struct TreeTestResult {
  uint triangle;  // trace_test_none: nothing
  uint primitive;
  float t;
  vec2 barycentric;
  uint front;
};

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::TraceTestRay) == 40);
static_assert(sizeof(greatx::shared::TraceTestResult) == 76);
static_assert(sizeof(greatx::shared::TreeTestResult) == 24);
#endif
#endif
