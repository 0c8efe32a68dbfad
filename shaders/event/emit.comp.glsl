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
  uint slot = runs[run].first, end = slot + runs[run].count;
  uint pixels;
  uvec2 start = run_start(run, pixels);
  Step step = this_step(control.from);
  while (fired != 0u) {
    int i = findLSB(fired);
    fired &= fired - 1u;
    uvec2 at = start + uvec2(i, 0);
    uint pixel = at.y * model.width + at.x;
    ivec2 before = befores[pixel];  // signal, crossings
    ivec2 c = thresholds_at(pixel);
    ivec2 after = states[pixel];
    int reference = after.x - before.y * (before.y > 0 ? c.x : c.y), to = after.y;
    if (leak_on) {
      int leak = leak_between(step.leaked_from, step.leaked_to, c.x);
      reference += leak;
      to += leak;
    }
    int awake = refractory_on ? awakes[pixel] : 0;
    EventWalk walk = begin_walk(before.x, to, reference, c.x, c.y, step.dt_ns, awake);
    Shot shot = begin_shot(walk, pixel);
    uint instance = 0u;
    if (instance_on) {
      uint triangle = seen_by_pixel[pixel].y;
      if (triangle != 0u) instance = objects[triangle - 1u].x;
    }
    uint place = at.y << 15 | at.x << 1;
    int t;
    bool on;
    for (; slot < end && next_event(walk, shot, t, on); ++slot) {
      if (slot >= model.capacity) return;
      EventList(interval.events).v[slot] = uvec2(uint(step.from_ns + t), place | uint(on));
      if (instance_on) InstanceList(interval.instances).v[slot] = instance;
    }
  }
}
