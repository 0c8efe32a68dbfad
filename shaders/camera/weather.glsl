// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts water and snow on surfaces (docs/light.md). Both lie only where nothing static is above, as the map of
// renderer/light/rain_cover.h says.
#ifndef GREATX_CAMERA_WEATHER_GLSL
#define GREATX_CAMERA_WEATHER_GLSL
#include "camera/haze.glsl"
#include "camera/light.glsl"
#include "camera/surface.glsl"

layout(set = 0, binding = rain_cover_binding) uniform sampler2DShadow rain_cover;

const float snow_albedo = 0.85;  // S. G. Warren, "Optical Properties of Snow", Rev. Geophys. 20 (1982)
const float snow_roughness = 0.9;

/// Returns the share of what falls from above that reaches a point: 0 under a roof.
float open_above(vec3 p, vec3 n) {
  vec3 q = p + camera.eye_high + (n + vec3(0.0, 0.0, 0.5)) * weather.cover_texel_m;
  float depth = clamp(q.z * weather.cover_depth_scale + weather.cover_depth_offset, 0.0, 1.0);
  return texture(rain_cover, vec3(q.xy * weather.cover_uv_scale + weather.cover_uv_offset, depth));
}

/// Puts snow and water on a surface. Returns how far a film of water covers it, from 0 to 1. Puddles and snow
/// lie on what never moves. Walls get a fifth of the water.
float weather_surface(inout Surface s, uint body) {
  float up = s.geometric.z;
  if (up < -0.2) return 0.0;
  float open = open_above(s.p, s.geometric);
  bool still = body == 0u;
  float noise = still && up > 0.3 ? ground_noise((s.p + camera.eye_high).xy) : 0.0;
  if (snow_on) {
    float cover = still ? open * smoothstep(0.3, 0.6, 0.3 * up + 0.7 * s.n.z) *
                              smoothstep(weather.snow_level - 0.05, weather.snow_level + 0.05, noise)
                        : 0.0;
    s.base_color = mix(s.base_color, vec3(snow_albedo), cover);
    s.metallic *= 1.0 - cover;
    s.roughness = mix(s.roughness, snow_roughness, cover);
    s.n = normalize(mix(s.n, s.geometric, 0.7 * cover));
    s.glow *= 1.0 - cover;
    open *= 1.0 - cover;
  }
  if (!wet_on) return 0.0;
  float soaks = porosity(s.roughness) * (1.0 - s.metallic);
  float film = weather.wetness * open * smoothstep(-0.2, 0.5, up);
  float puddle = 0.0;
  if (up > 0.98 && still && soaks > 0.0)
    puddle = open * smoothstep(weather.puddle_level, weather.puddle_level + puddle_rim, noise);
  s.base_color = mix(s.base_color, wet_albedo(s.base_color), max(film, puddle) * soaks);
  // The film thins out towards the high places.
  float rough = mix(0.45, film_roughness, smoothstep(0.2, 0.6, noise));
  // Rough slopes shed their water, and so do leaves.
  float smooths = film * mix(1.0, smoothstep(0.85, 0.97, up), soaks);
  s.roughness = mix(s.roughness, min(s.roughness, rough), smooths);
  s.roughness = mix(s.roughness, weather.ripple, puddle);
  s.metallic *= 1.0 - puddle;
  s.n = normalize(mix(s.n, s.geometric, max(0.85 * smooths, puddle)));
  return max(smooths, puddle);
}

/// Describes a mirror that MirrorPass completes: the weight of its image, its roughness, and the stored
/// radiance that it shows so far.
struct Mirror {
  float weight, roughness;
  vec3 shows;
};

/// Keeps what a level film of water mirrors of the sky, since MirrorPass replaces it where it finds something
/// else in the picture. `open` is the share of it that moving bodies leave.
void add_mirror(inout Mirror mirror, Surface s, Reflectance r, float weight, float open) {
  weight *= smoothstep(0.95, 0.99, s.geometric.z) * (1.0 - smoothstep(0.35, 0.5, s.roughness)) *
            dot(r.albedo, vec3(0.2126, 0.7152, 0.0722));
  if (weight < 0.002) return;
  if (haze_on) weight *= haze_passes(length(s.p));
  vec3 shows = vec3(0.0);
  if (sky_on) {
    OutdoorLight light = outdoor_light(s.p, s.n);
    shows = open * mirrored_light(light, s.n, reflect(-s.v, s.n), s.roughness, s.p);
  }
  mirror.weight += weight;
  mirror.roughness = s.roughness;
  mirror.shows = shows * camera.exposure;
}

uvec3 pack_mirror(Mirror mirror) {
  vec3 shows = min(mirror.shows, vec3(65504.0));
  return uvec3(packHalf2x16(vec2(mirror.weight, mirror.roughness)), packHalf2x16(shows.rg),
               packHalf2x16(vec2(shows.b, 0.0)));
}
#endif
