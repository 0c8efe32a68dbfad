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
#include "shared/brdf.h"

layout(set = 0, binding = lighting_binding, scalar) uniform LightingBlock { GpuLighting lighting; };
layout(set = 0, binding = shadow_tiles_binding, scalar) readonly buffer ShadowTilesBlock {
  ShadowTilesHeader shadow_tiles_header;
  GpuShadowTile shadow_tiles[];
};
layout(set = 0, binding = environment_binding) uniform sampler2D environment;
layout(set = 0, binding = static_shadow_binding) uniform sampler2DShadow static_shadow;
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
float shadow_filter(sampler2DShadow map, vec2 uv, float depth, float texel_uv, bool near) {
  float r = near ? 0.5 : 0.0;
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

/// Returns the share of the sun that passes the tile of one moving body.
float tile_visibility(uint i, vec3 p, vec3 n, float pixel_m) {
  float visible = 1.0;
  vec3 q = (p - shadow_tiles[i].center) / shadow_tiles[i].radius;
  bool inside = max(abs(q.x), abs(q.y)) < 1.0 && q.z < 1.0;
  if (inside) {
    GpuShadowTile tile = shadow_tiles[i];
    q = (shadow_point(p, n, tile.texel_m) - tile.center) / tile.radius;
    float depth = clamp(0.5 * q.z + 0.5, 0.0, 1.0);
    visible = shadow_filter(moving_shadow, tile.uv_center + q.xy * tile.uv_radius, depth,
                            1.0 / lighting.moving_map_size, pixel_m < shadow_near * tile.texel_m);
  }
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
  if (static_shadows_on) {
    vec3 q = shadow_point(p, n, lighting.static_texel_m);
    float depth = clamp(q.z * lighting.static_depth_scale + lighting.static_depth_offset, 0.0, 1.0);
    vec2 uv = q.xy * lighting.static_uv_scale + lighting.static_uv_offset;
    visible = shadow_filter(static_shadow, uv, depth, 1.0 / lighting.static_map_size,
                            pixel_m < shadow_near * lighting.static_texel_m);
  }
  if (moving_shadows_on) {
    // The common bounds of the tiles stand at fixed places, so one load serves all lanes.
    bool near =
        all(greaterThan(p.xy, shadow_tiles_header.min)) && all(lessThan(p.xy, shadow_tiles_header.max));
    if (near) {
      for (uint i = 0u; i < shadow_tiles_header.count; ++i) visible *= tile_visibility(i, p, n, pixel_m);
    }
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

/// Returns the radiance towards the eye of the sky's light: the diffuse part, and a mirror image blurred by
/// the roughness. The part of the sky that the world hides is replaced by light that the world throws back:
/// that of one bounce, or else a constant.
vec3 reflect_sky(Reflectance r, vec3 n, vec3 v, float roughness, vec3 p_eye) {
  float share = ambient_occlusion_on ? sky_share(p_eye, n) : 1.0;
  vec3 hidden = ambient_occlusion_on ? (1.0 - share) * lighting.bounce : vec3(0.0);
  Bounced bounced;
  if (bounced_light_on) {
    bounced = bounced_at(p_eye, n);
    hidden = bounced_over_pi(bounced, n);
  }
  vec3 radiance = r.diffuse * (sky_irradiance_over_pi(n) * share + hidden);
  if (specular_on) {
    vec3 direction = reflect(-v, n);
    vec3 mirrored = sky_irradiance_over_pi(direction);
    if (bounced_light_on) hidden = bounced_over_pi(bounced, direction);
    bool sharp = roughness < environment_most_roughness;
    vec3 image = vec3(0.0);
    if (sharp) {
      float rough = smoothstep(environment_most_roughness - 0.1, environment_most_roughness, roughness);
      image = environment_radiance(direction, roughness);
      mirrored = mix(image, mirrored, rough);
    }
    mirrored = mirrored * share + hidden;
    bool clear = glass_on && roughness < surroundings_most_roughness + surroundings_fade;
    if (clear) {
      image = mirrored_surroundings(p_eye, n, direction, image);
      float rough = clamp((roughness - surroundings_most_roughness) / surroundings_fade, 0.0, 1.0);
      mirrored = mix(image, mirrored, rough);
    }
    radiance += r.albedo * mirrored;
  }
  return radiance;
}
#endif
