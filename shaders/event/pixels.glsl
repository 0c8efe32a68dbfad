// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the passes that count events and write them down share: so that they agree to the bit.
#ifndef GREATX_EVENT_PIXELS_GLSL
#define GREATX_EVENT_PIXELS_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#include "shared/events.h"

layout(constant_id = event_spec_mismatch) const bool mismatch_on = false;
layout(constant_id = event_spec_leak) const bool leak_on = false;
layout(constant_id = event_spec_shot) const bool shot_on = false;
layout(constant_id = event_spec_refractory) const bool refractory_on = false;
layout(constant_id = event_spec_bandwidth) const bool bandwidth_on = false;
layout(constant_id = event_spec_instance) const bool instance_on = false;
layout(constant_id = event_spec_adaptive) const uint adaptive = 0u;

layout(set = 0, binding = event_model_binding, scalar) readonly buffer ModelBlock { EventModel model; };
layout(set = 0, binding = event_control_binding, scalar) buffer ControlBlock { EventControl control; };
layout(set = 0, binding = event_runs_binding, scalar) buffer RunsBlock { EventRun runs[]; };
layout(set = 0, binding = event_luminance_binding, scalar) readonly buffer LuminanceBlock { float luminances[]; };
layout(set = 0, binding = event_seen_binding, scalar) readonly buffer SeenBlock { uvec2 seen_by_pixel[]; };
layout(set = 0, binding = event_pixel_binding, scalar) buffer PixelBlock { ivec2 states[]; };
layout(set = 0, binding = event_extra_binding, scalar) buffer ExtraBlock { ivec2 extras[]; };
layout(set = 0, binding = event_before_binding, scalar) buffer BeforeBlock { ivec2 befores[]; };
layout(set = 0, binding = event_awake_binding, scalar) buffer AwakeBlock { int awakes[]; };
layout(set = 0, binding = event_threshold_binding, scalar) readonly buffer ThresholdBlock { ivec2 thresholds[]; };
layout(set = 0, binding = event_objects_binding, scalar) readonly buffer ObjectsBlock { uvec2 objects[]; };
layout(set = 0, binding = event_motion_binding, scalar) readonly buffer MotionBlock { EventMotion motions[]; };
layout(push_constant, scalar) uniform Constants { EventConstants interval; };

/// The step that ends at this picture: from the picture before.
struct Step {
  int from_ns;
  int dt_ns;
  uint64_t leaked_from;
  uint64_t leaked_to;
};

/// `last`: grid index of the picture before; of fixed steps known anyway.
Step this_step(uint last) {
  if (adaptive == 0u) last = interval.index - 1u;
  Step step;
  step.from_ns = grid_time(interval.interval_ns, interval.grid, last);
  step.dt_ns = grid_time(interval.interval_ns, interval.grid, interval.index) - step.from_ns;
  step.leaked_from = leak_at(interval.leak_begin, interval.leak_interval, interval.grid, last);
  step.leaked_to = leak_at(interval.leak_begin, interval.leak_interval, interval.grid, interval.index);
  return step;
}

uint runs_per_row() { return (model.width + run_pixels - 1u) / run_pixels; }

/// First pixel of a run; `count`: how many it has.
uvec2 run_start(uint run, out uint count) {
  uint per_row = runs_per_row();
  uint column = run % per_row * run_pixels;
  count = min(run_pixels, model.width - column);
  return uvec2(column, run / per_row);
}

/// on and off of a pixel.
ivec2 thresholds_at(uint pixel) { return mismatch_on ? thresholds[pixel] : ivec2(model.on, model.off); }

/// Events of shot noise, drawn one after the other: a Poisson process begun anew with each step, which changes nothing,
/// since it has no memory.
struct Shot {
  float mean_ns;
  uint pixel;
  uint drawn;
  uvec4 words;
  bool on;  ///< polarity of the next
};

void draw_shot(inout Shot shot, inout EventWalk walk, int after_ns) {
  uint lane = shot.drawn & 3u;
  if (lane == 0u)
    shot.words = random_bits(interval.noise_seed, interval.noise_stream, interval.noise_sample, shot.pixel,
                             interval.index * shot_blocks_per_step + (shot.drawn >> 2));
  uint word = lane == 0u ? shot.words.x : lane == 1u ? shot.words.y : lane == 2u ? shot.words.z : shot.words.w;
  shot.drawn += 1u;
  shot.on = (word & 1u) != 0u;
  int gap = shot_gap_ns(word, shot.mean_ns);
  walk.shot_ns = gap > walk.dt_ns - after_ns ? never_ns : after_ns + gap;
}

Shot begin_shot(inout EventWalk walk, uint pixel) {
  Shot shot;
  shot.pixel = pixel;
  shot.drawn = 0u;
  if (shot_on) {
    shot.mean_ns = shot_mean_ns(model.shot_rate_hz, relative_intensity(luminances[pixel], model.bright));
    draw_shot(shot, walk, 0);
  }
  return shot;
}

/// The next event that is let through: its time and polarity. False: none is left.
bool next_event(inout EventWalk walk, inout Shot shot, out int t_ns, out bool on) {
  while (true) {
    bool crossing = walk.crossing_ns <= walk.shot_ns;
    if (crossing) {
      if (walk.crossing_ns == never_ns) return false;
      on = walk.stride > 0;
      t_ns = take_crossing(walk);
    } else {
      t_ns = walk.shot_ns;
      on = shot.on;
      draw_shot(shot, walk, t_ns);
    }
    if (!refractory_on || pass_refractory(walk, t_ns, model.refractory_ns)) return true;
  }
}
#endif
