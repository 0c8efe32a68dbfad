// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the camera's sensor and its meter. The developing passes and renderer/ share these definitions. The
// noise of a pixel is a pure function, which C++ tests and shaders read alike. docs/film.md has the models.
#ifndef GREATX_SHADERS_SHARED_FILM_H
#define GREATX_SHADERS_SHARED_FILM_H
#include "random.h"

#ifdef __cplusplus
namespace greatx::shared {
using glm::clamp;
using glm::floor;
using glm::max;
using glm::min;
using glm::mix;
using std::abs;
using std::exp;
using std::log;
using std::sqrt;
}  // namespace greatx::shared
#endif

GREATX_SHARED_BEGIN

// These bindings are in set 0 of the developing pass.
const uint develop_color_binding = 0u;  // storage: uvec4, two pixels' halves
const uint develop_seen_binding = 1u;   // storage: uvec4, two pixels' depths and triangles
// storage: two words of triangle + 1: instance + 1, class | (material + 1) << 16
const uint develop_triangle_ids_binding = 2u;
// This binding belongs to the metering passes.
const uint meter_color_binding = 0u;  // storage: uvec2, a pixel's halves

const uint develop_spec_rgb = 0u;
const uint develop_spec_hdr = 1u;
const uint develop_spec_depth = 2u;
const uint develop_spec_instance = 3u;
const uint develop_spec_semantic = 4u;
const uint develop_spec_material = 5u;
const uint develop_spec_metered = 6u;     // exposure by the meter
const uint develop_spec_flat_field = 7u;  // vignetting
const uint develop_spec_noise = 8u;
// Chromatic aberration: the principal point in pixels, and 1 over the magnification of red and blue (floats).
const uint develop_spec_chromatic = 9u;
const uint develop_spec_chromatic_x = 10u;
const uint develop_spec_chromatic_y = 11u;
const uint develop_spec_chromatic_red = 12u;
const uint develop_spec_chromatic_blue = 13u;
const uint develop_spec_count = 14u;

const uint develop_group_size = 64u;
/// The pixels that one invocation of the developing pass packs into whole 64-bit words.
const uint develop_pixels = 8u;

/// Holds the constants of light on a sensor.
struct SensorConstants {
  float full_well;   ///< electrons of light 1 (L_max)
  float read_noise;  ///< electrons, rms
  float levels;      ///< levels of the converter, less 1
  uint tick;
  uvec2 key;  ///< key made of (seed, sensor, sequence)
};

struct DevelopConstants {
  uint64_t rgb;  ///< addresses of the packed outputs, 0 where not wanted
  uint64_t hdr;
  uint64_t depth;
  uint64_t instance;
  uint64_t semantic;
  uint64_t material;
  uint64_t exposure;    ///< MeterResult, if metered
  uint64_t flat_field;  ///< float [height, width], padded to whole invocations
  uint width;
  uint height;
  float radiance_scale;  ///< stored value to cd/m^2
  uint pad0;
  SensorConstants sensor;
};

/// The bins of the meter's histogram, over log2 of the stored luminance from meter_least_ev on.
const uint meter_bins = 256u;
const float meter_bins_per_ev = 6.0f;
const float meter_least_ev = -25.0f;  // halves end at 2^-24
/// Within a bin, logarithms are summed in whole steps.
const float meter_steps_per_ev = 64.0f;
/// A pixel that shows the scene counts as much as this many pixels of sky.
const float meter_scene_weight = 8.0f;
/// The fraction of the pixels (by weight) that is left out at each end, dark and bright.
const float meter_trimmed = 0.05f;
/// The largest number of metered pixels. Every n-th column of every n-th row is metered.
const uint meter_most_samples = 32768u;
/// The meter finds an exposure between these EV100, as cameras do.
const float meter_least_ev100 = -4.0f;
const float meter_most_ev100 = 20.0f;
const uint meter_group_size = 64u;

/// Returns by how many stops a meter keeps a scene of this mean luminance, cd/m^2, below middle grey: night
/// shall look like night. The key value is 1.03 - 2 / (2 + log10(L + 1)) (G. Krawczyk, K. Myszkowski and
/// H.-P. Seidel, "Perceptual Effects in Real-time Tone Mapping", SCCG 2005, eq. 11); 0.18 and more is middle
/// grey.
GREATX_FUNCTION float meter_night_ev(float luminance) {
  float key = 1.03f - 2.0f / (2.0f + 0.43429448f * log(luminance + 1.0f));
  return min(1.44269504f * log(key * (1.0f / 0.18f)), 0.0f);
}

struct MeterBin {
  uint weight;
  uint steps;  ///< sum of weight times steps above meter_least_ev
};

