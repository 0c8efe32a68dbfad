// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the light that arrives at a surface point: sun with its shadows, sky, lamps.
#ifndef GREATX_CAMERA_LIGHT_GLSL
#define GREATX_CAMERA_LIGHT_GLSL
#include "camera/effects.glsl"
#include "camera/octahedral.glsl"
#include "camera/surroundings.glsl"
#include "camera/visibility_view.glsl"
#include "lib/words.glsl"
#include "shared/brdf.h"
#include "shared/weather.h"

layout(set = 0, binding = lighting_binding, scalar) uniform LightingBlock { GpuLighting lighting; };
layout(set = 0, binding = weather_binding, scalar) uniform WeatherBlock { GpuWeather weather; };
layout(set = 0, binding = shadow_tiles_binding, scalar) readonly buffer ShadowTilesBlock {
  ShadowTilesHeader shadow_tiles_header;
  uint shadow_cells[];
};
layout(set = 0, binding = shadow_tiles_binding, scalar) readonly buffer ShadowTileQuadsBlock {
  u64vec2 shadow_quads[];
};
layout(set = 0, binding = environment_binding) uniform sampler2D environment;
layout(set = 0, binding = static_shadow_binding) uniform sampler2DShadow static_shadow;
layout(set = 0, binding = near_shadows_binding, scalar) readonly buffer NearShadowsBlock {
  GpuNearShadows near_shadows;
};
layout(set = 0, binding = fine_shadow_binding) uniform sampler2DShadow fine_shadow;
layout(set = 0, binding = middle_shadow_binding) uniform sampler2DShadow middle_shadow;
layout(set = 0, binding = moving_shadow_binding) uniform sampler2DShadow moving_shadow;
layout(set = 0, binding = sky_view_binding) uniform sampler2D sky_view;

/// Returns the radiance from a direction, blurred for a roughness.
vec3 environment_radiance(vec3 direction, float roughness) {
  float level = roughness * float(environment_levels - 1u);
  return textureLod(environment, octahedral_uv(direction), level).rgb * lighting.environment_scale;
}

/// Returns the irradiance of the sky on a plane, over pi (Ramamoorthi and Hanrahan, SIGGRAPH 2001). The
/// coefficients are already convolved and scaled by the basis.
vec3 sky_irradiance_over_pi(vec3 n) {
  vec3 e = lighting.irradiance[0].rgb;
  e += lighting.irradiance[1].rgb * n.y + lighting.irradiance[2].rgb * n.z + lighting.irradiance[3].rgb * n.x;
  e += lighting.irradiance[4].rgb * (n.x * n.y) + lighting.irradiance[5].rgb * (n.y * n.z);
  e += lighting.irradiance[6].rgb * (3.0 * n.z * n.z - 1.0) + lighting.irradiance[7].rgb * (n.x * n.z);
  e += lighting.irradiance[8].rgb * (n.x * n.x - n.y * n.y);
  return max(e, vec3(0.0));
}

/// Returns the share of the light that passes a shadow map at uv. If `near`, it makes four bilinear
/// comparisons, a 3 x 3 texel tent. Otherwise it makes one, since a pixel is then no smaller than a texel.
/// Panes fill some texels of every square of 2 x 2. The tent weighs each of the four alike; where there are
/// panes, the single comparison is at the nearest corner of texels and does so, too.
float shadow_filter(sampler2DShadow map, vec2 uv, float depth, float texel_uv, bool near) {
  float r = near ? 0.5 : 0.0;
  if (pane_shadows_on) uv = near ? uv : floor(uv / texel_uv + 0.5) * texel_uv;
  float sum = texture(map, vec3(uv + texel_uv * vec2(-r, -r), depth));
  if (near) {
    sum += texture(map, vec3(uv + texel_uv * vec2(r, -r), depth));
    sum += texture(map, vec3(uv + texel_uv * vec2(-r, r), depth));
    sum += texture(map, vec3(uv + texel_uv * vec2(r, r), depth));
    sum *= 0.25;
  }
  return sum;
}

/// Moves the point off its surface by the length that a texel can hide; the move is along the normal where
/// the light grazes.
vec3 shadow_point(vec3 p, vec3 n_light, float texel_m) {
  float slope = sqrt(max(1.0 - n_light.z * n_light.z, 0.0));
  return p + n_light * (texel_m * (0.25 + 1.75 * slope)) + vec3(0.0, 0.0, 0.25 * texel_m);
}

/// Returns floor(x) for 0 <= x < 2^22 from the digits of a float: CPU drivers convert lane by lane.
uint whole(float x) { return floatBitsToUint(floor(x) + 8388608.0) & 0x7fffffu; }

