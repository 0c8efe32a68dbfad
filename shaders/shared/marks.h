// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The camera's shaders and renderer/surface/mark_map.h share this description of the markings of roads.
#ifndef GREATX_SHADERS_SHARED_MARKS_H
#define GREATX_SHADERS_SHARED_MARKS_H
#include "glsl.h"

GREATX_SHARED_BEGIN

/// The bits of a triangle's record beside that of the mirrored normal map (shared/camera.h, quadruple 4).
const uint triangle_mirrored = 1u;
const uint triangle_of_road = 2u;  ///< it may have markings
const uint triangle_of_mark = 4u;
const uint triangle_switched = 8u;  ///< it belongs to a switched lamp (quadruple 5)

/// A pixel takes the share of markings from the map instead of its triangle where it is longer than the
/// second of these on the ground, m; between the two it blends.
const float marks_from_m = 0.2f;
const float marks_whole_m = 0.4f;
/// The levels of the map beside the first.
const uint marks_levels = 6u;
const uint marks_taps = 8u;  ///< looks along the longer axis of a pixel, at most

struct GpuMarks {
  vec2 scale;  ///< uv = local x, y times scale + offset
  vec2 offset;
  vec3 mark;         ///< mean colour of markings
  float texel_m;     ///< edge of a texel
  vec3 road;         ///< mean colour of roads
  float mark_rough;  ///< mean roughness of markings
  float road_rough;
};

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::GpuMarks) == 52);
#endif
#endif
