#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the events that the step counted, each run's at its own place in the list.
#include "event/pixels.glsl"
#include "lib/linear.glsl"

layout(local_size_x = event_group_size) in;
/// An event is one number: ns after the interval's start, with the place above.
layout(buffer_reference, scalar, buffer_reference_align = 8) writeonly buffer EventList { uint64_t v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer InstanceList { uint v[]; };

void write(uint slot, int t_ns, uint place, bool on, uint instance) {
  EventList(interval.events).v[slot] = words_of(t_ns, int(place | uint(on)));
  if (instance_on) InstanceList(interval.instances).v[slot] = instance;
}

void main() {
  uint run = linear_invocation;
  if (run >= runs_per_row() * model.height) return;
  uint fired = runs[run].fired;
  if (fired == 0u) return;
  uint slot = runs[run].first, end = min(slot + runs[run].count, model.capacity);
  uint pixels;
  uvec2 start = run_start(run, pixels);
  uint first_pixel = start.y * model.width + start.x;
  Step step = this_step(control.from_ns, control.leaked_from);
  ivec2 nominal = ivec2(model.on, model.off);
  while (fired != 0u && slot < end) {
    uint i = uint(findLSB(fired)), pixel = first_pixel + i;
    fired &= fired - 1u;
    ivec2 before = pair(befores[pixel]);  // signal, crossings
    ivec2 c = thresholds_at(pixel, nominal);
    ivec2 after = pair(states[pixel]);
    int reference = after.x - before.y * (before.y > 0 ? c.x : c.y), to = after.y;
    if (leak_on) {
      int leak = leak_between(step.leaked_from, step.leaked_to, c.x);
      reference += leak;
      to += leak;
    }
    uint instance = 0u;
    if (instance_on) {
      uint triangle = uint(seen_by_pixel[pixel] >> 32);
      if (triangle != 0u) instance = objects[triangle - 1u].x;
    }
    uint place = start.y << 15 | (start.x + i) << 1;
    int awake = refractory_on ? awakes[pixel] : 0;
    EventWalk walk = walk_crossings(before.x, to, reference, before.y, c.x, c.y, step.dt_ns, awake);
    if (shot_on || refractory_on) {
      Shot shot = no_shot();
      if (shot_on) shot = begin_shot(pixel, luminances[pixel], step.dt_ns);
      int t;
      bool on;
      do {
        if (next_event(walk, shot, t, on)) {
          write(slot, step.from_ns + t, place, on, instance);
          ++slot;
        }
      } while (slot < end && events_left(walk, shot));
    } else {
      do {  // only crossings, and at least one
        int t = part_time(walk.part, walk.whole, walk.inverse, step.dt_ns);
        write(slot, step.from_ns + t, place, before.y > 0, instance);
        walk.part += uint(abs(walk.stride));
        walk.left -= 1;
        ++slot;
      } while (slot < end && walk.left > 0);
    }
  }
}
