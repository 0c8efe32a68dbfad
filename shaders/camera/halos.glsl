// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds the light of lamps that fog and rain scatter once towards the eye: the airlight integral (B. Sun, R.
// Ramamoorthi, S. Narasimhan, S. Nayar, "A Practical Analytic Single Scattering Model for Real Time
// Rendering", SIGGRAPH 2005, eq. 4). Along the ray it is an integral over the scattering angle (C. Kulla, M.
// Fajardo, "Importance Sampling Techniques for Path Tracing in Participating Media", EGSR 2012, section 5).
// The places of Gauss' four points follow the phase function, so that its peak towards the lamp costs no
// accuracy.
#ifndef GREATX_CAMERA_HALOS_GLSL
#define GREATX_CAMERA_HALOS_GLSL
#include "camera/lamps.glsl"

const float halo_places[4] = float[](0.06943184, 0.33000948, 0.66999052, 0.93056816);
const float halo_weights[4] = float[](0.17392742, 0.32607258, 0.32607258, 0.17392742);

/// Returns 2 sin(theta / 2) of the scattering angle where the ray is `x` before the place nearest to the
/// lamp, which is `s` away from it.
float halo_chord(float x, float s) {
  float r = sqrt(x * x + s * s);
  return sqrt(2.0 * (x > 0.0 ? s * s / (r * (r + x)) : (r - x) / r));
}

/// Returns the radiance that a lamp adds to the air along the ray up to `distance`.
vec3 halo_of(uint lamp, vec3 direction, float distance) {
  vec4 place = lamp_quads[lamp], axis = lamp_quads[lamp + 1u], light = lamp_quads[lamp + 2u];
  float nearest = dot(place.xyz, direction);
  float s2 = max(dot(place.xyz, place.xyz) - nearest * nearest, 0.0025), s = sqrt(s2);
  float reach2 = 1.0 / place.w - s2;
  if (reach2 <= 0.0) return vec3(0.0);
  float reach = sqrt(reach2);
  float begin = max(nearest - reach, 0.0), end = min(nearest + reach, distance);
  if (end <= begin) return vec3(0.0);
  float g = lighting.haze_asymmetry, b2 = (1.0 - g) * (1.0 - g) / g;
  float y0 = halo_chord(nearest - begin, s), y1 = halo_chord(nearest - end, s);
  float u0 = y0 * inversesqrt(b2 + y0 * y0), u1 = y1 * inversesqrt(b2 + y1 * y1);
  float lamp_axis = dot(place.xyz, axis.xyz), ray_axis = dot(direction, axis.xyz), sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    float u = mix(u0, u1, halo_places[i]);
    float h = min(0.25 * b2 * u * u / max(1.0 - u * u, 1e-6), 0.9999);  // sin^2(theta / 2)
    float sine = 2.0 * sqrt(h * (1.0 - h)), r = s / sine, x = r * (1.0 - 2.0 * h), t = nearest - x;
    float cone = clamp(light.w - (lamp_axis - t * ray_axis) / r * axis.w, 0.0, 1.0);
    float ratio = r * r * place.w;
    float window = clamp(1.0 - ratio * ratio, 0.0, 1.0);
    float shape = cone * cone;
    if (beams_on && shape > 0.0) shape *= beam_share(lamp, axis.xyz, (t * direction - place.xyz) / r);
    sum += halo_weights[i] * shape * window * exp(-lighting.haze_extinction * (t + r)) *
           inversesqrt(1.0 - h);
  }
  float phase = 0.0795774715 * (1.0 - g * g) * inversesqrt(g * g * g) / b2;
  return light.rgb * (lighting.haze_extinction / s * phase * (u1 - u0) * sum);
}

/// Returns the radiance that lamps add to the air before a pixel of the pinhole picture. `direction` is unit.
vec3 lamp_halos(vec2 pixel, vec3 direction, float distance) {
  uint column = whole(clamp(pixel.x / float(lamp_tile_pixels), 0.0, lamp_float(lamps_last_column_word)));
  uint row = whole(clamp(pixel.y / float(lamp_tile_pixels), 0.0, lamp_float(lamps_last_row_word)));
  uint list = lamp_words[lamps_halos_word] + 2u * (row * lamp_words[lamps_columns_word] + column);
  uint entry = lamp_words[list], end = entry + lamp_words[list + 1u];
  vec3 sum = vec3(0.0);
  for (; entry < end; ++entry) {
    uint lamp = lamp_words[entry];
    sum += halo_of(lamp, direction, distance);
  }
  return sum;
}
#endif
