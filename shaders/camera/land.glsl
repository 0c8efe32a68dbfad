// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the land beyond the scene as pixels see it that meet nothing (docs/light.md): a level plane with
// houses or with fields and woods, in clear air, and a profile of roofs or hills along the horizon. It is an
// optical background: no other pass knows of it.
#ifndef GREATX_CAMERA_LAND_GLSL
#define GREATX_CAMERA_LAND_GLSL
#include "camera/footprint.glsl"
#include "camera/haze.glsl"
#include "camera/light.glsl"
#include "shared/horizon.h"

layout(set = 0, binding = horizon_binding, scalar) uniform HorizonBlock { GpuHorizon horizon; };

const float hill_distance = 14000.0;
/// The share of windows that are lit by night. Windows take 31 % of a facade here, and some 20 % in the
/// generated city, where a third are lit: far facades are as bright as near ones in the mean.
const float lit_share = 0.2;

/// A ray over the land, by its level way s: height over the land = height + slope s.
struct LandRay {
  vec2 from, along;  // local x, y; unit
  float height, slope;
  float lengthen;  // way along the ray for a metre of level way
  float pixel;     // size of a pixel at a distance of 1
};

/// What a ray has gathered from front to back: radiance, and the share of the light that still comes from
/// behind.
struct Gathered {
  vec3 radiance;
  float rest;
};

uint hash_of(ivec2 cell, uint salt) {
  uint h = uint(cell.x) * 0x8da6b343u ^ uint(cell.y) * 0xd8163841u ^ (horizon.seed + salt) * 0xcb1ab31fu;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  return h ^ h >> 15;
}
/// Returns one of four fractions of a hash.
float fraction(uint hash, int place) { return float(hash >> uint(8 * place) & 255u) * (1.0 / 255.0); }

/// Returns the radiance of a long way through air along a level unit direction.
vec3 air_light(vec2 along) {
  float at = atan(along.y, along.x) * (float(air_azimuths) / 6.2831853) - 0.5, whole = floor(at);
  uint first = uint(int(whole) + int(air_azimuths)) % air_azimuths;
  return mix(horizon.air_light[first].rgb, horizon.air_light[(first + 1u) % air_azimuths].rgb, at - whole);
}

/// Returns the radiance at the eye of something in a distance, seen through clear air and through haze. The
/// light of the air is that of the sky over the horizon there.
vec3 through_air(vec3 radiance, vec3 air, vec3 direction, float way) {
  radiance = mix(air, radiance, exp(-horizon.air * way));
  if (haze_on) radiance = through_haze(radiance, direction, way);
  return radiance;
}

void put(inout Gathered all, vec3 radiance, float share) {
  all.radiance += all.rest * share * radiance;
  all.rest *= 1.0 - share;
}

/// Returns the level way at which the ray leaves the scene's bounds for good, 0 if it never enters them.
float way_out(LandRay ray) {
  vec2 inverse = 1.0 / mix(ray.along, vec2(1e-6), lessThan(abs(ray.along), vec2(1e-6)));
  vec2 a = (horizon.min - ray.from) * inverse, b = (horizon.max - ray.from) * inverse;
  vec2 near = min(a, b), far = max(a, b);
  float out_at = min(far.x, far.y);
  return out_at > max(max(near.x, near.y), 0.0) ? out_at : 0.0;
}

/// Returns the radiance of a wall in the open: half of the sky, what the ground throws back, the key light.
vec3 wall_radiance(vec3 albedo, vec2 normal) {
  float facing = max(dot(normal, lighting.sun_direction.xy), 0.0);
  return albedo * (0.5 * horizon.shaded + 0.08 * horizon.sunlit + 0.75 * facing * horizon.key +
                   0.1 * horizon.lamps);
}

