// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the pixel of an event camera, as pure functions that shaders and C++ tests read alike
// (docs/events.md).
//
// Logarithms, references and thresholds are integers, multiples of 2^-24 of a natural logarithm. Sums of
// thresholds are exact however many there are, "on the threshold" is a comparison of integers, and a
// crossing's time is a quotient of integers. Times within an interval are integer nanoseconds.
#ifndef GREATX_SHADERS_SHARED_EVENTS_H
#define GREATX_SHADERS_SHARED_EVENTS_H
#include "random.h"

#ifdef __cplusplus
#include <bit>
#include <cstdlib>

#define GREATX_INOUT(type) type&
namespace greatx::shared {
using glm::abs;
using glm::exp;
using glm::floor;
using glm::max;
using glm::min;
inline uint floatBitsToUint(float x) { return std::bit_cast<uint>(x); }
inline float uintBitsToFloat(uint x) { return std::bit_cast<float>(x); }
}  // namespace greatx::shared
#else
#define GREATX_INOUT(type) inout type
#endif

GREATX_SHARED_BEGIN

/// 1.0 of a natural logarithm.
const int log_one = 16777216;
/// The time that stands for no event. It is later than the end of any interval.
const int never_ns = 0x7fffffff;
/// The longest duration of an interval.
const int longest_interval_ns = 2000000000;

/// Returns int(x), |x| < 2^31. It uses shifts and masks, since CPU drivers convert floats to integers one
/// lane after the other.
GREATX_FUNCTION int whole_part(float x) {
  uint bits = floatBitsToUint(x);
  uint mantissa = (bits & 0x7fffffu) | 0x800000u;
  int shift = int((bits >> 23) & 0xffu) - 150;
  uint size = shift < 0 ? mantissa >> uint(min(-shift, 31)) : mantissa << uint(min(shift, 7));
  return x < 0.0f ? -int(size) : int(size);
}

/// Returns a whole number next to x, 0 <= x < 2^23: the nearest one, or the one below on a device that rounds
/// towards zero.
GREATX_FUNCTION int near_whole(float x) { return int(floatBitsToUint(x + 8388608.0f) & 0x7fffffu); }

/// Returns ln(x) * 2^24 of a normal x > 0, within 5 units (3e-7). It adds ln 2 times the exponent, which is
/// exact, and a series for the mantissa m in [sqrt 1/2, sqrt 2): 2 (s + s^3/3 + ... + s^9/9), s = (m - 1) /
/// (m + 1). The next term of the series is below 1e-9.
GREATX_FUNCTION int fixed_log(float x) {
  const uint root_two = 0x3504f3u;  // mantissa bits of sqrt 2
  uint bits = floatBitsToUint(x);
  uint mantissa = bits & 0x7fffffu;
  uint halved = mantissa >= root_two ? 1u : 0u;
  int exponent = int(bits >> 23) - 127 + int(halved);
  float m = uintBitsToFloat(mantissa | ((127u - halved) << 23));
  float s = (m - 1.0f) / (m + 1.0f);
  float q = s * s;
  float p = s * (2.0f + q * (0.66666667f + q * (0.4f + q * (0.28571429f + q * 0.22222222f))));
  float scaled = floor(p * 16777216.0f + 0.5f);  // a whole number below 2^23
  int part = near_whole(abs(scaled));
  return exponent * 11629080 + (scaled < 0.0f ? -part : part);
}

/// Returns the signal of the photoreceptor: ln(dark + luminance), both in cd/m^2. Luminances below 0 count as
/// 0.
GREATX_FUNCTION int event_signal(float luminance, float dark) {
  return fixed_log(dark + max(luminance, 0.0f));
}

/// Returns the relative intensity on which bandwidth and shot noise depend: (255 L / bright + 20) / 275, at
/// most 1 (v2e's scaling, with `bright` as its white).
GREATX_FUNCTION float relative_intensity(float luminance, float bright) {
  return min((255.0f / 275.0f) * (max(luminance, 0.0f) / bright) + 20.0f / 275.0f, 1.0f);
}

/// A first-order low pass after a step of `x` time constants, during which its input goes linearly from `u0`
/// to `u1`. The result is the exact answer to that input. `y0` is the value before.
GREATX_FUNCTION int low_pass(int y0, int u0, int u1, float x) {
  float decay = exp(-x);
  float lag = x < 1e-2f ? 1.0f - x * (0.5f - x * (1.0f / 6.0f)) : (1.0f - decay) / x;
  return u1 + whole_part(float(y0 - u0) * decay) - whole_part(floor(float(u1 - u0) * lag + 0.5f));
}

