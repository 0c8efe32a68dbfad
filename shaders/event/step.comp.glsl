#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Takes every pixel from the picture before to this one. It writes the new state, the old state of each pixel
// that fires, and the number of events of each run of pixels.
#include "event/pixels.glsl"
#include "lib/linear.glsl"

layout(local_size_x = event_group_size) in;

/// Returns how fast the point that the pixel sees moves over the picture, in pixels per nanosecond, without
/// the distortion of the lens.
float flow_at(uvec2 at, uint pixel) {
  uvec2 seen = unpack32(seen_by_pixel[pixel]);
  bool sky = seen.y == 0u;
  float depth = sky ? 1.0 : uintBitsToFloat(seen.x);
  uint body = 0u;
  if (!sky) body = objects[seen.y - 1u].y;
  EventMotion motion = motions[0];
  if (body != 0u) motion = motions[body];
  vec3 ray = vec3((vec2(at) + 0.5 - vec2(model.cx, model.cy)) / vec2(model.fx, model.fy), 1.0);
  vec3 velocity = (sky ? vec3(0.0) : motion.a) + cross(motion.w, ray * depth);  // the sky only turns
  vec2 flow = vec2(model.fx, model.fy) * (velocity.xy - ray.xy * velocity.z) / depth;
  return length(flow) * 1e-9;
}

/// Handles the first picture: nothing happens, and the pixel takes its signal.
void look(uint pixel, int signal, ivec2 nominal) {
  int reference = signal;
  if (leak_on) {
    // The reference begins at a random distance below the signal. Otherwise all pixels would leak at the same
    // time.
    uint phase = random_bits(model.pattern_seed, model.pattern_stream, 0u, pixel, 0u).z;
    reference -= int(uint64_t(thresholds_at(pixel, nominal).x) * uint64_t(phase) >> 32);
  }
  states[pixel] = words_of(reference, signal);
  if (bandwidth_on || refractory_on) extras[pixel] = words_of(bandwidth_on ? signal : 0, 0);
}

/// Counts the events of a pixel as emit finds them. `alive_ns` is the end of its refractory time, before and
/// after.
uint count_events(EventWalk walk, Shot shot, inout int alive_ns) {
  uint count = 0u;
  if (events_left(walk, shot)) {
    int t;
    bool on;
    do {
      if (next_event(walk, shot, t, on)) count += 1u;
    } while (events_left(walk, shot));
    alive_ns = walk.alive_ns;
  }
  return count;
}

void main() {
  uint run = linear_invocation;
  if (run >= runs_per_row() * model.height) return;
  uint pixels;
  uvec2 at = run_start(run, pixels);
  uint pixel = at.y * model.width + at.x;
  bool first = interval.index == 0u;
  Step step = this_step(control.last_ns, control.leaked_last);
  ivec2 nominal = ivec2(model.on, model.off);
  float dark = model.dark;
  uint events = 0u, fired = 0u;
  float measured = 0.0;
  for (uint i = 0u; i < pixels; ++i, ++at.x, ++pixel) {
    float luminance = luminances[pixel];
    int signal = event_signal(luminance, dark);
    if (adaptive == adaptive_flow) measured = max(measured, flow_at(at, pixel));
    if (first) {
      look(pixel, signal, nominal);
      continue;
    }
    ivec2 before = pair(states[pixel]);
    ivec2 extra = ivec2(0);
    if (bandwidth_on || refractory_on) extra = pair(extras[pixel]);
    int seen = signal;
    if (bandwidth_on)
      signal =
          low_pass(before.y, extra.x, seen,
                   float(step.dt_ns) * model.angular_cutoff * relative_intensity(luminance, model.bright));
    ivec2 c = thresholds_at(pixel, nominal);
    if (adaptive == adaptive_brightness)
      measured = max(measured, float(abs(signal - before.y)) / float(min(c.x, c.y)));
    int leak = leak_on ? leak_between(step.leaked_from, step.leaked_to, c.x) : 0;
    int to = signal + leak;
    int crossings = count_crossings(before.x, to, c.x, c.y);
    uint count = uint(abs(crossings));
    int alive = extra.y;
    Shot shot = no_shot();
    if (shot_on) shot = begin_shot(pixel, luminance, step.dt_ns);
    if (refractory_on) {
      count = count_events(walk_crossings(before.y, to, before.x, crossings, c.x, c.y, step.dt_ns, alive),
                           shot, alive);
    } else if (shot_on && shot.next_ns != never_ns) {
      do {
        count += 1u;
        draw_shot(shot, shot.next_ns, step.dt_ns);
      } while (shot.next_ns != never_ns);
    }
    if (count > 0u) {
      events += count;
      fired |= 1u << i;
      befores[pixel] = words_of(before.y, crossings);
      if (refractory_on) awakes[pixel] = extra.y;
    }
    ivec2 after = ivec2(before.x + crossings * (crossings > 0 ? c.x : c.y) - leak, signal);
    if (after != before) states[pixel] = words_of(after.x, after.y);
    ivec2 kept = ivec2(bandwidth_on ? seen : 0, max(alive - step.dt_ns, 0));
    if ((bandwidth_on || refractory_on) && kept != extra) extras[pixel] = words_of(kept.x, kept.y);
  }
  runs[run].count = events;
  runs[run].fired = fired;
  // The bits of floats >= 0 are ordered like the floats, so the maximum does not depend on the order of the
  // pixels.
  if (adaptive != 0u && floatBitsToUint(measured) > control.measured)
    atomicMax(control.measured, floatBitsToUint(measured));
}
