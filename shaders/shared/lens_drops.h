// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Drops of rain on the plane glass before a lens: bindings, and the way of light through a drop. The frame is
// that of the camera: x right, y down, z forward; the drops lie on the outer face of the glass.
#ifndef GREATX_SHADERS_SHARED_LENS_DROPS_H
#define GREATX_SHADERS_SHARED_LENS_DROPS_H
#include "glsl.h"
#include "weather.h"

#ifdef __cplusplus
namespace greatx::shared {
using glm::dot;
using glm::max;
using std::sqrt;
}  // namespace greatx::shared
#endif

GREATX_SHARED_BEGIN

const uint drops_color_binding = 0u;  // storage: uvec2 [height, width], halves; read and written
const uint drops_small_binding = 1u;  // storage: uvec2, halves: means of blocks of drops_block^2 pixels
/// storage, words: for each tile, row by row, the first of its entries, and the end of all; the entries:
/// words where drops begin; the drops: x, y, radius as floats, m on the glass
const uint drops_words_binding = 2u;
const uint drops_block = 8u;
const uint drops_tile = 32u;     // pixels along a side
const uint drops_samples = 24u;  // points of the pupil that a pixel looks through

struct DropConstants {
  vec2 focal;  // pixels
  vec2 center;
  float glass;    // m, from the pupil
  float radius;   // of the pupil, m
  float contact;  // cosine of the contact angle
  uint width;
  uint height;
  uint tiles_across;
  uint step;  // 0: makes the small picture; 1: draws the drops
};

/// Describes the light that reaches the pupil through a drop: the unit direction from which it comes, and the
/// share that both faces of the water let through. Where the surface reflects it all, the share is 0.
struct DropWay {
  vec3 direction;
  float share;
};

/// Returns Fresnel's transmittance of unpolarized light from index `n1` to `n2`, with the cosines of its
/// angles.
GREATX_FUNCTION float face_transmittance(float n1, float cosine1, float n2, float cosine2) {
  float s = (n1 * cosine1 - n2 * cosine2) / (n1 * cosine1 + n2 * cosine2);
  float p = (n1 * cosine2 - n2 * cosine1) / (n1 * cosine2 + n2 * cosine1);
  return 1.0f - 0.5f * (s * s + p * p);
}

/// Follows a camera's ray (unit) out through a spherical cap of water, which it enters `offset` m from the
/// middle of its base. `radius` is that of the base, `contact` the cosine of the contact angle. The plane
/// glass turns no ray, so the ray is taken from air into water.
GREATX_FUNCTION DropWay way_through_drop(vec2 offset, float radius, float contact, vec3 ray) {
  DropWay way;
  float sphere = radius / sqrt(max(1.0f - contact * contact, 1e-8f));
  float across_x = ray.x / water_index, across_y = ray.y / water_index;
  vec3 inside = vec3(across_x, across_y, sqrt(1.0f - across_x * across_x - across_y * across_y));
  // The sphere's middle lies behind the glass.
  vec3 from = vec3(offset.x, offset.y, sphere * contact);
  float b = dot(from, inside);
  float t = -b + sqrt(max(b * b - dot(from, from) + sphere * sphere, 0.0f));
  vec3 normal = (from + t * inside) / sphere;
  float cosine = dot(normal, inside);
  float left = 1.0f - water_index * water_index * (1.0f - cosine * cosine);
  way.direction = ray;
  way.share = 0.0f;
  if (cosine > 0.0f && left > 0.0f) {
    float out_cosine = sqrt(left);
    way.direction = water_index * inside - (water_index * cosine - out_cosine) * normal;
    way.share = face_transmittance(1.0f, ray.z, water_index, inside.z) *
                face_transmittance(water_index, cosine, 1.0f, out_cosine);
  }
  return way;
}

GREATX_SHARED_END
#endif