/// Counts the crossings of a step that ends at `signal`. They are every reference + k on (k = 1, 2, ...) up
/// to the signal, counted positive, or every reference - k off down to it, counted negative. A signal exactly
/// on the threshold counts. Afterwards the signal lies less than one threshold from the new reference.
GREATX_FUNCTION int count_crossings(int reference, int signal, int on, int off) {
  int above = signal - reference;
  int size = abs(above), c = above > 0 ? on : off;
  // The quotient is computed in floats, since vector units lack the division of integers. It is off by one at
  // most.
  int n = near_whole(float(size) / float(c));
  int rest = size - n * c;
  n += (rest >= c ? 1 : 0) - (rest < 0 ? 1 : 0);
  return above > 0 ? n : -n;
}

/// Returns the nanoseconds, 1 to dt_ns, after a step's start at which a linear signal has changed by `part`
/// of the `whole`. The time is rounded up. `inverse` is 1 / whole.
GREATX_FUNCTION int part_time(uint part, uint whole, float inverse, int dt_ns) {
  uint64_t product = uint64_t(part) * uint64_t(dt_ns);
  // The division takes two steps of floats, since vector units lack the division of integers. The first
  // quotient is too small by some 3000 at most. The second is off by one at most, which comparisons of
  // integers correct.
  uint first = uint(whole_part(float(part) * (float(dt_ns) * inverse) * (1.0f - 9.5367432e-7f)));
  uint64_t left = product - uint64_t(first) * uint64_t(whole);
  uint second = uint(near_whole((float(uint(left >> 32)) * 4294967296.0f + float(uint(left))) * inverse));
  int64_t rest = int64_t(left - uint64_t(second) * uint64_t(whole));  // above -whole, below 2 whole
  return int(first + second) + (rest > int64_t(0) ? 1 : 0) + (rest > int64_t(whole) ? 1 : 0);
}

/// Returns the time after the step's start, in ns, at which a signal that goes from `from` to `to` reaches
/// `level`. The level lies between them and is not `from`.
GREATX_FUNCTION int crossing_time(int from, int to, int level, int dt_ns) {
  uint whole = uint(abs(to - from));
  return part_time(uint(abs(level - from)), whole, 1.0f / float(whole), dt_ns);
}

/// Returns the drift of a leaking reference between two instants, for a threshold. `turns` are thresholds
/// leaked since the beginning, in 32.32 fixed point. Sums over steps are exact, since the fractions
/// telescope.
GREATX_FUNCTION int leak_between(uint64_t turns_from, uint64_t turns_to, int on) {
  int whole = int(uint(turns_to >> 32) - uint(turns_from >> 32));
  uint64_t c = uint64_t(on);
  int to = int((c * (turns_to & uint64_t(0xffffffffu))) >> 32);
  int from = int((c * (turns_from & uint64_t(0xffffffffu))) >> 32);
  return on * whole + to - from;
}

/// Returns the mean time between shot-noise events of both polarities, ns. By v2e's rate, bright light has a
/// quarter of the rate of the dark. The time is at most 2e9.
GREATX_FUNCTION float shot_mean_ns(float rate_hz, float intensity) {
  return min(1e9f / (rate_hz * (1.0f - 0.75f * intensity)), 2e9f);
}

/// Returns the time to the next event of a Poisson process, ns, from 1 on: -ln(u) times the mean, u uniform
/// from 24 bits.
GREATX_FUNCTION int shot_gap_ns(uint bits, float mean_ns) {
  float u = (float(bits >> 8) + 0.5f) * (1.0f / 16777216.0f);
  float gap = float(-fixed_log(u)) * (1.0f / 16777216.0f) * mean_ns;
  return gap < 2e9f ? 1 + whole_part(gap) : 2000000001;
}

/// Holds the crossings of one pixel within one step, one after the other in order of time.
struct EventWalk {
  int dt_ns;        ///< length of the step
  uint whole;       ///< size of the signal's change during the step
  float inverse;    ///< 1 / whole
  uint part;        ///< size of the change from the start of the step to the next crossing
  int stride;       ///< change from one crossing to the next, signed
  int left;         ///< crossings still to come
  int crossing_ns;  ///< time of the next crossing; never_ns: none
  int alive_ns;     ///< the pixel is refractory before this time: no event
};

