#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes a histogram of log2 of the luminance on a grid over the picture. It adds whole numbers, so their
// order does not matter.
#include "camera/stored_color.glsl"
#include "lib/linear.glsl"
#include "shared/film.h"

layout(local_size_x = meter_group_size) in;
layout(set = 0, binding = meter_color_binding, scalar) readonly buffer ColorBlock { uvec2 picture_color[]; };
layout(push_constant, scalar) uniform Constants { MeterConstants meter; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Bins { MeterBin v[]; };

void main() {
  uint i = linear_invocation;
  if (i >= meter.columns * meter.rows) return;
  uvec2 at = uvec2(i % meter.columns, i / meter.columns) * meter.step + meter.step / 2u;
  vec4 seen = unpack_color(picture_color[at.y * meter.width + at.x]);
  float luminance = dot(seen.rgb, vec3(0.2126, 0.7152, 0.0722));
  if (!(luminance > 0.0)) return;  // black has no logarithm
  float above = max(log2(luminance) - meter_least_ev, 0.0);
  // The last bits of a float give the whole number, as in srgb_byte().
  uint steps = floatBitsToUint(above * meter_steps_per_ev + 8388608.0) & 0xffffu;
  uint weight = floatBitsToUint(mix(1.0, meter_scene_weight, clamp(seen.a, 0.0, 1.0)) + 8388608.0) & 0xffu;
  uint bin = min(steps * uint(meter_bins_per_ev) / uint(meter_steps_per_ev), meter_bins - 1u);
  atomicAdd(Bins(meter.bins).v[bin].weight, weight);
  atomicAdd(Bins(meter.bins).v[bin].steps, weight * steps);
}
