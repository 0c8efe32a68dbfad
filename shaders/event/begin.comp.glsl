#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Begins an interval: nothing is counted yet. With adaptive steps it also decides when the first picture is
// taken.
#include "event/pixels.glsl"

layout(local_size_x = 1) in;

void main() {
  control.events = 0u;
  control.ranked = 0u;
  control.last = 0u;
  control.last_ns = interval.from_ns;
  control.leaked_last = interval.leaked_from;
  control.pictures = 0u;
  control.coarse = 0u;
  control.largest = 0u;
  if (interval.index == 0u) {  // the very first picture: nothing is known yet
    control.measured = 0u;
    control.allowed = 0u;
  }
  for (uint i = 0u; i <= most_substeps; ++i) control.due[i] = 0u;
  control.due[interval.grid] = 1u;
  if (interval.index == 0u) return;
  float spacing = float(interval.interval_ns) / float(interval.grid);
  float ahead = clamp(uintBitsToFloat(control.allowed) / spacing, 1.0, float(interval.grid));
  control.due[uint(ahead)] = 1u;
}
