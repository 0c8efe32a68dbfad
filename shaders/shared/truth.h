// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// renderer/ and the pass that writes a camera's ground truth share these definitions. docs/truth.md has the
// formulas.
#ifndef GREATX_SHADERS_SHARED_TRUTH_H
#define GREATX_SHADERS_SHARED_TRUTH_H
#include "glsl.h"

GREATX_SHARED_BEGIN

// These bindings of set 0 stand beside the scene's own.
const uint truth_seen_binding = 4u;                 // storage, uvec2: planar depth's bits, triangle + 1
const uint truth_triangle_primitives_binding = 5u;  // storage: the primitive of each triangle

// Specialization constants: the wanted arrays, whether some body moves, and the lens (float: its bits).
const uint truth_spec_normals = 0u;
const uint truth_spec_depth_ray = 1u;
const uint truth_spec_flow = 2u;
const uint truth_spec_moving = 3u;
const uint truth_spec_distorted = 4u;
const uint truth_spec_k1 = 5u;
const uint truth_spec_k2 = 6u;
const uint truth_spec_p1 = 7u;
const uint truth_spec_p2 = 8u;
const uint truth_spec_k3 = 9u;
const uint truth_spec_fold_squared = 10u;  // undistorted radius at which the lens folds, squared
// A fisheye or an equirectangular lens (renderer/lens/wide_lens.h): k1, k2, k3 as above. Seen depth is then
// the distance along the ray.
const uint truth_spec_wide = 11u;  // truth_lens_...; 0: neither
const uint truth_spec_k4 = 12u;
const uint truth_spec_half_angle = 13u;  // fisheye: where the image circle ends, rad
const uint truth_spec_count = 14u;
const uint truth_lens_fisheye = 1u;
const uint truth_lens_equirectangular = 2u;

const uint truth_group_size = 64u;

/// Describes how a body (index 0: the static world) moves against the camera until the camera's next sample,
/// in optical axes (x right, y down, z forward): X' = X + D X + t. Row i is (D_i0, D_i1, D_i2, t_i). The
/// identity is taken off in fp64.
struct GpuBodyMotion {
  vec4 row0;
  vec4 row1;
  vec4 row2;
};

/// Holds the push constants. The first members are those of CameraConstants that pixel_ray.glsl and
/// barycentrics need.
struct TruthConstants {
  uint64_t normals;  ///< addresses of the packed outputs, 0 where not wanted
  uint64_t depth_ray;
  uint64_t flow;
  uint64_t motions;  ///< GpuBodyMotion[bodies]
  /// Address of vec2[height * width]: the place, in pixels, where a pinhole camera shows what the pixel's
  /// centre sees. With truth_spec_wide: of vec3[height * width], unit directions in optical axes; 0: nothing.
  uint64_t lens;
  vec3 eye_high;
  vec3 eye_low;
  vec3 ray_x;
  vec3 ray_y;
  vec3 ray_0;
  vec2 focal;
  vec2 principal;
  uint width;
  uint height;
  float near_m;
};

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::GpuBodyMotion) == 48);
static_assert(sizeof(greatx::shared::TruthConstants) == 128);
#endif
#endif
