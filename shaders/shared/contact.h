// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The light of the sky that boxes around moving bodies hide from a point near them. The share is the form
// factor of the sides of the box that the point sees: the sum over their edges of J. H. Lambert's formula
// ("Photometria", 1760; D. Baum, H. Rushmeier, J. Winget, "Improving Radiosity Solutions Through the Use of
// Analytically Determined Form-Factors", SIGGRAPH 1989). docs/global_light.md has the errors.
#ifndef GREATX_SHADERS_SHARED_CONTACT_H
#define GREATX_SHADERS_SHARED_CONTACT_H
#include "glsl.h"

#ifdef __cplusplus
namespace greatx::shared {
using glm::abs;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::inversesqrt;
using glm::length;
using glm::max;
using glm::min;
using glm::normalize;
}  // namespace greatx::shared
#endif

GREATX_SHARED_BEGIN

const uint contact_binding = 21u;  // storage: words as below, this tick's

/// The words are a header, (first entry, count) of each cell of a level grid, the entries (quadruples of
/// words where boxes begin), and the boxes.
const uint contact_corner_word = 0u;   // floats: local x, y of the first cell's corner
const uint contact_inverse_word = 2u;  // float: cells a metre
const uint contact_columns_word = 3u;
const uint contact_rows_word = 4u;
const uint contact_header_words = 6u;
/// A box is five quadruples of floats: centre (local) and reach; three times a unit axis and half of the
/// size along it; opacity, the bits of first body | last body << 16, the square of the distance from the
/// centre beyond which it hides nothing.
const uint contact_box_quads = 5u;
/// The last part of a box's reach over which its share fades to nothing.
const float contact_fade = 0.3f;

/// Returns the angle between two unit vectors over 2 pi sin of it, times their cross product: the edge's part
/// of Lambert's sum. The quotient is a rational fit with an error below 1e-4 (S. Hill and E. Heitz,
/// "Real-Time Area Lighting: a Journey from Research to Production", SIGGRAPH course 2016).
GREATX_FUNCTION vec3 contact_edge(vec3 a, vec3 b) {
  float x = dot(a, b);
  float y = abs(x);
  float v = (0.8543985f + (0.4965155f + 0.0145206f * y) * y) / (3.4175940f + (4.1616724f + y) * y);
  float turn = x > 0.0f ? v : 0.5f * inversesqrt(max(1.0f - x * x, 1e-7f)) - v;
  return cross(a, b) * turn;
}

/// Returns the direction to a corner, raised to the horizon of the normal if it lies below.
GREATX_FUNCTION vec3 contact_corner(vec3 to_corner, vec3 n) {
  return normalize(to_corner - n * min(dot(to_corner, n), 0.0f) + n * 1e-6f);
}

/// Returns the form factor of a rectangle with a centre, seen from the origin, and half edges u and v.
GREATX_FUNCTION float contact_side(vec3 center, vec3 u, vec3 v, vec3 n) {
  vec3 a = contact_corner(center - u - v, n), b = contact_corner(center + u - v, n),
       c = contact_corner(center + u + v, n), d = contact_corner(center - u + v, n);
  return abs(dot(contact_edge(a, b) + contact_edge(b, c) + contact_edge(c, d) + contact_edge(d, a), n));
}

/// Returns the share of the hemisphere over n, weighted by the cosine, that a solid box around the origin
/// hides from the point p outside it. It is exact for a box above the point's horizon. Corners below the
/// horizon are raised to it. From within the box nothing is hidden, but from within its lowest fifth it is
/// all: ground lies there.
GREATX_FUNCTION float box_share(vec3 p, vec3 n, vec3 half_size) {
  vec3 beyond = abs(p) - half_size;
  if (max(beyond.x, max(beyond.y, beyond.z)) <= 0.0f)
    return p.z < -0.6f * half_size.z && n.z > 0.5f ? 1.0f : 0.0f;
  if (dot(abs(n), half_size) <= dot(p, n)) return 0.0f;  // it lies below the horizon
  vec3 x = vec3(half_size.x, 0.0f, 0.0f), y = vec3(0.0f, half_size.y, 0.0f),
       z = vec3(0.0f, 0.0f, half_size.z);
  float share = 0.0f;
  if (beyond.x > 0.0f) share += contact_side((p.x > 0.0f ? x : -x) - p, y, z, n);
  if (beyond.y > 0.0f) share += contact_side((p.y > 0.0f ? y : -y) - p, x, z, n);
  if (beyond.z > 0.0f) share += contact_side((p.z > 0.0f ? z : -z) - p, x, y, n);
  return min(share, 1.0f);
}

/// Returns the part of a box's share that counts at a distance from its surface.
GREATX_FUNCTION float contact_window(vec3 p, vec3 half_size, float reach) {
  float distance = length(max(abs(p) - half_size, vec3(0.0f)));
  return clamp((reach - distance) / (contact_fade * reach), 0.0f, 1.0f);
}

GREATX_SHARED_END
#endif
