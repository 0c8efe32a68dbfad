#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// One workgroup numbers the events of an interval between two pictures by the order of their pixels, if they
// do not all have room. Otherwise their order in the list does not matter.
#include "event/pixels.glsl"

layout(local_size_x = event_scan_size) in;
layout(set = 0, binding = event_counts_binding, scalar) buffer CountsBlock { uint counts[]; };
shared uint sums[event_scan_size];

void main() {
  uint lane = gl_LocalInvocationIndex;
  if (control.events > model.capacity) {
    uint count = model.width * model.height, share = (count + event_scan_size - 1u) / event_scan_size;
    uint begin = min(lane * share, count), end = min(begin + share, count), sum = 0u;
    for (uint i = begin; i < end; ++i) sum += counts[i];
    sums[lane] = sum;
    barrier();
    uint before = control.ranked;
    for (uint i = 0u; i < lane; ++i) before += sums[i];
    for (uint i = begin; i < end; ++i) {
      uint own = counts[i];
      counts[i] = before;
      before += own;
    }
  }
  barrier();
  if (lane == 0u) control.ranked = control.events;
}
