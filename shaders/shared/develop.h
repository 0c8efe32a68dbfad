// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From linear light to eight bits: exposure, tone curve, sRGB. Pure functions, read by C++ tests and shaders alike.
#ifndef GREATX_SHADERS_SHARED_DEVELOP_H
#define GREATX_SHADERS_SHARED_DEVELOP_H
#include "glsl.h"

#ifdef __cplusplus
namespace greatx::shared {
using glm::clamp;
using glm::max;
using glm::min;
using glm::mix;
using std::exp;
using std::pow;
}  // namespace greatx::shared
#endif

GREATX_SHARED_BEGIN

/// The response of film to light: 1 - exp(-2.2 x) of the brightest channel, which lifts the middle and has no end; the
/// others keep their ratio to it, and fade towards white as it saturates (as in Khronos' PBR Neutral tone mapper, 2024).
/// Linear Rec. 709 in and out, [0, inf) to [0, 1).
GREATX_FUNCTION vec3 tone_map(vec3 color) {
  const float response = 2.2f;
  const float desaturation = 0.15f;
  float peak = max(max(color.x, max(color.y, color.z)), 1e-9f);
  float new_peak = 1.0f - exp(-response * peak);
  color = color * (new_peak / peak);
  float g = 1.0f - 1.0f / (desaturation * max(peak - new_peak, 0.0f) + 1.0f);
  return mix(color, vec3(new_peak), g);
}

/// IEC 61966-2-1, and rounding to nearest: a linear value to its byte.
GREATX_FUNCTION uint srgb_byte(float x) {
  float c = clamp(x, 0.0f, 1.0f);
  float s = c <= 0.0031308f ? 12.92f * c : 1.055f * pow(c, 1.0f / 2.4f) - 0.055f;
  return uint(s * 255.0f + 0.5f);
}

GREATX_SHARED_END
#endif
