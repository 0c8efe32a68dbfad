// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts linear light to eight bits by a tone curve and sRGB. C++ tests and shaders read the same pure
// functions.
#ifndef GREATX_SHADERS_SHARED_DEVELOP_H
#define GREATX_SHADERS_SHARED_DEVELOP_H
#include "glsl.h"

#ifdef __cplusplus
namespace greatx::shared {
using glm::floatBitsToUint;
using glm::max;
using glm::min;
using std::exp;
using std::sqrt;
}  // namespace greatx::shared
#endif

GREATX_SHARED_BEGIN

/// Applies the response of film to light: 1 - exp(-2.2 x) of the brightest channel, which lifts the mid-tones
/// and never quite reaches 1. The other channels keep their ratio to the brightest, and fade towards white as
/// it saturates (as in Khronos' PBR Neutral tone mapper, 2024), but keep three quarters of their saturation:
/// by night a signal is a thousand times as bright as white, and its colour can still be told. Input and
/// output are linear Rec. 709, from [0, inf) to [0, 1].
GREATX_FUNCTION vec3 tone_map(vec3 color) {
  const float response = 2.2f;
  const float desaturation = 0.15f, most_fade = 4.0f / 3.0f;
  float peak = max(max(color.x, max(color.y, color.z)), 1e-9f);
  float new_peak = 1.0f - exp(-response * peak);
  // This is color new_peak / peak, mixed with white of that peak by 1 - 1 / fade.
  float fade = min(desaturation * max(peak - new_peak, 0.0f) + 1.0f, most_fade);
  float both = new_peak / (peak * fade);
  return color * both + vec3(new_peak - peak * both);
}

/// Returns the byte of a linear value in [0, 1] by IEC 61966-2-1, rounded to nearest. The power 1/2.4 is a
/// polynomial in the fourth root, 0.009 bytes off at most. The last bits of the sum are the byte (fp32 has no
/// fractions from 2^23 on). Some CPU drivers would do a conversion to an integer lane by lane.
GREATX_FUNCTION uint srgb_byte(float c) {
  float q = sqrt(sqrt(c));
  float curve = (((0.08132991f * q - 0.33550147f) * q + 1.1226816f) * q + 0.19613586f) * q - 0.064611533f;
  float s = c <= 0.0031308f ? 12.92f * c : curve;
  return floatBitsToUint(s * 255.0f + 8388608.0f) & 255u;
}

GREATX_SHARED_END
#endif
