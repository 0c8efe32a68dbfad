#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes down the events that the step counted, each run's at its own place in the list.
#include "event/pixels.glsl"

layout(local_size_x = event_group_size) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer EventList { uvec2 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer InstanceList { uint v[]; };

void main() {
  uint run = gl_GlobalInvocationID.x;
  if (run >= runs_per_row() * model.height) return;
  uint fired = runs[run].fired;
  if (fired == 0u) return;
  uint slot = runs[run].first;
  uint pixels;
  ivec2 start = run_start(run, pixels);
  Step step = this_step(control.from);
  while (fired != 0u) {
    int i = findLSB(fired);
    fired &= fired - 1u;
    ivec2 at = start + ivec2(i, 0);
    ivec4 before = imageLoad(before_image, at);
    ivec3 c = thresholds_at(at);
    int to = imageLoad(pixel_image, at).g;
    if (leak_on) to += leak_between(step.leaked_from, step.leaked_to, c.x);
    EventWalk walk = begin_walk(before.y, to, before.x, c.x, c.y, step.dt_ns, before.z);
    Shot shot = begin_shot(walk, at);
    uint instance = 0u;
    if (instance_on) {
      uint triangle = imageLoad(seen_image, at).g;
      if (triangle != 0u) instance = objects[triangle - 1u].x;
    }
    uint place = uint(at.y) << 15 | uint(at.x) << 1;
    for (uint end = slot + uint(before.w); slot < end; ++slot) {
      int t = step.dt_ns;
      bool on = true;
      next_event(walk, shot, t, on);
      if (slot >= model.capacity) continue;
      EventList(interval.events).v[slot] = uvec2(uint(step.from_ns + t), place | uint(on));
      if (instance_on) InstanceList(interval.instances).v[slot] = instance;
    }
  }
}
