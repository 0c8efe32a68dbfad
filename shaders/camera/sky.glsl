// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the light that a pixel sees where there is no surface.
#ifndef GREATX_CAMERA_SKY_GLSL
#define GREATX_CAMERA_SKY_GLSL
#include "camera/footprint.glsl"
#include "camera/haze.glsl"
#include "camera/land.glsl"
#include "camera/light.glsl"

layout(set = 0, binding = panorama_binding) uniform sampler2D panorama;
layout(set = 0, binding = stars_binding, scalar) readonly buffer StarsBlock { GpuStar stars[]; };

/// Describes how a picture samples the directions around one: the gradients of the unit direction by pixel
/// coordinates.
struct PixelSpan {
  vec3 x, y;
  // of the gradients' products; the root of the determinant is a pixel's solid angle
  float xx, xy, yy, determinant;
};

PixelSpan pixel_span(vec3 direction, float inverse_length) {
  PixelSpan s;
  s.x = (footprint_x() - direction * dot(direction, footprint_x())) * inverse_length;
  s.y = (footprint_y() - direction * dot(direction, footprint_y())) * inverse_length;
  s.xx = dot(s.x, s.x);
  s.xy = dot(s.x, s.y);
  s.yy = dot(s.y, s.y);
  s.determinant = s.xx * s.yy - s.xy * s.xy;
  return s;
}

/// Returns the share of a point's light that falls on the pixel, `away` from it. Tents of two pixels add up
/// to one over a picture.
float pixel_share(PixelSpan s, vec3 away) {
  float x = dot(away, s.x), y = dot(away, s.y);
  vec2 pixels = vec2(x * s.yy - y * s.xy, y * s.xx - x * s.xy) / s.determinant;
  vec2 tent = max(1.0 - abs(pixels), 0.0);
  return tent.x * tent.y;
}

/// Returns the radiance of the stars of the four cells that are nearest to a direction, each spread over a
/// pixel.
vec3 starlight(vec3 direction, PixelSpan span) {
  vec2 at = octahedral_uv(direction) * float(star_cells);
  ivec2 first = ivec2(floor(at - 0.5));
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 cell = clamp(first + ivec2(i & 1, i >> 1), ivec2(0), ivec2(int(star_cells) - 1));
    GpuStar star = stars[uint(cell.y) * star_cells + uint(cell.x)];
    vec2 light = unpackHalf2x16(star.light);
    vec3 to_star =
        octahedral_direction(2.0 * (vec2(cell) + unpackUnorm2x16(star.place)) / float(star_cells) - 1.0);
    // The colour has luminance 1 and goes from bluish white to orange.
    vec3 color = mix(vec3(0.88, 0.99, 1.45), vec3(1.42, 0.93, 0.45), light.y);
    sum += color * (light.x * 1e-6 * pixel_share(span, to_star - direction));
  }
  return sum * inversesqrt(span.determinant);
}

/// Returns the radiance of the moon's disc, whose edges are as soft as a pixel is wide.
vec3 moonlight(vec3 direction, PixelSpan span) {
  vec3 away = (direction - lighting.moon_direction) / lighting.moon_radius;
  float pixel = sqrt(sqrt(span.determinant)) / lighting.moon_radius;  // in radii
  if (dot(away, away) > (1.0 + 2.0 * pixel) * (1.0 + 2.0 * pixel)) return vec3(0.0);
  float lit_share = 0.5 + 0.5 * lighting.moon_cos_phase;
  // A disc smaller than a pixel is drawn as a star.
  if (pixel > 1.0)
    return lighting.moon_disc * (3.14159265 * lit_share / (pixel * pixel) *
                                 pixel_share(span, lighting.moon_direction - direction));
  float x = dot(away, lighting.moon_bright), y2 = max(dot(away, away) - x * x, 0.0);
  float rim = clamp((1.0 - length(away)) / pixel + 0.5, 0.0, 1.0);
  float terminator = x + lighting.moon_cos_phase * sqrt(max(1.0 - y2, 0.0));
  return lighting.moon_disc * (rim * clamp(terminator / pixel + 0.5, 0.0, 1.0));
}

/// Returns the coordinates in the panorama of a unit direction above the horizon: the upper half of an
/// octahedron, turned so that it fills the square (renderer/light/panorama.h).
vec2 panorama_uv(vec3 d) {
  vec2 p = d.xy / (abs(d.x) + abs(d.y) + abs(d.z));
  return vec2(p.x + p.y, p.x - p.y) * 0.5 + 0.5;
}

/// Returns the radiance of the sky itself along a unit direction. The map contains the haze above the
/// horizon. Below the horizon and beyond the scene, haze hides everything.
vec3 air_and_stars(vec3 direction, float inverse_length) {
  vec3 radiance;
  float passed = 1.0;  // of the light from beyond the clouds
  if (clouds_on && direction.z > 0.0) {
    vec4 seen = textureLod(panorama, panorama_uv(direction), 0.0);
    radiance = seen.rgb * lighting.environment_scale;
    passed = seen.a;
  } else {
    radiance = haze_on && direction.z <= 0.0 ? airlight(direction) : environment_radiance(direction, 0.0);
  }
  if (sun_on && dot(direction, lighting.sun_direction) > lighting.sun_cos_radius)
    radiance += lighting.sun_disc;
  if (night_sky_on && direction.z > 0.0) {
    PixelSpan span = pixel_span(direction, inverse_length);
    radiance += passed * (starlight(direction, span) + moonlight(direction, span));
  }
  return radiance;
}

/// Returns the radiance along a ray (of any length) that meets nothing.
vec3 sky_radiance(vec3 ray) {
  if (!sky_on) return vec3(0.0);
  float inverse_length = inversesqrt(dot(ray, ray));
  vec3 direction = ray * inverse_length;
  vec3 radiance = vec3(0.0);
  float rest = 1.0;  // share of the pixel that land does not hide
  if (horizon_kind != horizon_none) {
    vec4 land = land_radiance(horizon_kind, direction);
    radiance = land.rgb;
    rest = land.a;
  }
  if (rest > 0.0) radiance += rest * air_and_stars(direction, inverse_length);
  return min(radiance, vec3(65504.0) / camera.exposure);
}
#endif
