// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines water and snow on surfaces, falling drops, and light of lamps in fog. Shaders and renderer/ share
// the definitions. C++ tests and shaders read the same pure functions. docs/light.md has the models.
#ifndef GREATX_SHADERS_SHARED_WEATHER_H
#define GREATX_SHADERS_SHARED_WEATHER_H
#include "glsl.h"

#ifdef __cplusplus
#include <bit>

namespace greatx::shared {
inline uint lattice_bits(float x) { return std::bit_cast<uint>(x); }
using glm::clamp;
using glm::dot;
using glm::floor;
using glm::max;
using glm::min;
using glm::mix;
using glm::smoothstep;
using std::abs;
using std::atan;
using std::cos;
using std::exp;
using std::sin;
using std::sqrt;
}  // namespace greatx::shared
#else
uint lattice_bits(float x) { return floatBitsToUint(x); }
#endif

GREATX_SHARED_BEGIN

/// Holds the weather that shading reads, set at construction.
struct GpuWeather {
  float wetness;        ///< of surfaces under the sky: 0 dry, 1 soaked
  float puddle_level;   ///< level ground lies under water where ground_noise() exceeds this
  float snow_level;     ///< snow lies where ground_noise() of level ground exceeds this
  float ripple;         ///< roughness of puddles that drops stir
  vec2 cover_uv_scale;  ///< place in the map of what lies open: uv = xy scale + offset
  vec2 cover_uv_offset;
  float cover_depth_scale;  ///< depth = z scale + offset
  float cover_depth_offset;
  float drop_extinction;  ///< 1/m: the part of the haze that is drawn as single streaks
  float drop_reach;       ///< m: up to this distance
  float lamp_texel_uv;    ///< a texel of the lamps' tiles
  float lamp_half_uv;     ///< half of a tile's edge, less a texel
  float cover_texel_m;    ///< width of a texel of the map of what lies open
  float pad0;
};

/// The refractive index of water at 589 nm, and its reflectance at normal incidence.
const float water_index = 1.33f;
const float water_f0 = 0.0200597f;
/// The part of diffuse light within water that its surface sends back: 1 - (1 - R) / n^2 with the mean
/// reflectance R = 0.066 of the surface for diffuse light from outside (J. Lekner and M. Dorf, "Why some
/// things are darker when wet", Applied Optics 27 (1988), pp. 1278-1280, after A. Angstrom, 1925).
const float water_traps = 0.47199f;

/// Returns the albedo below a film of water of a rough surface that has the albedo `dry`: light that it
/// scatters up is partly sent down again. The loss at the film's outer side is that of its specular lobe.
GREATX_FUNCTION vec3 wet_albedo(vec3 dry) {
  return dry * (1.0f - water_traps) / (vec3(1.0f) - water_traps * dry);
}

/// Returns how much water a surface of this roughness soaks up, from 0 to 1 (S. Lagarde, "Water drop 3b -
/// Physically based wet surfaces", 2013).
GREATX_FUNCTION float porosity(float roughness) { return clamp((roughness - 0.5f) * 2.5f, 0.0f, 1.0f); }

/// The roughness of a film of water on rough ground, and of still water in a puddle.
const float film_roughness = 0.24f;
const float puddle_roughness = 0.04f;

/// Returns a fixed number in [0, 1) for a corner of the lattice.
GREATX_FUNCTION float lattice_number(float x, float y) {
  uint h = lattice_bits(x + 12582912.0f) * 0x9e3779b1u ^ lattice_bits(y + 12582912.0f) * 0x85ebca77u;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  h = h ^ h >> 15;
  return float(h >> 8) * (1.0f / 16777216.0f);
}

/// Returns smooth noise in [0, 1] on a lattice of width 1.
GREATX_FUNCTION float smooth_noise(vec2 p) {
  vec2 cell = floor(p), f = p - cell;
  f = f * f * (vec2(3.0f) - 2.0f * f);
  float low = mix(lattice_number(cell.x, cell.y), lattice_number(cell.x + 1.0f, cell.y), f.x);
  float high = mix(lattice_number(cell.x, cell.y + 1.0f), lattice_number(cell.x + 1.0f, cell.y + 1.0f), f.x);
  return mix(low, high, f.y);
}

