// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Darkens surfaces near moving bodies, which the field of heights does not hold (renderer/light/contact.h).
#ifndef GREATX_CAMERA_CONTACT_GLSL
#define GREATX_CAMERA_CONTACT_GLSL
#include "camera/effects.glsl"
#include "camera/visibility_view.glsl"
#include "lib/words.glsl"
#include "shared/contact.h"

layout(set = 0, binding = contact_binding, scalar) readonly buffer ContactBlock { uint contact_words[]; };
layout(set = 0, binding = contact_binding, scalar) readonly buffer ContactPairsBlock {
  uint64_t contact_pairs[];
};
layout(set = 0, binding = contact_binding, scalar) readonly buffer ContactQuadsBlock {
  u64vec2 contact_quads[];
};

vec4 contact_quad(uint quad) { return uintBitsToFloat(quad_of(contact_quads[quad])); }

/// Returns the share that a box leaves free.
float box_open(uint quad, vec3 p, vec3 n, uint body) {
  vec4 place = contact_quad(quad), last = contact_quad(quad + 4u);
  uint bodies_of = floatBitsToUint(last.y);
  vec3 away = p - place.xyz;
  bool own = body >= (bodies_of & 0xffffu) && body <= bodies_of >> 16;
  if (own || dot(away, away) > last.z) return 1.0;
  vec4 x = contact_quad(quad + 1u), y = contact_quad(quad + 2u), z = contact_quad(quad + 3u);
  vec3 q = vec3(dot(away, x.xyz), dot(away, y.xyz), dot(away, z.xyz));
  vec3 m = vec3(dot(n, x.xyz), dot(n, y.xyz), dot(n, z.xyz));
  vec3 half_size = vec3(x.w, y.w, z.w);
  return 1.0 - last.x * contact_window(q, half_size, place.w) * box_share(q, m, half_size);
}

/// Returns the share of the sky's light that moving bodies leave to a point of `body`. A body and its parts
/// hide nothing from themselves.
float contact_open(vec3 p_eye, vec3 n, uint body) {
  vec3 p = p_eye + camera.eye_high;
  vec2 corner = vec2(uintBitsToFloat(contact_words[contact_corner_word]),
                     uintBitsToFloat(contact_words[contact_corner_word + 1u]));
  vec2 cell = (p.xy - corner) * uintBitsToFloat(contact_words[contact_inverse_word]);
  uint columns = contact_words[contact_columns_word], rows = contact_words[contact_rows_word];
  float open = 1.0;
  bool inside = all(greaterThanEqual(cell, vec2(0.0))) && all(lessThan(cell, vec2(columns, rows)));
  if (inside) {
    uint at = contact_header_words / 2u + uint(cell.y) * columns + uint(cell.x);
    uvec2 list = unpackUint2x32(contact_pairs[at]);
    uint entry = list.x, end = entry + list.y;
    for (; entry < end; ++entry) open *= box_open(contact_words[entry], p, n, body);
  }
  return open;
}
#endif