/// Begins a walk. `crossings` is the result of count_crossings for this reference.
GREATX_FUNCTION EventWalk walk_crossings(int from, int to, int reference, int crossings, int on, int off,
                                         int dt_ns, int alive_ns) {
  EventWalk walk;
  walk.dt_ns = dt_ns;
  walk.whole = uint(abs(to - from));
  walk.inverse = 1.0f / float(walk.whole);
  walk.stride = crossings > 0 ? on : -off;
  walk.part = uint(abs(reference + walk.stride - from));
  walk.left = abs(crossings);
  walk.crossing_ns = never_ns;
  if (walk.left > 0) walk.crossing_ns = part_time(walk.part, walk.whole, walk.inverse, dt_ns);
  walk.alive_ns = alive_ns;
  return walk;
}

GREATX_FUNCTION EventWalk begin_walk(int from, int to, int reference, int on, int off, int dt_ns,
                                     int alive_ns) {
  return walk_crossings(from, to, reference, count_crossings(reference, to, on, off), on, off, dt_ns,
                        alive_ns);
}

/// Removes the next crossing from the walk and returns its time.
GREATX_FUNCTION int take_crossing(GREATX_INOUT(EventWalk) walk) {
  int t = walk.crossing_ns;
  walk.left -= 1;
  walk.part += uint(abs(walk.stride));
  walk.crossing_ns = never_ns;
  if (walk.left > 0) walk.crossing_ns = part_time(walk.part, walk.whole, walk.inverse, walk.dt_ns);
  return t;
}

/// Returns whether an event at `t_ns` passes the refractory time. If it does, the pixel is refractory from
/// then on.
GREATX_FUNCTION bool pass_refractory(GREATX_INOUT(EventWalk) walk, int t_ns, int refractory_ns) {
  if (t_ns < walk.alive_ns) return false;
  walk.alive_ns = t_ns > never_ns - refractory_ns ? never_ns : t_ns + refractory_ns;
  return true;
}

/// Shot noise takes its random words from the dimension blocks step * shot_blocks_per_step + n, where n
/// counts blocks of four arrivals.
const uint shot_blocks_per_step = 65536u;

// ---- data that the passes share --------------------------------------------------------------------------

const uint event_model_binding = 0u;    // storage: EventModel
const uint event_control_binding = 1u;  // storage: EventControl
const uint event_runs_binding = 2u;     // storage: EventRun [runs]
// Pictures and the state of the pixels: [height * width], row by row.
const uint event_luminance_binding = 3u;  // storage: float, cd/m^2
const uint event_seen_binding = 4u;       // storage: uvec2: planar depth's bits, triangle + 1
const uint event_pixel_binding = 5u;      // storage: ivec2: reference, signal
const uint event_extra_binding = 6u;      // storage: ivec2: input of the low pass, end of the refractory time
const uint event_before_binding = 7u;     // storage: ivec2, where it fired: signal before, signed crossings
const uint event_awake_binding = 11u;     // storage: int: end of the refractory time before
const uint event_threshold_binding = 8u;  // storage: ivec2: on, off
const uint event_objects_binding = 9u;    // storage: uvec2 [triangles]: instance + 1, body
const uint event_motion_binding = 10u;    // storage: EventMotion [bodies]
// Reconstructed instants (shared/reproject.h): the state after the step, and the pixels' numbers of events.
const uint event_after_binding = 12u;        // storage: as event_pixel_binding
const uint event_extra_after_binding = 13u;  // storage: as event_extra_binding
const uint event_counts_binding = 14u;       // storage: uint
const uint event_reproject_binding = 15u;    // storage: ReprojectInterval
const uint event_previous_binding = 0u;      // storage, difference pass: float, the picture before

// Specialization constants. An effect that is off is not compiled.
const uint event_spec_mismatch = 0u;
const uint event_spec_leak = 1u;
const uint event_spec_shot = 2u;
const uint event_spec_refractory = 3u;
const uint event_spec_bandwidth = 4u;
const uint event_spec_instance = 5u;
const uint event_spec_adaptive = 6u;  // 0 fixed, 1 by flow, 2 by brightness
const uint event_spec_count = 7u;
const uint adaptive_flow = 1u;
const uint adaptive_brightness = 2u;

