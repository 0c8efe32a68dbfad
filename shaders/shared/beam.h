// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The light distribution of a vehicle's passing beam for right-hand traffic, as a smooth formula. It has the
// cut-off of UN Regulations 112 and 149: level to the left of its elbow, and rising by 15 degrees to the
// right. With a peak of 12000 cd it meets the main points of Regulation 112, class B
// (tests/renderer/beam_test.cpp).
#ifndef GREATX_SHADERS_SHARED_BEAM_H
#define GREATX_SHADERS_SHARED_BEAM_H
#include "glsl.h"

#ifdef __cplusplus
namespace greatx::shared {
using glm::exp2;
}  // namespace greatx::shared
#endif

GREATX_SHARED_BEGIN

/// Of the peak: the light above the cut-off.
const float beam_stray = 0.015f;
/// The slope of the cut-off to the right, tan 15 degrees.
const float beam_rise = 0.26794919f;
/// The cut-off begins and ends so far above it, as tangents: -0.25 and 0.1 degrees.
const float beam_edge_low = -0.00436f;
const float beam_edge_high = 0.00175f;
/// The most of the unscaled sum of the two lobes, below the cut-off.
const float beam_most = 1.25867f;

/// Returns the intensity over its peak at `right` and `up`: tangents of the angles from the elbow, seen from
/// the lamp. The peak lies 1.5 degrees right of the elbow and 0.6 degrees below it.
GREATX_FUNCTION float passing_beam(float right, float up) {
  float above = up - (right > 0.0f ? beam_rise * right : 0.0f);
  float t = (above - beam_edge_low) / (beam_edge_high - beam_edge_low);
  t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
  float below = 1.0f - t * t * (3.0f - 2.0f * t);
  // Lobes with standard deviations of 4 by 1.2 and 14 by 3.5 degrees.
  float x = (right - 0.0262f) * (1.0f / 0.0699f), y = (up + 0.0105f) * (1.0f / 0.02095f);
  float wide_x = right * (1.0f / 0.2493f), wide_y = (up + 0.0437f) * (1.0f / 0.0612f);
  float sum =
      exp2(-0.72134752f * (x * x + y * y)) + 0.3f * exp2(-0.72134752f * (wide_x * wide_x + wide_y * wide_y));
  return beam_stray + (1.0f - beam_stray) * below * sum / beam_most;
}

GREATX_SHARED_END
#endif