/// Returns the radiance of a facade at a place along it and above the ground. Windows smaller than a pixel
/// fade to their mean.
vec3 facade_radiance(uint hash, vec2 place, vec2 normal, vec3 air, float pixel_m) {
  float tone = fraction(hash, 1), warm = fraction(hash, 2);
  vec3 albedo = mix(vec3(0.42, 0.41, 0.39), vec3(0.36, 0.22, 0.16), step(0.62, warm)) * (0.65 + 0.5 * tone);
  vec2 bay = place / vec2(3.4, 3.2), at = fract(bay);
  bool window = abs(at.x - 0.5) < 0.27 && abs(at.y - 0.52) < 0.29;
  vec3 wall = wall_radiance(albedo, normal);
  // Panes mirror the sky near the horizon, or are lit from behind.
  float lit = fraction(hash_of(ivec2(floor(bay)), hash), 0) < lit_share ? horizon.lit : 0.0;
  vec3 pane = 0.22 * air + wall_radiance(vec3(0.02), normal) + lit * vec3(1.25, 0.95, 0.6);
  const float share = 0.54 * 0.58;
  vec3 mean = mix(wall, 0.22 * air + lit_share * horizon.lit * vec3(1.25, 0.95, 0.6), share);
  return mix(window ? pane : wall, mean, clamp(pixel_m / 1.6 - 0.3, 0.0, 1.0));
}

/// Returns the radiance of level ground. Patterns smaller than a pixel fade to their mean.
vec3 ground_radiance(uint kind, vec2 p, float pixel_m) {
  if (kind == horizon_plain) return horizon.albedo * horizon.sunlit;
  if (kind == horizon_city) {
    vec2 lot = p / city_lot, inside = abs(fract(lot) - 0.5) * city_lot;
    ivec2 cell = ivec2(floor(lot));
    bool street = inside.x > 0.5 * city_lot - 5.0 && (cell.x & 1) == int(fract(lot.x) > 0.5) ||
                  inside.y > 0.5 * city_lot - 5.0 && (cell.y & 1) == int(fract(lot.y) > 0.5);
    bool park = fraction(hash_of(cell, 7u), 3) < 0.12;
    vec3 albedo = street ? vec3(0.09) : park ? vec3(0.06, 0.10, 0.035) : vec3(0.20, 0.19, 0.17);
    albedo = mix(albedo, vec3(0.14, 0.135, 0.12), clamp(pixel_m / 20.0 - 0.3, 0.0, 1.0));
    // Houses shade about half of the ground between them.
    return albedo * (mix(horizon.shaded, horizon.sunlit, 0.55) + horizon.lamps);
  }
  // Fields lie in strips of several squares.
  vec2 bent = p + 18.0 * sin(p.yx * 0.011);
  ivec2 field = ivec2(floor(bent / vec2(3.0 * country_lot, 2.0 * country_lot)));
  uint hash = hash_of(field, 3u);
  float crop = fraction(hash, 0), tone = 0.8 + 0.4 * fraction(hash, 1);
  vec3 albedo = crop < 0.45   ? vec3(0.065, 0.115, 0.035)
                : crop < 0.72 ? vec3(0.26, 0.20, 0.09)
                : crop < 0.86 ? vec3(0.13, 0.085, 0.055)
                              : vec3(0.10, 0.14, 0.05);
  albedo = mix(albedo * tone, vec3(0.13, 0.13, 0.055), clamp(pixel_m / 150.0 - 0.3, 0.0, 1.0));
  return albedo * horizon.sunlit;
}

/// Describes what stands on a square: a box within it, or nothing (height 0).
struct Block {
  vec2 low, high;
  float height;
  uint hash;
};

Block block_of(uint kind, ivec2 cell) {
  Block block;
  block.hash = hash_of(cell, 7u);
  float lot = kind == horizon_city ? city_lot : country_lot;
  block.low = vec2(cell) * lot;
  block.high = block.low + lot;
  bool free = all(lessThan(block.low, horizon.max + 6.0)) && all(greaterThan(block.high, horizon.min - 6.0));
  if (kind == horizon_city) {
    // A block is two squares wide and has streets around it; its houses keep a yard between them.
    float size = fraction(block.hash, 0);
    block.low += vec2((cell.x & 1) == 0 ? 9.0 : 1.5, (cell.y & 1) == 0 ? 9.0 : 1.5);
    block.high -= vec2((cell.x & 1) == 0 ? 1.5 : 9.0, (cell.y & 1) == 0 ? 1.5 : 9.0);
    block.height = fraction(block.hash, 3) < 0.12 ? 0.0 : 9.6 + 3.2 * floor(size * 6.5);
  } else {
    // Woods fill squares, in groups; single clumps of trees stand between them.
    bool wood = fraction(hash_of(cell >> 2, 5u), 0) < 0.22 && fraction(block.hash, 1) < 0.75;
    bool clump = fraction(block.hash, 2) < 0.2;
    vec2 middle = block.low + lot * (0.25 + 0.5 * vec2(fraction(block.hash, 0), fraction(block.hash, 3)));
    if (!wood) {
      block.low = middle - 6.0;
      block.high = middle + 6.0;
    }
    block.height = wood || clump ? country_top * (0.55 + 0.4 * fraction(block.hash, 0)) : 0.0;
  }
  block.height = free ? 0.0 : block.height;
  return block;
}

