#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds what level films of water mirror. A mirrored ray is followed through the picture: where it passes
// behind what a pixel sees, it meets that. What the picture does not show stays the sky that shading
// mirrored.
#include "camera/picture.glsl"
#include "camera/mirror_weight.glsl"
#include "camera/pixel_ray.glsl"
#include "shared/weather.h"

layout(local_size_x = shade_group_width, local_size_y = shade_group_height) in;
layout(set = 0, binding = mirror_seen_binding, scalar) readonly buffer SeenBlock { uvec2 picture_seen[]; };
layout(set = 0, binding = mirror_from_binding, scalar) readonly buffer FromBlock { uvec2 from_color[]; };
layout(set = 0, binding = mirror_images_binding, scalar) writeonly buffer ImagesBlock { uvec2 images[]; };
layout(set = 0, binding = mirror_words_binding, scalar) readonly buffer MirrorBlock { uvec3 mirrors[]; };

const int steps = 26;
const float growth = 1.33;
const int refinements = 4;
/// Rays of a rough mirror. Each leaves a facet of its own.
const int rough_rays = 4;

float depth_at(vec2 pixel) { return uintBitsToFloat(picture_seen[picture_element(ivec2(pixel))].x); }
vec3 color_at(vec2 pixel) { return unpack_color(from_color[picture_element(ivec2(pixel))]).rgb; }

/// Returns how surely a place lies in the picture: 0 outside, 1 within, with a rim between.
float within(vec2 pixel, vec2 size) {
  vec2 rim = min(pixel, size - pixel) / (0.04 * size);
  return clamp(min(rim.x, rim.y), 0.0, 1.0);
}

/// Returns the light along a ray from p, and in `a` how far it is known.
vec4 traced(vec3 p, vec3 direction) {
  vec2 size = vec2(picture_size());
  vec3 from = vec3(dot(camera.clip_x, p), dot(camera.clip_y, p), dot(camera.forward, p));
  vec3 along =
      vec3(dot(camera.clip_x, direction), dot(camera.clip_y, direction), dot(camera.forward, direction));
  float t = 0.1 + 0.01 * from.z, before = 0.0;
  for (int i = 0; i < steps; ++i) {
    vec3 h = from + along * t;
    if (h.z < camera.near_m) break;
    vec2 pixel = (h.xy / h.z * 0.5 + 0.5) * size;
    if (any(lessThan(pixel, vec2(0.0))) || any(greaterThanEqual(pixel, size))) break;
    float behind = h.z - depth_at(pixel);
    float thickness = 1.2 * abs(along.z) * (t - before) + 0.3;
    // The mirror itself is no obstacle, nor is what lies in its plane.
    bool stands = pixel_ray(floor(pixel) + 0.5).z * depth_at(pixel) > p.z + 0.03;
    if (behind > 0.0 && behind < thickness && stands) {
      float low = before, high = t;
      for (int k = 0; k < refinements; ++k) {
        float middle = 0.5 * (low + high);
        vec3 m = from + along * middle;
        vec2 there = clamp((m.xy / m.z * 0.5 + 0.5) * size, vec2(0.0), size - 1.0);
        float depth = depth_at(there);
        bool hidden = m.z > depth && pixel_ray(floor(there) + 0.5).z * depth > p.z + 0.03;
        low = hidden ? low : middle;
        high = hidden ? middle : high;
      }
      h = from + along * high;
      pixel = clamp((h.xy / h.z * 0.5 + 0.5) * size, vec2(0.0), size - 1.0);
      return vec4(color_at(pixel), within(pixel, size));
    }
    before = t;
    t *= growth;
  }
  // The ray met nothing: it sees the sky, if the picture shows the sky there.
  if (along.z <= 0.0) return vec4(0.0);
  vec2 pixel = (along.xy / along.z * 0.5 + 0.5) * size;
  float known = within(pixel, size);
  if (known <= 0.0 || !isinf(depth_at(pixel))) return vec4(0.0);
  return vec4(color_at(pixel), known);
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (outside_picture(at)) return;
  uint element = picture_element(at);
  uvec3 words = mirrors[element];
  vec2 weight_and_roughness = unpackHalf2x16(words.x);
  if (weight_and_roughness.x <= 0.0) return;
  vec3 shows = vec3(unpackHalf2x16(words.y), unpackHalf2x16(words.z).x);
  float roughness = weight_and_roughness.y, alpha = roughness * roughness;
  vec3 ray = pixel_ray(vec2(at) + 0.5);
  vec3 p = ray * uintBitsToFloat(picture_seen[element].x), v = normalize(ray);
  int rays = roughness < smooth_mirror ? 1 : rough_rays;
  vec3 sum = vec3(0.0);
  float total = 0.0;
  // Nine pixels side by side have different numbers, and mirror_add.comp takes their mean.
  vec2 place = vec2(at);
  float turn = fract(52.9829189 * fract(dot(place, vec2(0.06711056, 0.00583715))));
  float shift = fract(0.618034 * float(at.x % 3 + 3 * (at.y % 3)));
  for (int i = 0; i < rays; ++i) {
    // Facets are spread by the distribution of GGX; its longest tail is left out.
    float u = rays == 1 ? 0.0 : (float(i) + shift) / float(rays) * 0.9;
    float angle = 6.2831853 * (turn + 0.618034 * float(i)), slope = alpha * sqrt(u / (1.0 - u));
    vec3 facet = normalize(vec3(slope * cos(angle), slope * sin(angle), 1.0));
    float facing = -dot(v, facet);
    vec3 direction = reflect(v, facet);
    if (facing <= 0.0 || direction.z <= 0.0) continue;
    vec4 found = traced(p, direction);
    vec3 image = mix(shows, found.rgb, found.a);
    float share = rays > 1 ? facing * image_weight(image) : facing;
    sum += share * image;
    total += share;
  }
  images[element] = pack_color(vec4(total > 0.0 ? sum / total : shows, 0.0));
}