/// Returns noise in [0, 1] of a place on the ground, m, with features from 3 m down to half a metre.
GREATX_FUNCTION float ground_noise(vec2 p) {
  return 0.6f * smooth_noise(p * 0.31f) + 0.28f * smooth_noise(p * 0.87f + vec2(17.3f, 5.1f)) +
         0.12f * smooth_noise(p * 2.3f + vec2(3.7f, 41.9f));
}
/// Water rises over this range of the noise from the rim of a puddle to its full depth.
const float puddle_rim = 0.03f;

// --- falling drops

/// J. S. Marshall and W. Mc K. Palmer, "The Distribution of Raindrops with Size", J. Meteor. 5 (1948), pp.
/// 165-166: N(D) = 8000 exp(-4.1 R^-0.21 D) drops per m^3 and mm of diameter.
const float marshall_palmer_n0 = 8000.0f;
/// Returns the terminal velocity of a drop, m/s, of a diameter in mm: D. Atlas, R. C. Srivastava and R. S.
/// Sekhon, Rev. Geophys. 11 (1973), pp. 1-35, fitted to R. Gunn and G. D. Kinzer (1949), 0.6 to 5.8 mm.
GREATX_FUNCTION float terminal_velocity(float diameter_mm) {
  return max(9.65f - 10.3f * exp(-0.6f * diameter_mm), 0.0f);
}
/// Drops thinner than this are left to the haze; larger ones break up.
const float least_drop_mm = 1.0f;
const float most_drop_mm = 6.0f;
/// The radiance of a drop over the mean radiance around it (K. Garg and S. K. Nayar, "Vision and Rain", Int.
/// J. Computer Vision 75 (2007), pp. 3-27, section 3.2: a drop refracts light from 165 degrees).
const float drop_brightness = 0.94f;
/// Optical depth is added up in whole numbers of this, so that the order does not matter.
const float streak_unit = 1.0f / 16777216.0f;

// Bindings of set 0 of the passes that draw streaks and add them.
const uint streaks_seen_binding = 0u;   // storage: uvec2 [pixels]
const uint streaks_depth_binding = 1u;  // storage: uint [pixels], optical depth
const uint streaks_color_binding = 2u;  // storage: uvec2 [pixels], halves
const uint streak_group_size = 64u;

struct StreakConstants {
  uvec2 key;  ///< made of (seed, sensor, sequence)
  uint tick;
  uint count;   ///< drops
  vec2 focal;   ///< pixels
  vec2 center;  ///< pixels
  uint width;
  uint height;
  float nearest;  ///< m, planar depth of the drops
  float reach;
  float slope;    ///< 1/mm, of the logarithm of the number of drops over their diameter
  float shutter;  ///< s
  float pad0;
  float pad1;
  vec3 fall;   ///< unit, downwards, optical axes (x right, y down, z forward)
  vec3 drift;  ///< m/s, of the air past the camera
  vec3 glow;   ///< stored radiance of a drop
};
/// Drops are drawn over this many times the picture's width and height, so that streaks enter from outside.
const float streak_margin = 1.2f;

// --- mirror images in water

const uint mirror_seen_binding = 0u;  // storage: uvec2 [pixels]
const uint mirror_from_binding = 1u;  // storage: uvec2 [pixels], halves
const uint mirror_to_binding = 2u;
const uint mirror_words_binding = 3u;   // storage: as shade_mirror_binding
const uint mirror_images_binding = 4u;  // storage: uvec2 [pixels], halves
/// A smoother mirror follows one ray.
const float smooth_mirror = 0.1f;

// --- glare

const uint glare_from_binding = 0u;  // storage: uvec2, halves
const uint glare_to_binding = 1u;
const uint glare_most_levels = 8u;
struct GlareConstants {
  uint width;  ///< of `from`
  uint height;
  uint to_width;
  uint to_height;
  float keep;  ///< share of `to` that stays when the coarser level is added
  uint step;   ///< 0: shrinks `from` to `to`; 1: adds the coarser `from` to `to`
};

// --- light of lamps in fog

/// Returns the fraction of scattered light, 1/sr, that leaves at an angle of this cosine (L. G. Henyey and J.
/// L. Greenstein, 1941).
GREATX_FUNCTION float henyey_greenstein(float cosine, float g) {
  float base = 1.0f + g * g - 2.0f * g * cosine;
  return 0.0795774715f * (1.0f - g * g) / (base * sqrt(base));
}

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::GpuWeather) == 64);
static_assert(sizeof(greatx::shared::StreakConstants) == 100);
#endif
#endif