struct MeterResult {
  float gain;  ///< stored value to light over L_max
  float ev100;
};

struct MeterConstants {
  uint64_t bins;    ///< MeterBin [meter_bins]
  uint64_t result;  ///< MeterResult
  uint columns;     ///< samples in a row
  uint rows;
  uint step;               ///< pixels from sample to sample
  float stored_luminance;  ///< cd/m^2 of a stored 1
  float compensation_ev;
  uint width;  ///< width of the picture
};

/// Below this mean number of electrons the shot noise is Poisson's law itself; above it, a corrected normal
/// law.
const float poisson_limit = 16.0f;

/// Returns the quantile of the standard normal law: M. Giles, "Approximating the erfinv Function", GPU
/// Computing Gems Jade Edition (2011), table 10.3 (single precision, 1e-6 relative where it matters here).
/// `u` is in (0, 1).
GREATX_FUNCTION float normal_quantile(float u) {
  float x = 2.0f * u - 1.0f;
  float w = -log(max((1.0f - x) * (1.0f + x), 1e-20f));
  float a = w - 2.5f;
  float p = 2.81022636e-08f;
  p = 3.43273939e-07f + p * a;
  p = -3.5233877e-06f + p * a;
  p = -4.39150654e-06f + p * a;
  p = 0.00021858087f + p * a;
  p = -0.00125372503f + p * a;
  p = -0.00417768164f + p * a;
  p = 0.246640727f + p * a;
  p = 1.50140941f + p * a;
  float b = sqrt(w) - 3.0f;
  float q = -0.000200214257f;
  q = 0.000100950558f + q * b;
  q = 0.00134934322f + q * b;
  q = -0.00367342844f + q * b;
  q = 0.00573950773f + q * b;
  q = -0.0076224613f + q * b;
  q = 0.00943887047f + q * b;
  q = 1.00167406f + q * b;
  q = 2.83297682f + q * b;
  return 1.41421356f * x * (w < 5.0f ? p : q);
}

/// Returns the electrons read for `mean` electrons of light, with shot noise and read noise. `u` is uniform
/// in [0, 1) with 24 bits.
///
/// For few electrons it inverts Poisson's law; the place of `u` within its step is again uniform and gives
/// the read noise. For many electrons it gives the sum of both noises by the first terms of Cornish and
/// Fisher's expansion (E. A. Cornish and R. A. Fisher, 1938), with the exact mean and variance and nearly the
/// skewness.
GREATX_FUNCTION float noisy_electrons(float mean, float read_noise, float u) {
  const float half_step = 0.5f / 16777216.0f;
  float centred = u + half_step;
  if (mean >= poisson_limit) {
    float variance = mean + read_noise * read_noise;
    float z = normal_quantile(centred);
    float skew = mean / (variance * sqrt(variance));
    float scale = sqrt(variance / (1.0f + skew * skew * (1.0f / 18.0f)));
    return mean + scale * (z + skew * (1.0f / 6.0f) * (z * z - 1.0f));
  }
  float count = 0.0f;
  float probability = exp(-mean), below = 0.0f;
  // 16 electrons become more than 64 once in 1e18 pixels.
  for (int i = 0; i < 64 && centred >= below + probability; ++i) {
    below += probability;
    count += 1.0f;
    probability *= mean / count;
  }
  if (read_noise == 0.0f) return count;
  float within = (centred - below) / max(probability, 1e-30f);
  return count + read_noise * normal_quantile(clamp(within, half_step, 1.0f - half_step));
}

/// Returns, for a channel and light over L_max, the converter's digital number over its highest one.
GREATX_FUNCTION float sensed(float light, SensorConstants sensor, uint bits) {
  float electrons = noisy_electrons(light * sensor.full_well, sensor.read_noise, unit_float(bits));
  float number = floor(electrons * (sensor.levels / sensor.full_well) + 0.5f);
  return clamp(number, 0.0f, sensor.levels) / sensor.levels;
}

/// Returns the digital numbers of a pixel's three channels; `pixel` is row * width + column.
GREATX_FUNCTION vec3 sensed_color(vec3 light, SensorConstants sensor, uint pixel) {
  uvec4 bits = random_bits(sensor.key.x, sensor.key.y, sensor.tick, pixel, 0u);
  return vec3(sensed(light.x, sensor, bits.x), sensed(light.y, sensor, bits.y),
              sensed(light.z, sensor, bits.z));
}

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::SensorConstants) == 24);
static_assert(sizeof(greatx::shared::DevelopConstants) == 104);
static_assert(sizeof(greatx::shared::MeterConstants) == 40);
#endif
#endif
