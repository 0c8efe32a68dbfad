// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds the light of lamps. Each pixel looks only at the lamps of its cluster (renderer/camera/lamps.h makes
// the clusters).
#ifndef GREATX_CAMERA_LAMPS_GLSL
#define GREATX_CAMERA_LAMPS_GLSL
#include "camera/light.glsl"
#include "shared/beam.h"

layout(set = 0, binding = lights_binding, scalar) readonly buffer LampsBlock { uint lamp_words[]; };
layout(set = 0, binding = lights_binding, scalar) readonly buffer LampQuadsBlock { vec4 lamp_quads[]; };
layout(set = 0, binding = lamp_shadow_binding) uniform sampler2DShadow lamp_shadow;

float lamp_float(uint word) { return uintBitsToFloat(lamp_words[word]); }

/// Returns the word where the cluster of a point begins. It holds the first entry, and the next word their
/// number.
uint cluster_of(vec3 p) {
  float depth = max(dot(camera.forward, p), 1e-3);
  vec2 place = vec2(dot(camera.clip_x, p), dot(camera.clip_y, p)) / depth * 0.5 + 0.5;
  uint columns = lamp_words[lamps_columns_word], rows = lamp_words[lamps_rows_word];
  vec2 tile = place * vec2(lamp_float(lamps_across_word), lamp_float(lamps_down_word));
  uint column = whole(clamp(tile.x, 0.0, lamp_float(lamps_last_column_word)));
  uint row = whole(clamp(tile.y, 0.0, lamp_float(lamps_last_row_word)));
  uint slice =
      whole(clamp(lamp_slices_per_octave * log2(depth) + lamp_slice_of_1m, 0.0, float(lamp_slices - 1u)));
  return lamps_header_words + 2u * ((slice * rows + row) * columns + column);
}

/// Returns the share of a lamp's peak in a unit direction from it, beside that of its cone.
float beam_share(uint lamp, vec3 axis, vec3 direction) {
  if (lamp_words[4u * lamp + 15u] != lamp_of_beam) return 1.0;
  vec3 up = lamp_quads[lamp + 3u].xyz;
  vec3 away = direction / max(dot(direction, axis), 1e-3);
  return passing_beam(dot(away, cross(axis, up)), dot(away, up));
}

/// Returns the share of a lamp's light that reaches a point, `from_lamp` away from it, on a surface with the
/// given normal. What lies beside the lamp's tile is lit (renderer/light/lamp_shadow.h).
float lamp_visibility(uint lamp, vec3 from_lamp, vec3 axis, vec3 n) {
  vec4 tile = lamp_quads[lamp + 3u];
  float scale2 = dot(tile.xyz, tile.xyz);
  float depth = dot(axis, from_lamp);
  bool free = scale2 == 0.0 || ((beams_on || beam_shadows_on) && lamp_words[4u * lamp + 15u] >= lamp_of_cone);
  if (free || depth <= lamp_shadow_near) return 1.0;
  float texel_m = depth * weather.lamp_texel_uv * inversesqrt(scale2);
  vec3 q = from_lamp + n * (1.5 * texel_m);
  depth = dot(axis, q);
  vec2 offset = vec2(dot(tile.xyz, q), dot(cross(axis, tile.xyz), q)) / depth;
  if (max(abs(offset.x), abs(offset.y)) > weather.lamp_half_uv) return 1.0;
  vec2 uv = unpackUnorm2x16(floatBitsToUint(tile.w)) + offset;
  return texture(lamp_shadow, vec3(uv, lamp_shadow_near / (depth - 0.25 * texel_m - 0.01)));
}

/// Returns the share of the light of a spot that moves which reaches a point, as above
/// (renderer/light/beam_shadow.h).
float beam_visibility(uint lamp, vec3 from_lamp, vec3 axis, vec3 n) {
  vec3 tile = lamp_quads[lamp + 4u].yzw;
  float depth = dot(axis, from_lamp);
  if (tile.z == 0.0 || depth <= lamp_shadow_near) return 1.0;
  vec3 up = lamp_quads[lamp + 3u].xyz;
  float texel_m = depth * weather.lamp_texel_uv / min(tile.x, tile.y);
  vec3 q = from_lamp + n * (1.5 * texel_m);
  depth = dot(axis, q);
  vec2 tangents = vec2(dot(cross(axis, up), q), dot(up, q)) / depth;
  if (lamp_words[4u * lamp + 15u] == lamp_of_beam) tangents.y -= beam_tile_middle;
  vec2 offset = tangents * tile.xy;
  vec2 reach = (0.5 * vec2(beam_tile_width, beam_tile_height) - 1.0) * weather.lamp_texel_uv;
  if (any(greaterThan(abs(offset), reach))) return 1.0;
  vec2 uv = unpackUnorm2x16(lamp_words[4u * lamp + 16u]) + offset;
  float lit = texture(lamp_shadow, vec3(uv, lamp_shadow_near / (depth - 0.25 * texel_m - 0.01)));
  return mix(1.0, lit, tile.z);
}

/// Returns the radiance towards the eye by the lamps (KHR_lights_punctual's attenuation). Rough dielectrics
/// show no highlight of a lamp. They reflect diffusely the part of the light that their specular lobe would
/// reflect.
vec3 reflect_lamps(Reflectance r, vec3 n, vec3 geometric, vec3 v, vec3 p_eye, bool shiny) {
  uint cluster = cluster_of(p_eye);
  uint entry = lamp_words[cluster], end = entry + lamp_words[cluster + 1u];
  vec3 diffuse = vec3(0.0), mirrored = vec3(0.0);
  for (; entry < end; ++entry) {
    uint lamp = lamp_words[entry];
    vec4 place = lamp_quads[lamp], axis = lamp_quads[lamp + 1u], light = lamp_quads[lamp + 2u];
    bool directional = place.w < 0.0;
    vec3 to_lamp = directional ? place.xyz : place.xyz - p_eye;
    float d2 = max(dot(to_lamp, to_lamp), 1e-4);
    float nearness = inversesqrt(d2);
    vec3 l = to_lamp * nearness;
    float cone = clamp(light.w - dot(l, axis.xyz) * axis.w, 0.0, 1.0);
    float ratio = d2 * place.w;
    float attenuation =
        directional ? 1.0 : cone * cone * clamp(1.0 - ratio * ratio, 0.0, 1.0) * nearness * nearness;
    float n_dot_l = dot(n, l);
    if (beams_on && attenuation > 0.0 && n_dot_l > 0.0) attenuation *= beam_share(lamp, axis.xyz, -l);
    if (lamp_shadows_on && attenuation > 0.0 && n_dot_l > 0.0)
      attenuation *= lamp_visibility(lamp, -to_lamp, axis.xyz, geometric);
    if (beam_shadows_on && attenuation > 0.0 && n_dot_l > 0.0)
      attenuation *= beam_visibility(lamp, -to_lamp, axis.xyz, geometric);
    vec3 illuminance = light.rgb * (attenuation * max(n_dot_l, 0.0));
    diffuse += illuminance;
    bool highlight = specular_on && shiny && attenuation > 0.0 && n_dot_l > 0.0;
    if (highlight) {
      vec3 h = normalize(l + v);
      mirrored +=
          illuminance * specular_brdf(r, n_dot_l, clamp(dot(n, h), 0.0, 1.0), clamp(dot(l, h), 0.0, 1.0));
    }
  }
  vec3 albedo = r.diffuse + (shiny ? vec3(0.0) : r.albedo);
  return albedo * inverse_pi * diffuse + mirrored;
}
#endif