/// Adds what the ray meets of a block.
void meet(inout Gathered all, uint kind, LandRay ray, vec2 inverse, Block block, float begin, vec3 air,
          vec3 direction) {
  vec2 a = (block.low - ray.from) * inverse, b = (block.high - ray.from) * inverse;
  vec2 near = min(a, b), far = max(a, b);
  float enter = max(max(near.x, near.y), begin), leave = min(far.x, far.y);
  if (enter >= leave) return;
  float pixel_m = ray.pixel * enter * ray.lengthen;
  float at = ray.height + ray.slope * enter;
  vec2 p = ray.from + ray.along * enter;
  bool across_x = near.x > near.y;
  vec2 normal = across_x ? vec2(-sign(ray.along.x), 0.0) : vec2(0.0, -sign(ray.along.y));
  float top = block.height;
  // The outline of trees is ragged, and falls to the sides of a wood.
  if (kind == horizon_country) {
    vec2 middle = 0.5 * (block.low + block.high) - ray.from;
    float aside = abs(middle.x * ray.along.y - middle.y * ray.along.x) / (0.5 * (block.high.x - block.low.x));
    float round = block.high.x - block.low.x < country_lot ? 1.0 : 0.35;
    uint tree = hash_of(ivec2(floor(p * 0.3)), 9u);
    top *= 1.0 - 0.3 * fraction(tree, 0) * clamp(1.5 - pixel_m * 0.3, 0.0, 1.0);
    aside = min(aside * aside, 1.0);
    top *= 1.0 - round * aside * aside;
  }
  float share = clamp((top - at) / max(pixel_m, 1e-3) + 0.5, 0.0, 1.0);
  if (share > 0.0) {
    vec3 wall;
    if (kind == horizon_city) {
      wall = facade_radiance(block.hash, vec2(across_x ? p.y : p.x, at), normal, air, pixel_m);
    } else {
      float leaves = 0.7 + 0.6 * fraction(hash_of(ivec2(floor(vec2(dot(p, vec2(0.7)), at) * 0.6)), 4u), 0);
      wall = wall_radiance(vec3(0.045, 0.075, 0.025) * leaves, normal);
    }
    put(all, through_air(wall, air, direction, enter * ray.lengthen), share);
  }
  float roof_at = ray.slope < 0.0 ? (top - ray.height) / ray.slope : leave;
  if (roof_at < leave && share < 1.0) {
    float tone = 0.6 + 0.7 * fraction(block.hash, 2);
    vec3 roof = kind == horizon_country             ? vec3(0.05, 0.085, 0.028)
                : fraction(block.hash, 1) > 0.7 ? vec3(0.30, 0.13, 0.08)
                                                : vec3(0.24, 0.235, 0.225);
    vec3 light = kind == horizon_country ? mix(horizon.shaded, horizon.sunlit, 0.7) : horizon.sunlit;
    put(all, through_air(roof * tone * light, air, direction, max(roof_at, enter) * ray.lengthen), 1.0);
  }
}

