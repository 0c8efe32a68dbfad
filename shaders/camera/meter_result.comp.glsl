#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the exposure that the meter's histogram asks for, in one group.
#include "shared/film.h"

layout(local_size_x = meter_bins) in;
layout(push_constant, scalar) uniform Constants { MeterConstants meter; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Bins { MeterBin v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Results { MeterResult v; };

shared MeterBin bins[meter_bins];

void main() {
  bins[gl_LocalInvocationID.x] = Bins(meter.bins).v[gl_LocalInvocationID.x];
  barrier();
  if (gl_LocalInvocationID.x != 0u) return;

  float total = 0.0;
  for (uint i = 0u; i < meter_bins; ++i) total += float(bins[i].weight);
  float from = meter_trimmed * total, to = total - from;
  // The part of each bin that lies between the two fractions counts.
  float before = 0.0, counted = 0.0, sum = 0.0;
  for (uint i = 0u; i < meter_bins; ++i) {
    float weight = float(bins[i].weight);
    float inside = min(before + weight, to) - max(before, from);
    before += weight;
    if (weight == 0.0 || inside <= 0.0) continue;
    counted += inside;
    sum += inside * (float(bins[i].steps) / weight);
  }
  // EV100 = log2(L 100 / 12.5) (ISO 2720); L_max = 1.2 2^EV100.
  float mean_ev = counted > 0.0 ? sum / (counted * meter_steps_per_ev) + meter_least_ev : -1e9;
  float luminance = exp2(clamp(mean_ev, -60.0, 60.0)) * meter.stored_luminance;
  float ev100 = mean_ev + log2(meter.stored_luminance * (100.0 / 12.5)) - meter.compensation_ev -
                meter_night_ev(luminance);
  ev100 = clamp(ev100, meter_least_ev100, meter_most_ev100);
  Results(meter.result).v = MeterResult(meter.stored_luminance / (1.2 * exp2(ev100)), ev100);
}