/// Returns the share of the sun that passes the tile of one moving body, which stands at a quadruple.
float tile_visibility(uint quad, vec3 p, vec3 n, float pixel_m) {
  float visible = 1.0;
  vec4 ball = uintBitsToFloat(quad_of(shadow_quads[quad]));  // centre, radius
  vec3 q = (p - ball.xyz) / ball.w;
  bool inside = max(abs(q.x), abs(q.y)) < 1.0 && q.z < 1.0;
  if (inside) {
    vec4 tile = uintBitsToFloat(quad_of(shadow_quads[quad + 1u]));  // uv of the centre, half edge, texel
    q = (shadow_point(p, n, tile.w) - ball.xyz) / ball.w;
    float depth = clamp(0.5 * q.z + 0.5, 0.0, 1.0);
    visible = shadow_filter(moving_shadow, tile.xy + q.xy * tile.z, depth, 1.0 / lighting.moving_map_size,
                            pixel_m < shadow_near * tile.w);
  }
  return visible;
}

/// Returns the share of the sun that passes the moving bodies, of which only those of the point's cell count.
float moving_visibility(vec3 p, vec3 n, float pixel_m) {
  vec2 at = clamp(floor((p.xy - shadow_tiles_header.min) * shadow_tiles_header.cells_per_m), vec2(0.0),
                  vec2(shadow_tiles_header.columns, shadow_tiles_header.rows) - 1.0);
  uint cell = shadow_cells[whole(at.y * shadow_tiles_header.columns + at.x)];
  uint quad = cell >> shadow_cell_bits, end = quad + 2u * (cell & shadow_cell_most);
  float visible = 1.0;
  for (; quad < end; quad += 2u) visible *= tile_visibility(quad, p, n, pixel_m);
  return visible;
}

/// Returns the share of the sun that passes the static world by the map over all of it.
float whole_visibility(vec3 p, vec3 n, float pixel_m) {
  vec3 q = shadow_point(p, n, lighting.static_texel_m);
  float depth = clamp(q.z * lighting.static_depth_scale + lighting.static_depth_offset, 0.0, 1.0);
  vec2 uv = q.xy * lighting.static_uv_scale + lighting.static_uv_offset;
  return shadow_filter(static_shadow, uv, depth, 1.0 / lighting.static_map_size,
                       pixel_m < shadow_near * lighting.static_texel_m);
}

/// Returns the same by a cascade.
float cascade_visibility(sampler2DShadow map, uint cascade, vec3 p, vec3 n, float pixel_m) {
  float texel_m = near_shadows.texel_m[cascade];
  vec3 q = shadow_point(p, n, texel_m);
  float depth = clamp(q.z * lighting.static_depth_scale + lighting.static_depth_offset, 0.0, 1.0);
  float uv_scale = near_shadows.uv_scale[cascade];
  return shadow_filter(map, q.xy * uv_scale, depth, texel_m * uv_scale, pixel_m < shadow_near * texel_m);
}

/// Returns the share of the sun that passes the static world. A cascade fades into the next coarser one.
float static_visibility(vec3 p, vec3 n, float pixel_m) {
  if (shadow_cascades == 0u) return whole_visibility(p, n, pixel_m);
  vec2 from_center = abs(p.xy - near_shadows.center);
  vec2 weight = clamp(
      (near_shadows.reach - max(from_center.x, from_center.y)) * near_shadows.fade, vec2(0.0), vec2(1.0));
  bool fine = weight.x > 0.0, middle = shadow_cascades > 1u && weight.x < 1.0 && weight.y > 0.0;
  float visible = 1.0;
  bool whole = shadow_cascades > 1u ? weight.x < 1.0 && weight.y < 1.0 : weight.x < 1.0;
  if (whole) visible = whole_visibility(p, n, pixel_m);
  if (middle) visible = mix(visible, cascade_visibility(middle_shadow, 1u, p, n, pixel_m), weight.y);
  if (fine) visible = mix(visible, cascade_visibility(fine_shadow, 0u, p, n, pixel_m), weight.x);
  return visible;
}

/// Returns the share of the sun that reaches a point. The geometric normal is in the local frame and faces
/// the sun.
float sun_visibility(vec3 p_eye, vec3 normal) {
  float visible = 1.0;
  if (!static_shadows_on && !moving_shadows_on) return visible;
  float pixel_m = dot(camera.forward, p_eye) * length(camera.ray_x);
  vec3 n =
      vec3(dot(lighting.light_x, normal), dot(lighting.light_y, normal), dot(lighting.sun_direction, normal));
  vec3 p = camera.light_eye + vec3(dot(lighting.light_x, p_eye), dot(lighting.light_y, p_eye),
                                   dot(lighting.sun_direction, p_eye));
  if (static_shadows_on) visible = static_visibility(p, n, pixel_m);
  if (moving_shadows_on) {
    // The common bounds of the tiles stand at fixed places, so one load serves all lanes.
    bool near =
        all(greaterThan(p.xy, shadow_tiles_header.min)) && all(lessThan(p.xy, shadow_tiles_header.max));
    if (near) visible *= moving_visibility(p, n, pixel_m);
  }
  return visible;
}

