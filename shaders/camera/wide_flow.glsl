// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes how far a small motion of a point moves its picture behind a fisheye or an equirectangular lens
// (renderer/lens/wide_lens.h has the models), over the focal lengths. Nearly equal numbers are not
// subtracted. The including shader has k1 to k4.
#ifndef GREATX_CAMERA_WIDE_FLOW_GLSL
#define GREATX_CAMERA_WIDE_FLOW_GLSL

/// Returns the angle from (a, b) to (a + da, b + db).
float angle_between(float a, float b, float da, float db) {
  return atan(a * db - b * da, a * (a + da) + b * (b + db));
}

/// Returns the change of |v| if v changes by d. `before` and `after` are the two lengths.
float length_change(vec2 v, vec2 d, float before, float after) {
  return dot(2.0 * v + d, d) / max(before + after, 1e-30);
}

float fisheye_shown(float t) {
  float s = t * t;
  return t * (1.0 + s * (k1 + s * (k2 + s * (k3 + s * k4))));
}

/// Returns fisheye_shown(t + by) - fisheye_shown(t).
float fisheye_shown_change(float t, float by) {
  // Of t^n the change is by times the sum of t^i u^(n-1-i), with u = t + by.
  float u = t + by, power = 1.0, sum = 1.0, change = 1.0;
  const float k[4] = float[4](k1, k2, k3, k4);
  for (int i = 0; i < 4; ++i) {
    power *= u;  // sum: t^i u^0 + ... + t^0 u^i
    sum = sum * t + power;
    power *= u;
    sum = sum * t + power;
    change += k[i] * sum;
  }
  return by * change;
}

vec2 fisheye_difference(vec3 n, vec3 d) {
  vec2 m = n.xy + d.xy;
  float before = length(n.xy), after = length(m);
  float longer = length_change(n.xy, d.xy, before, after);
  float t = atan(before, n.z), turn = angle_between(n.z, before, d.z, longer);
  vec2 axis = before > 1e-12 ? n.xy / before : vec2(0.0);
  vec2 axis_change = after > 1e-12 ? (d.xy - axis * longer) / after : vec2(0.0);
  if (before <= 1e-12) axis_change = after > 1e-12 ? m / after : vec2(0.0);
  return axis_change * fisheye_shown(t + turn) + axis * fisheye_shown_change(t, turn);
}

vec2 equirectangular_difference(vec3 n, vec3 d) {
  vec2 level = n.xz, m = level + d.xz;
  float before = length(level), after = length(m);
  float longer = length_change(level, d.xz, before, after);
  // Azimuth from z towards x, and the angle below the horizon, which v counts.
  return vec2(angle_between(n.z, n.x, d.z, d.x), angle_between(before, n.y, longer, d.y));
}
#endif
