#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Takes every pixel from one picture to the next through as many instants as its own motion asks for, and
// writes its events. What the pixel sees at an instant comes from the two pictures.
#include "event/pixels.glsl"
#include "event/look.glsl"

layout(local_size_x = cell_tile, local_size_y = cell_tile) in;
layout(set = 0, binding = event_after_binding, scalar) writeonly buffer AfterBlock { uint64_t afters[]; };
layout(set = 0, binding = event_extra_after_binding, scalar) writeonly buffer ExtraAfterBlock {
  uint64_t extras_after[];
};
layout(set = 0, binding = event_counts_binding, scalar) buffer CountsBlock { uint counts[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) writeonly buffer EventList { uint64_t v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer InstanceList { uint v[]; };

const uint kept = 16u;  ///< events that a pixel collects before it writes them

/// The events that wait to be written. Functions must not pass arrays on: they would be copied.
uint waiting_times[kept];
uint waiting_instances[kept];
struct Events {
  uint count;    ///< of the pixel so far
  uint waiting;  ///< of those, not yet written
};

/// Writes the events that wait: behind those that other pixels have written, or, after an overflow, in order
/// of the pixels.
void flush(inout Events events, uint place, inout uint rank) {
  if (events.waiting == 0u) return;
  uint first = between.replay != 0u ? rank : atomicAdd(control.events, events.waiting);
  rank += events.waiting;
  for (uint i = 0u; i < events.waiting && first + i < model.capacity; ++i) {
    EventList(interval.events).v[first + i] =
        words_of(int(waiting_times[i] >> 1), int(place | (waiting_times[i] & 1u)));
    if (instance_on) InstanceList(interval.instances).v[first + i] = waiting_instances[i];
  }
  events.waiting = 0u;
}

/// Holds the state of a pixel while it goes through its instants.
struct Pixel {
  int reference;
  int signal;
  int seen;   ///< input of the low pass
  int alive;  ///< end of the refractory time, after the instant
  int t_ns;   ///< the instant, after the interval's start
};

/// Takes the pixel to its next instant.
void advance(inout Pixel pixel, inout Events events, ivec2 c, float luminance, int to_ns, uint number,
             uint index, uint place, uint instance, inout uint rank) {
  int signal = event_signal(luminance, looks.dark), seen = signal, dt = to_ns - pixel.t_ns;
  if (bandwidth_on)
    signal = low_pass(pixel.signal, pixel.seen, seen,
                      float(dt) * model.angular_cutoff * relative_intensity(luminance, model.bright));
  int leak = 0;
  if (leak_on) {
    uint64_t during = interval.leaked_to - interval.leaked_from;
    uint whole = uint(interval.to_ns - interval.from_ns);
    leak = leak_between(
        interval.leaked_from + during * uint64_t(pixel.t_ns - interval.from_ns) / uint64_t(whole),
        interval.leaked_from + during * uint64_t(to_ns - interval.from_ns) / uint64_t(whole), c.x);
  }
  int to = signal + leak;
  int crossings = count_crossings(pixel.reference, to, c.x, c.y);
  Shot shot = no_shot();
  if (shot_on) shot = begin_shot_at(number, luminance, dt, index);
  if (crossings != 0 || shot.next_ns != never_ns) {
    EventWalk walk = walk_crossings(pixel.signal, to, pixel.reference, crossings, c.x, c.y, dt, pixel.alive);
    while (events_left(walk, shot)) {
      int t;
      bool on;
      if (next_event(walk, shot, t, on)) {
        waiting_times[events.waiting] = uint(pixel.t_ns + t) << 1 | uint(on);
        if (instance_on) waiting_instances[events.waiting] = instance;
        events.count += 1u;
        events.waiting += 1u;
        if (events.waiting == kept) flush(events, place, rank);
      }
    }
    pixel.alive = walk.alive_ns;
  }
  pixel.reference += crossings * (crossings > 0 ? c.x : c.y) - leak;
  pixel.signal = signal;
  pixel.seen = seen;
  pixel.alive = max(pixel.alive - dt, 0);
  pixel.t_ns = to_ns;
}

/// Returns what the pixel sees at an instant: the mean of both pictures, each with the weight of its nearness
/// in time, or the one that sees the nearer surface. `from` and `to` are the surfaces followed through the
/// two pictures, `begin` and `end` those that the pixel sees at them, `apart` whether these differ.
Look look_at(Instant at, vec2 x, Curve curves[2], inout Patch from, inout Patch to, Patch begin, Patch end,
             bool apart) {
  Look a = look_through(0u, curves[0], at, x, from), b = look_through(1u, curves[1], at, x, to);
  if (apart) {  // what the pixel sees at the other end may be in front already, or still
    Patch other = end;
    Look c = look_through(1u, curves[1], at, x, other);
    if (c.found && (!b.found || c.inverse_depth > b.inverse_depth)) b = c;
    other = begin;
    c = look_through(0u, curves[0], at, x, other);
    if (c.found && (!a.found || c.inverse_depth > a.inverse_depth)) a = c;
  }
  float gap = a.inverse_depth - b.inverse_depth;
  bool one = abs(gap) < 0.02 * max(a.inverse_depth, b.inverse_depth) + 1e-6;
  float weight = one ? at.t : gap > 0.0 ? 0.0 : 1.0;
  weight = b.found ? weight : 0.0;
  weight = a.found ? weight : 1.0;
  Look look = a;
  if (weight > 0.5) look = b;
  look.luminance = mix(a.luminance, b.luminance, weight);
  return look;
}

void main() {
  if (between.replay != 0u && control.events <= model.capacity) return;
  begin_looks();
  uvec2 at = gl_GlobalInvocationID.xy;
  if (at.x >= model.width || at.y >= model.height) return;
  uint number = at.y * model.width + at.x;
  vec2 x = vec2(at) + 0.5;
  uint across = tiles_along(model.width);
  vec4 tile = TileList(between.tiles[1]).v[(at.y / cell_tile) * across + at.x / cell_tile];
  uint instants = uint(tile.x);
  ivec2 c = thresholds_at(number, ivec2(model.on, model.off));
  ivec2 before = pair(states[number]);
  ivec2 extra = ivec2(0);
  if (bandwidth_on || refractory_on) extra = pair(extras[number]);
  Pixel pixel = Pixel(before.x, before.y, extra.x, extra.y, interval.from_ns);
  uint rank = between.replay != 0u ? counts[number] : 0u, place = at.y << 15 | at.x << 1;
  Events events;
  events.count = events.waiting = 0u;
  // A pixel whose luminance stays within its thresholds wherever it looks needs one step only.
  ivec2 range = floatBitsToInt(tile.zw);
  if (range.y < pixel.reference + c.x && range.x > pixel.reference - c.y) instants = 1u;
  uint grid = between.grid, span = uint(interval.to_ns - interval.from_ns);
  bool looks = instants > 1u;
  if (looks) {
    Curve curves[2] = Curve[2](ray_curve(0u, x), ray_curve(1u, x));
    Patch from = patch_of(cell_at(0u, number)), to = patch_of(cell_at(1u, number));
    Patch begin = from, end = to;
    vec2 arm = between.world[4].o.xy - x * between.world[4].o.z;
    bool apart =
        from.body != to.body || abs(dot(to.plane - from.plane, vec3(x, 1.0))) * length(arm) > near_surface_px;
    for (uint j = 1u; j < instants; ++j) {
      uint k = j * grid / instants;
      Instant now = Instant(k, float(k) / float(grid));
      Look look = look_at(now, x, curves, from, to, begin, end, apart);
      if (look.found)
        advance(pixel, events, c, look.luminance, interval.from_ns + grid_time(span, grid, k), number,
                interval.index * most_instants + k, place, look.ids & 0xffffu, rank);
    }
  }
  uint seen_last = 0u;
  if (instance_on) seen_last = cell_at(1u, number).ids & 0xffffu;
  advance(pixel, events, c, luminances[number], interval.to_ns, number,
          interval.index * most_instants + grid, place, seen_last, rank);
  flush(events, place, rank);
  if (between.replay != 0u) return;
  counts[number] = events.count;
  afters[number] = words_of(pixel.reference, pixel.signal);
  if (bandwidth_on || refractory_on)
    extras_after[number] = words_of(bandwidth_on ? pixel.seen : 0, pixel.alive);
}