/// Adds the profile of the horizon: hills, and before them roofs or woods, by the azimuth alone.
/// `ground` is the level way to the plane.
void add_profile(inout Gathered all, uint kind, LandRay ray, float ground, vec3 air, vec3 direction) {
  if (ray.slope > 0.05 || ground < land_reach) return;
  float azimuth = atan(ray.along.y, ray.along.x), seed = float(horizon.seed & 255u);
  float width = kind == horizon_city ? 0.012 : 0.02;
  uint hash = hash_of(ivec2(int(floor(azimuth / width)), 77), 1u);
  float rise = kind == horizon_city ? 9.0 + 26.0 * fraction(hash, 0) * fraction(hash, 1)
                                    : 8.0 + 7.0 * sin(azimuth * 37.0 + seed) * sin(azimuth * 11.0);
  float near = clamp(((rise - ray.height) / land_reach - ray.slope) / ray.pixel + 0.5, 0.0, 1.0);
  vec3 tone = kind == horizon_city ? vec3(0.2, 0.19, 0.18) * (0.6 + 0.8 * fraction(hash, 2))
                                   : vec3(0.04, 0.06, 0.025);
  vec3 light = 0.7 * horizon.shaded + 0.2 * horizon.sunlit + 0.3 * horizon.lamps;
  if (kind != horizon_plain) put(all, through_air(tone * light, air, direction, land_reach), near);
  float hill = 110.0 + 70.0 * sin(azimuth * 3.0 + seed) + 40.0 * sin(azimuth * 7.3 + 1.7 * seed) +
               14.0 * sin(azimuth * 23.0 + 0.3 * seed) + 5.0 * sin(azimuth * 61.0);
  float far = clamp(((hill - ray.height) / hill_distance - ray.slope) / ray.pixel + 0.5, 0.0, 1.0);
  if (ground > hill_distance)
    put(all, through_air(vec3(0.05, 0.065, 0.04) * horizon.sunlit, air, direction, hill_distance), far);
}

/// Returns the radiance of the land along a unit direction (rgb), and the share of the pixel that shows the
/// sky behind it (a).
vec4 land_radiance(uint kind, vec3 direction) {
  float level = length(direction.xy);
  LandRay ray;
  ray.lengthen = 1.0 / max(level, 1e-4);
  ray.from = camera.eye_high.xy;
  ray.along = level > 1e-4 ? direction.xy * ray.lengthen : vec2(1.0, 0.0);
  ray.height = camera.eye_high.z - horizon.floor;
  ray.slope = direction.z * ray.lengthen;
  ray.pixel = length(footprint_x());
  Gathered all = Gathered(vec3(0.0), 1.0);
  float top = kind == horizon_city ? city_top : kind == horizon_country ? country_top : 0.0;
  float begin = way_out(ray);
  bool above = ray.slope >= 0.0 && ray.height + ray.slope * begin > top && ray.slope > 0.05;
  if (above) return vec4(0.0, 0.0, 0.0, 1.0);
  vec3 air = air_light(ray.along);
  float ground = ray.slope < 0.0 ? max(ray.height / -ray.slope, begin) : 1e9;
  if (kind != horizon_plain) {
    // Nothing stands above the top: a ray from high up begins where it comes below it.
    float first = ray.height > top && ray.slope < 0.0 ? max(begin, (top - ray.height) / ray.slope) : begin;
    float last = min(ray.slope < 0.0 ? ground : ray.slope > 0.0 ? (top - ray.height) / ray.slope : land_reach,
                     land_reach);
    float lot = kind == horizon_city ? city_lot : country_lot;
    vec2 steady = mix(ray.along, vec2(1e-5), lessThan(abs(ray.along), vec2(1e-5)));
    vec2 inverse = 1.0 / steady;
    ivec2 cell = ivec2(floor((ray.from + ray.along * (first + 1e-3)) / lot));
    ivec2 step_to = ivec2(steady.x > 0.0 ? 1 : -1, steady.y > 0.0 ? 1 : -1);
    for (uint i = 0u; i < land_steps; ++i) {
      vec2 ahead = ((vec2(cell) + vec2(greaterThan(step_to, ivec2(0)))) * lot - ray.from) * inverse;
      float leave = min(ahead.x, ahead.y);
      Block block = block_of(kind, cell);
      if (block.height > 0.0) meet(all, kind, ray, inverse, block, first, air, direction);
      if (leave > last || all.rest < 0.01) break;
      if (ahead.x < ahead.y)
        cell.x += step_to.x;
      else
        cell.y += step_to.y;
    }
  }
  if (all.rest > 0.01) {
    add_profile(all, kind, ray, ground, air, direction);
    if (ray.slope < 0.0) {
      float way = ground * ray.lengthen;
      // A pixel covers more of the ground along the ray than across it; the mean of both counts.
      float pixel_m = ray.pixel * way * inversesqrt(max(-direction.z, 1e-4));
      vec3 seen = ground_radiance(kind, ray.from + ray.along * ground, pixel_m);
      put(all, through_air(seen, air, direction, way), clamp(-ray.slope / ray.pixel + 0.5, 0.0, 1.0));
    }
  }
  return vec4(all.radiance, all.rest);
}
#endif