/// A run consists of pixels of a row that one invocation handles one after the other. Runs are numbered row
/// by row.
const uint run_pixels = 16u;
const uint event_group_size = 64u;
const uint event_scan_size = 256u;
const uint most_substeps = 64u;
const uint most_instants = 256u;  // of a pixel between two pictures, if they are reconstructed

/// Holds the data that do not change.
struct EventModel {
  uint width;
  uint height;
  int on;  ///< nominal thresholds
  int off;
  float dark;            ///< cd/m^2 added before the logarithm
  float bright;          ///< cd/m^2 of relative intensity 1
  float angular_cutoff;  ///< 2 pi times the bandwidth in bright light, rad/ns
  float shot_rate_hz;
  int refractory_ns;
  uint capacity;  ///< most events per picture interval
  float fx;       ///< pixels; for the flow
  float fy;
  float cx;
  float cy;
  /// For adaptive steps, the wanted change from picture to picture: pixels of motion, or change over the
  /// threshold.
  float wanted;
  uint pattern_seed;  ///< seed of the numbers that are drawn once for each pixel
  uint pattern_stream;
};

/// Describes a run of pixels in one step.
struct EventRun {
  uint first;  ///< events before the run in the interval, from the last step's scan
  uint count;  ///< events of the run
  uint fired;  ///< bit i: pixel i of the run has events
};

/// Holds the head of the buffer. It is kept from tick to tick.
struct EventControl {
  uint64_t leaked_last;  ///< thresholds leaked at the last picture taken, 32.32
  uint64_t leaked_from;  ///< thresholds leaked at the picture before the last one
  uint events;           ///< events of this interval so far, including those beyond the capacity
  uint last;             ///< grid index of the last picture taken
  uint measured;         ///< bits of the largest flow (px/ns) or change (thresholds) since the last picture
  uint allowed;          ///< bits of the time to the next picture that the pictures so far allow, ns
  uint pictures;         ///< pictures of this interval
  uint coarse;           ///< pictures of this interval that moved or changed more than wanted
  uint largest;          ///< bits of the largest motion or change between two pictures of this interval
  int last_ns;           ///< time of the last picture
  int from_ns;           ///< time of the picture before the last one
  uint due[65];          ///< by grid index: whether a picture is taken
  uint ranked;           ///< reconstructed instants: events up to the picture before
};
const uint event_due_offset = 52u;  ///< bytes

/// Describes how a body moves as the camera sees it, in optical axes: the velocity of the point p is a + w x
/// p, m/s and rad/s.
struct EventMotion {
  vec3 a;
  vec3 w;
};

struct EventConstants {
  uint64_t leaked_from;  ///< thresholds leaked at the previous instant, 32.32
  uint64_t leaked_to;    ///< thresholds leaked at this instant
  /// Address of uvec2 [capacity]: ns after the interval's start; row << 15 | column << 1 | p.
  uint64_t events;
  uint64_t instances;  ///< address of uint [capacity]
  int from_ns;         ///< previous instant, after the interval's start
  int to_ns;           ///< this instant
  uint interval_ns;
  uint grid;   ///< instants of the interval
  uint index;  ///< index of this instant, 1 to grid; 0: the first picture, which sets the reference
  uint noise_seed;
  uint noise_stream;
  uint noise_sample;  ///< sample number of the sensor
};

struct DifferenceConstants {
  uint64_t picture;  ///< address of bytes [height * width], padded to words: 1, 0, -1
  uint width;
  uint height;
  float on;  ///< cd/m^2
  float off;
  uint first;  ///< there is no picture before
  uint pad;
};

/// Returns instant `index` of the interval, ns after its start.
GREATX_FUNCTION int grid_time(uint interval_ns, uint grid, uint index) {
  return int(uint64_t(interval_ns) * uint64_t(index) / uint64_t(grid));
}

/// Returns the thresholds leaked at that instant, 32.32.
GREATX_FUNCTION uint64_t leak_at(uint64_t begin, uint64_t during, uint grid, uint index) {
  return begin + during * uint64_t(index) / uint64_t(grid);
}

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::EventModel) == 68);
static_assert(sizeof(greatx::shared::EventRun) == 12);
static_assert(sizeof(greatx::shared::EventControl) == 52 + 260 + 8);
static_assert(sizeof(greatx::shared::EventConstants) == 64);
static_assert(sizeof(greatx::shared::DifferenceConstants) == 32);
#endif
#endif