/// Returns the radiance towards the eye of light from direction l with the given illuminance on a facing
/// surface.
vec3 reflect_light(Reflectance r, vec3 n, vec3 v, vec3 l, vec3 illuminance) {
  float n_dot_l = dot(n, l);
  if (n_dot_l <= 0.0) return vec3(0.0);
  vec3 f = r.diffuse * inverse_pi;
  if (specular_on) {
    vec3 h = normalize(l + v);
    f += specular_brdf(r, n_dot_l, clamp(dot(n, h), 0.0, 1.0), clamp(dot(l, h), 0.0, 1.0));
  }
  return f * illuminance * n_dot_l;
}

/// Returns the share of the sky that the static world leaves free over a point (renderer/light/sky_view.h).
/// Over level ground it is the share as seen from a height above the floor. Over a wall it is twice as much,
/// since the wall itself hides the other half.
float sky_share(vec3 p_eye, vec3 n) {
  vec3 p = p_eye + camera.eye_high + n * lighting.sky_view_step;
  vec4 view = textureLod(sky_view, p.xy * lighting.sky_view_uv.xy + lighting.sky_view_uv.zw, 0.0);
  float height = max(p.z - lighting.sky_view_floor - view.x, 0.0);
  float low = mix(view.y, view.z, min(height * (1.0 / sky_view_middle), 1.0));
  float share = mix(low, view.w,
                    clamp((height - sky_view_middle) * (1.0 / (sky_view_top - sky_view_middle)), 0.0, 1.0));
  share = height >= sky_view_top ? mix(view.w, 1.0, min(height * (1.0 / sky_view_top) - 1.0, 1.0)) : share;
  return min(share * mix(2.0, 1.0, abs(n.z)), 1.0);
}

/// Holds the part of the sky that a point sees, and the light that the world throws back onto it.
struct OutdoorLight {
  float share;      // of the sky
  vec3 hidden;      // the constant that stands for the rest, without bounced_light
  Bounced bounced;  // with bounced_light
};

OutdoorLight outdoor_light(vec3 p_eye, vec3 n) {
  OutdoorLight light;
  light.share = ambient_occlusion_on ? sky_share(p_eye, n) : 1.0;
  light.hidden = ambient_occlusion_on ? (1.0 - light.share) * lighting.bounce : vec3(0.0);
  if (bounced_light_on) light.bounced = bounced_at(p_eye, n);
  return light;
}

/// Returns the radiance from a mirrored direction, blurred for a roughness: sky, and what hides it.
vec3 mirrored_light(OutdoorLight light, vec3 n, vec3 direction, float roughness, vec3 p_eye) {
  vec3 mirrored = sky_irradiance_over_pi(direction);
  vec3 hidden = bounced_light_on ? bounced_over_pi(light.bounced, direction) : light.hidden;
  bool sharp = roughness < environment_most_roughness;
  vec3 image = vec3(0.0);
  if (sharp) {
    float rough = smoothstep(environment_most_roughness - 0.1, environment_most_roughness, roughness);
    image = environment_radiance(direction, roughness);
    mirrored = mix(image, mirrored, rough);
  }
  mirrored = mirrored * light.share + hidden;
  bool clear = glass_on && roughness < surroundings_most_roughness + surroundings_fade;
  if (clear) {
    image = mirrored_surroundings(p_eye, n, direction, image);
    float rough = clamp((roughness - surroundings_most_roughness) / surroundings_fade, 0.0, 1.0);
    mirrored = mix(image, mirrored, rough);
  }
  return mirrored;
}

/// Returns the radiance towards the eye of the sky's light: the diffuse part, and a mirror image blurred by
/// the roughness. The part of the sky that the world hides is replaced by light that the world throws back:
/// that of one bounce, or else a constant.
vec3 reflect_sky(Reflectance r, vec3 n, vec3 v, float roughness, vec3 p_eye) {
  OutdoorLight light = outdoor_light(p_eye, n);
  vec3 hidden = bounced_light_on ? bounced_over_pi(light.bounced, n) : light.hidden;
  vec3 radiance = r.diffuse * (sky_irradiance_over_pi(n) * light.share + hidden);
  if (specular_on) radiance += r.albedo * mirrored_light(light, n, reflect(-v, n), roughness, p_eye);
  return radiance;
}
#endif
