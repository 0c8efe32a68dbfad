// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// This is the common part of the pass that counts events and the pass that writes them, so that the two agree
// to the bit.
#ifndef GREATX_EVENT_PIXELS_GLSL
#define GREATX_EVENT_PIXELS_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
#include "shared/events.h"

layout(constant_id = event_spec_mismatch) const bool mismatch_on = false;
layout(constant_id = event_spec_leak) const bool leak_on = false;
layout(constant_id = event_spec_shot) const bool shot_on = false;
layout(constant_id = event_spec_refractory) const bool refractory_on = false;
layout(constant_id = event_spec_bandwidth) const bool bandwidth_on = false;
layout(constant_id = event_spec_instance) const bool instance_on = false;
layout(constant_id = event_spec_adaptive) const uint adaptive = 0u;

// Pairs of words are loaded and stored as one number of 64 bits: CPU drivers access memory one lane after the
// other.
layout(set = 0, binding = event_model_binding, scalar) readonly buffer ModelBlock { EventModel model; };
layout(set = 0, binding = event_control_binding, scalar) buffer ControlBlock { EventControl control; };
layout(set = 0, binding = event_runs_binding, scalar) buffer RunsBlock { EventRun runs[]; };
layout(set = 0, binding = event_luminance_binding, scalar) readonly buffer LuminanceBlock {
  float luminances[];
};
layout(set = 0, binding = event_seen_binding, scalar) readonly buffer SeenBlock { uint64_t seen_by_pixel[]; };
layout(set = 0, binding = event_pixel_binding, scalar) buffer PixelBlock { uint64_t states[]; };
layout(set = 0, binding = event_extra_binding, scalar) buffer ExtraBlock { uint64_t extras[]; };
layout(set = 0, binding = event_before_binding, scalar) buffer BeforeBlock { uint64_t befores[]; };
layout(set = 0, binding = event_awake_binding, scalar) buffer AwakeBlock { int awakes[]; };
layout(set = 0, binding = event_threshold_binding, scalar) readonly buffer ThresholdBlock {
  uint64_t thresholds[];
};
layout(set = 0, binding = event_objects_binding, scalar) readonly buffer ObjectsBlock { uvec2 objects[]; };
layout(set = 0, binding = event_motion_binding, scalar) readonly buffer MotionBlock {
  EventMotion motions[];
};
layout(push_constant, scalar) uniform Constants { EventConstants interval; };

ivec2 pair(uint64_t words) { return ivec2(unpack32(words)); }
uint64_t words_of(int x, int y) { return pack64(u32vec2(uint(x), uint(y))); }

/// Holds the step from the picture before to this picture.
struct Step {
  int from_ns;
  int dt_ns;
  uint64_t leaked_from;
  uint64_t leaked_to;
};

/// Makes the step from the given picture before. With fixed steps that picture is known anyway.
Step this_step(int from_ns, uint64_t leaked_from) {
  Step step;
  step.from_ns = adaptive == 0u ? interval.from_ns : from_ns;
  step.dt_ns = interval.to_ns - step.from_ns;
  step.leaked_from = adaptive == 0u ? interval.leaked_from : leaked_from;
  step.leaked_to = interval.leaked_to;
  return step;
}

uint runs_per_row() { return (model.width + run_pixels - 1u) / run_pixels; }

/// Returns the first pixel of a run; `count` is the number of its pixels.
uvec2 run_start(uint run, out uint count) {
  uint per_row = runs_per_row();
  uint row = run / per_row;
  uint column = (run - row * per_row) * run_pixels;
  count = min(run_pixels, model.width - column);
  return uvec2(column, row);
}

/// Returns the on and off thresholds of a pixel. `nominal` holds those without mismatch.
ivec2 thresholds_at(uint pixel, ivec2 nominal) { return mismatch_on ? pair(thresholds[pixel]) : nominal; }

/// Draws events of shot noise one after the other. The Poisson process begins anew with each step,
/// which changes nothing, since it has no memory.
struct Shot {
  float mean_ns;
  uint pixel;
  uint drawn;
  uint step;  ///< number of the step within the interval
  uvec4 words;
  bool on;      ///< polarity of the next
  int next_ns;  ///< never_ns: none
};

void draw_shot(inout Shot shot, int after_ns, int dt_ns) {
  uint lane = shot.drawn & 3u;
  if (lane == 0u)
    shot.words = random_bits(interval.noise_seed, interval.noise_stream, interval.noise_sample, shot.pixel,
                             shot.step * shot_blocks_per_step + (shot.drawn >> 2));
  uint word = lane == 0u   ? shot.words.x
              : lane == 1u ? shot.words.y
              : lane == 2u ? shot.words.z
                           : shot.words.w;
  shot.drawn += 1u;
  shot.on = (word & 1u) != 0u;
  int gap = shot_gap_ns(word, shot.mean_ns);
  shot.next_ns = gap > dt_ns - after_ns ? never_ns : after_ns + gap;
}

Shot begin_shot_at(uint pixel, float luminance, int dt_ns, uint step) {
  Shot shot;
  shot.pixel = pixel;
  shot.step = step;
  shot.drawn = 0u;
  shot.mean_ns = shot_mean_ns(model.shot_rate_hz, relative_intensity(luminance, model.bright));
  draw_shot(shot, 0, dt_ns);
  return shot;
}

Shot begin_shot(uint pixel, float luminance, int dt_ns) {
  return begin_shot_at(pixel, luminance, dt_ns, interval.index);
}

/// Returns a Shot without noise.
Shot no_shot() {
  Shot shot;
  shot.next_ns = never_ns;
  return shot;
}

bool events_left(EventWalk walk, Shot shot) { return min(walk.crossing_ns, shot.next_ns) != never_ns; }

/// Takes the next of the events left: its time and polarity. Returns false if the pixel is refractory and
/// drops it.
bool next_event(inout EventWalk walk, inout Shot shot, out int t_ns, out bool on) {
  if (walk.crossing_ns <= shot.next_ns) {
    on = walk.stride > 0;
    t_ns = take_crossing(walk);
  } else {
    t_ns = shot.next_ns;
    on = shot.on;
    draw_shot(shot, t_ns, walk.dt_ns);
  }
  return !refractory_on || pass_refractory(walk, t_ns, model.refractory_ns);
}
#endif
