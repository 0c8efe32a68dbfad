// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lamps: each pixel looks at those of its cluster alone (renderer/light/lamps.h makes the clusters).
#ifndef GREATX_CAMERA_LAMPS_GLSL
#define GREATX_CAMERA_LAMPS_GLSL
#include "camera/light.glsl"
#include "camera/octahedral.glsl"

layout(set = 0, binding = lights_binding, scalar) readonly buffer LampsBlock { uint lamp_words[]; };

float lamp_float(uint word) { return uintBitsToFloat(lamp_words[word]); }

/// The word where the cluster of a point begins: its first entry, then how many.
uint cluster_of(vec3 p) {
  float depth = max(dot(camera.forward, p), 1e-3);
  vec2 place = vec2(dot(camera.clip_x, p), dot(camera.clip_y, p)) / depth * 0.5 + 0.5;
  uint columns = lamp_words[lamps_columns_word], rows = lamp_words[lamps_rows_word];
  vec2 tile = place * vec2(lamp_float(lamps_across_word), lamp_float(lamps_down_word));
  uint column = uint(clamp(tile.x, 0.0, float(columns - 1u)));
  uint row = uint(clamp(tile.y, 0.0, float(rows - 1u)));
  uint slice = uint(clamp(lamp_slices_per_octave * log2(depth) + lamp_slice_of_1m, 0.0, float(lamp_slices - 1u)));
  return lamps_header_words + 2u * ((slice * rows + row) * columns + column);
}

/// Radiance towards the eye by the lamps (KHR_lights_punctual's attenuation).
vec3 reflect_lamps(Reflectance r, vec3 n, vec3 v, vec3 p_eye) {
  uint cluster = cluster_of(p_eye);
  uint entry = lamp_words[cluster], count = lamp_words[cluster + 1u];
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < count; ++i) {
    uint lamp = lamp_words[entry + i];
    vec3 position = vec3(lamp_float(lamp), lamp_float(lamp + 1u), lamp_float(lamp + 2u));
    uint packed_blue = lamp_words[lamp + 6u];
    bool directional = (packed_blue >> 16) != 0u;
    vec3 direction = octahedral_direction(lamp_words[lamp + 4u]);
    vec3 intensity = lamp_intensity_unit * vec3(unpackHalf2x16(lamp_words[lamp + 5u]), unpackHalf2x16(packed_blue).x);
    vec3 to_lamp = directional ? -direction : position - p_eye;
    float d2 = max(dot(to_lamp, to_lamp), 1e-4);
    vec3 l = to_lamp * inversesqrt(d2);
    float cone = clamp(dot(-l, direction) * lamp_float(lamp + 7u) + lamp_float(lamp + 8u), 0.0, 1.0);
    float ratio = d2 * lamp_float(lamp + 3u);
    float attenuation = directional ? 1.0 : cone * cone * clamp(1.0 - ratio * ratio, 0.0, 1.0) / d2;
    sum += reflect_light(r, n, v, l, intensity * attenuation);
  }
  return sum;
}
#endif
