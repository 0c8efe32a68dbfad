// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Limbs and wheels before a radar: the spectrum of a walking man has the line of his trunk and reaches up to
// the speed of his feet, and that of a car has the line of its body and reaches from 0 to twice its speed.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "scene/generator/objects/shapes.h"
#include "sim/scenario/gait.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;

constexpr double bin_m_s = speed_of_light / 77e9 / (2.0 * 512 * 60e-6);  // wavelength over twice the frame
constexpr double skirt_m_s = 5.0 * bin_m_s;                              ///< of the window
constexpr uint32_t frames = 12;

/// A node with a model that moves straight on from `from` by `step` in a second, before a radar at rest at
/// (0, 0, 0.8) that looks along x.
KeptRun run_past(const std::string& model, const dvec3& from, const dvec3& step) {
  const dvec3 to = from + 2.0 * step;
  return keep_run(fmt::format(
      "greatx: 1\nname: test\nseed: 2\nticks: {}\ntick_rate_hz: 10\nnodes:\n"
      "  - name: post\n    trajectory: {{type: static, position_m: [0, 0, 0.8]}}\n    sensors:\n"
      "      - {{name: radar, type: radar, rate_hz: 10, transmit: {{columns: 1, pattern: isotropic}}, "
      "receive: {{columns: 1, pattern: isotropic}}, outputs: [range_doppler], "
      "waveform: {{carrier_hz: 77e9, bandwidth_hz: 300e6, chirps: 512, samples: 128, interval_s: 60e-6}}, "
      "echoes: {{diffuse_patch_m: 0.04}}, field_of_view: {{azimuth_deg: [-70, 70], elevation_deg: [-10, "
      "10]}}}}\n"
      "  - name: mover\n"
      "    trajectory: {{type: waypoints, interpolation: linear, points: [{{t_s: 0, position_m: [{}, {}, "
      "0]}}, "
      "{{t_s: 2, position_m: [{}, {}, 0]}}]}}\n"
      "    model: {}\n"
      "effects: {{radar_clutter: on}}\n",
      frames, from.x, from.y, to.x, to.y, model));
}

/// The mean power over all frames and ranges by the speed of approach.
struct Spectrum {
  std::vector<double> power;
  double first_m_s = 0.0;
  double speed_at(size_t i) const { return first_m_s + bin_m_s * static_cast<double>(i); }
  double most() const { return *std::max_element(power.begin(), power.end()); }
  double strongest_m_s() const {
    return speed_at(static_cast<size_t>(std::max_element(power.begin(), power.end()) - power.begin()));
  }
  /// Returns the lowest and the highest speed with more than `share` of the largest power.
  std::pair<double, double> reach(double share) const {
    double low = 1e9, high = -1e9;
    for (size_t i = 0; i < power.size(); ++i)
      if (power[i] > share * most()) low = std::min(low, speed_at(i)), high = std::max(high, speed_at(i));
    return {low, high};
  }
};

Spectrum spectrum_of(const KeptRun& run) {
  constexpr size_t speeds = 512;
  Spectrum spectrum;
  spectrum.power.resize(speeds);
  spectrum.first_m_s = -bin_m_s * (0.5 * speeds - 1.0);
  for (uint32_t tick = 0; tick < frames; ++tick) {
    const auto map = run.array<float>(tick, "post/radar", "range_doppler");
    // The map has range rates: approach is negative.
    for (size_t i = 0; i < map.size(); ++i) spectrum.power[speeds - 1 - i % speeds] += double(map[i]);
  }
  return spectrum;
}

/// The trunk moves at the speed of the way. A sole moves at that speed and its own, which is 0 on the ground
/// and two to three and a half times the way's in the middle of a swing; arms swing back by less than the way
/// goes on.
TEST(MicroDoppler, AWalkingManReachesFromRestToTheSpeedOfHisFeet) {
  constexpr double speed = 1.34;
  const scene::PersonShape& shape = scene::person_shape("man");
  std::string parts;
  for (const char* limb : {"thigh", "shank", "upper_arm", "forearm"})
    for (const char* side : {"left", "right"})
      parts += fmt::format(
          "{{nodes: {0}_{1}, phase_deg: 0, gait: {{limb: {0}, side: {1}, thigh_m: {2}, shank_m: {3}}}}}, ",
          limb, side, shape.thigh_m, shape.shank_m);
  const Spectrum spectrum =
      spectrum_of(run_past("{generate: {kind: person, variant: man, seed: 3}, parts: [" + parts + "]}",
                           {12.0, 0.0, 0.0}, {-speed, 0.0, 0.0}));
  const Gait gait({shape.thigh_m, shape.shank_m, speed}, 0.0);
  double foot = 0.0;
  for (int i = 0; i < 1000; ++i)
    foot = std::max(foot, speed + gait.sole_forward(true, {gait.stride_m() * i / 1000.0, speed, 0.0}).rate);
  EXPECT_GT(foot, 2.0 * speed);
  EXPECT_LT(foot, 3.5 * speed);
  EXPECT_NEAR(spectrum.strongest_m_s(), speed, 2.0 * bin_m_s);
  const auto [low, high] = spectrum.reach(1e-3);
  // The shank's turn makes the toes somewhat faster than the sole.
  EXPECT_GT(low, -skirt_m_s);
  EXPECT_GT(high, 0.75 * foot);
  EXPECT_LT(high, 1.1 * foot + skirt_m_s);
}

/// The car drives past, 5 m beside the radar. What it shows of its body comes nearer by v times the cosine of
/// the angle between its way and the line of sight; points of the wheels by 0 to twice that.
TEST(MicroDoppler, WheelsReachFromRestToTwiceTheSpeed) {
  constexpr double speed = 3.0, half_length = 2.4, half_width = 0.9;
  const dvec3 from(9.0, 5.0, 0.0);
  const Spectrum spectrum = spectrum_of(
      run_past("{generate: {kind: vehicle, variant: saloon, seed: 3}, parts: [{nodes: \"wheel_*\", roll: "
               "{radius_m: 0.325}, phase_deg: 0}]}",
               from, {-speed, 0.0, 0.0}));
  // Between the first frame and the last, the nearest and the farthest corner of the car.
  const double last = from.x - 0.1 * frames * speed - half_length, first = from.x + half_length;
  const double slowest = speed * last / std::hypot(last, from.y + half_width),
               fastest = speed * first / std::hypot(first, from.y - half_width);
  EXPECT_GT(spectrum.strongest_m_s(), slowest - 2.0 * bin_m_s);
  EXPECT_LT(spectrum.strongest_m_s(), fastest + 2.0 * bin_m_s);
  const auto [low, high] = spectrum.reach(3e-4);
  EXPECT_LT(low, 0.3 * speed);
  EXPECT_GT(low, -skirt_m_s);
  EXPECT_GT(high, 1.4 * speed);
  EXPECT_LT(high, 2.0 * fastest + skirt_m_s);
}

}  // namespace
}  // namespace greatx::sim
