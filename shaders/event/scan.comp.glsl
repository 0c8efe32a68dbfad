#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// One workgroup finds where in the interval's list the events of each run begin: row by row, behind those of
// the steps before. With adaptive steps it also decides when the next picture is taken.
#include "event/pixels.glsl"

layout(local_size_x = event_scan_size) in;
const uint block = 16u;  // lanes
shared uint sums[event_scan_size], blocks[event_scan_size / block];

/// Finds the time that the pictures so far allow until the next one, by ESIM's rule: the wanted change over
/// its rate.
void plan_next() {
  float measured = uintBitsToFloat(control.measured);
  float dt = float(this_step(control.last_ns, control.leaked_last).dt_ns), moved = measured,
        per_ns = measured;
  if (adaptive == adaptive_flow)
    moved *= dt;
  else
    per_ns /= dt;
  if (interval.index > 0u) {
    control.pictures += 1u;
    control.largest = max(control.largest, floatBitsToUint(moved));
    if (moved > model.wanted) control.coarse += 1u;
  }
  // The future rate of change is only a guess from the past rate: no step is more than twice as long as the
  // last.
  float longest = adaptive == adaptive_flow ? 1e30 : 2.0 * dt;
  if (interval.index > 0u || adaptive == adaptive_flow)
    control.allowed = floatBitsToUint(min(model.wanted / max(per_ns, 1e-30), longest));
  control.measured = 0u;
  control.from_ns = control.last_ns;
  control.leaked_from = control.leaked_last;
  control.last = interval.index;
  control.last_ns = interval.to_ns;
  control.leaked_last = interval.leaked_to;
  if (interval.index == 0u || interval.index == interval.grid) return;
  float spacing = float(interval.interval_ns) / float(interval.grid);
  float ahead = clamp(uintBitsToFloat(control.allowed) / spacing, 1.0, float(interval.grid));
  control.due[min(interval.index + uint(ahead), interval.grid)] = 1u;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint count = interval.index == 0u ? 0u : runs_per_row() * model.height;
  uint share = (count + event_scan_size - 1u) / event_scan_size;
  uint begin = min(lane * share, count), end = min(begin + share, count);
  uint sum = 0u;
  for (uint r = begin; r < end; ++r) sum += runs[r].count;
  sums[lane] = sum;
  barrier();
  if (lane < event_scan_size / block) {
    sum = 0u;
    for (uint i = 0u; i < block; ++i) sum += sums[lane * block + i];
    blocks[lane] = sum;
  }
  barrier();
  uint before = control.events, total = 0u;
  for (uint i = 0u; i < event_scan_size / block; ++i) {
    before += i < lane / block ? blocks[i] : 0u;
    total += blocks[i];
  }
  for (uint i = lane / block * block; i < lane; ++i) before += sums[i];
  for (uint r = begin; r < end; ++r) {
    runs[r].first = before;
    before += runs[r].count;
  }
  barrier();
  if (lane != 0u) return;
  control.events += total;
  if (adaptive != 0u) plan_next();
}
