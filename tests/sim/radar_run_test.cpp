// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests what a run does with several radars: their interference, leakage and aliases.
#include <algorithm>
#include <complex>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/sim/radio_run.h"
#include "tests/support/kept_run.h"
#include "tests/support/tiny_scene.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;
using ::testing::HasSubstr;

/// Two radars, 30 m apart, that look at each other. `first` are further fields of the first one.
KeptRun run_facing(bool wall, const std::string& first, const std::string& effects = "") {
  test::TinyScene tiny;
  const uint32_t concrete = tiny.material_as(testing::radio_material("concrete"));
  tiny.object("far", 0, concrete).quad({-60, -2, -2}, {-60, 2, -2}, {-60, 2, 2}, {-60, -2, 2});
  if (wall) tiny.object("wall", 0, concrete).box({14, -3, -3}, {14.3, 3, 3});
  auto world = std::make_shared<const World>(World{tiny.build(), {0, 0}, {0, 0}, {}, {}});
  // The ramps of the second one are less steep: they cross those of the first one.
  const auto radar = [](const char* bandwidth_hz) {
    return fmt::format(
        "waveform: {{bandwidth_hz: {}, samples: 64, sample_rate_hz: 5e6, chirp_s: 20e-6, interval_s: 25e-6, "
        "chirps: 32}}, transmit: {{columns: 1}}, receive: {{columns: 2}}, outputs: [cube, range_doppler]",
        bandwidth_hz);
  };
  return keep_run(make_experiment(
      parse_scenario(
          "greatx: 1\nname: test\nseed: 4\nticks: 3\ntick_rate_hz: 10\nnodes:\n"
          "  - {name: a, trajectory: {type: static, position_m: [0, 0, 0]}, sensors: [{name: radar, "
          "type: radar, rate_hz: 10, " +
              radar("150e6") + first +
              "}]}\n"
              "  - {name: b, trajectory: {type: static, position_m: [30, 0, 0], rotation_deg: [180, 0, "
              "0]}, sensors: [{name: radar, type: radar, rate_hz: 10, " +
              radar("60e6") + "}]}\n" + effects,
          "test.yaml", "."),
      std::move(world)));
}

std::string note_of(const KeptRun& r) {
  for (const auto& [name, text] : r.statistics.notes)
    if (name == "a/radar interference of b/radar") return text;
  return "none";
}

bool same(const KeptRun& one, size_t packet, const KeptRun& other, size_t other_packet,
          const std::string& radar) {
  return std::ranges::equal(one.array<std::complex<float>>(packet, radar, "cube"),
                            other.array<std::complex<float>>(other_packet, radar, "cube"));
}

double largest(const KeptRun& r, size_t packet) {
  double power = 0.0;
  for (const auto& sample : r.array<std::complex<float>>(packet, "a/radar", "cube"))
    power = std::max(power, double(std::norm(sample)));
  return power;
}

TEST(RadarRun, OtherRadarsDisturbInSightAlone) {
  const KeptRun off = run_facing(false, ""), on = run_facing(false, ", interference: {}"),
                hidden = run_facing(true, ", interference: {}"),
                switched = run_facing(false, ", interference: {}", "effects: {radar_interference: off}\n");
  // A sample in a burst has the received power: 12 dBm over 30 m.
  const double friis = 0.0158489319246111 * std::pow(speed_of_light / 77e9 / (4.0 * pi * 30.0), 2);
  double most = 0.0;
  for (size_t packet = 0; packet < 3; ++packet) most = std::max(most, largest(on, packet));
  EXPECT_NEAR(decibels(most), decibels(friis), 0.2);
  EXPECT_THAT(note_of(on), HasSubstr("at most -87.7 dBm at the receiver, 3 of 3 frames in sight"));
  EXPECT_EQ(note_of(hidden), "never in sight while both send");
  EXPECT_EQ(note_of(off), "none");
  EXPECT_EQ(note_of(switched), "none");
  EXPECT_FALSE(off.plan.radar_interference.on || switched.plan.radar_interference.on);
  EXPECT_THAT(on.plan.radar_interference.reason, HasSubstr("1 of the radars asks"));
  for (size_t packet = 0; packet < 3; ++packet) {
    EXPECT_LT(largest(off, packet), 1e-3 * friis);
    EXPECT_TRUE(same(off, packet, switched, packet, "a/radar"));
    EXPECT_TRUE(same(off, packet, on, packet, "b/radar"));
  }
  // The seed draws the offsets: they are the same in every run, and differ from frame to frame.
  const KeptRun again = run_facing(false, ", interference: {radars: [b/radar]}");
  EXPECT_TRUE(same(on, 0, again, 0, "a/radar"));
  EXPECT_FALSE(same(on, 0, on, 1, "a/radar"));
}

TEST(RadarRun, LeakageIsThereWithoutAScene) {
  const KeptRun r = run_facing(false, ", receiver: {leakage: {level_db: -40, length_m: 2}}");
  EXPECT_TRUE(r.plan.radar_leakage.on);
  EXPECT_NEAR(decibels(largest(r, 0)), decibels(0.0158489319246111) - 40.0, 0.05);
  const KeptRun off =
      run_facing(false, ", receiver: {leakage: {level_db: -40}}", "effects: {radar_leakage: off}\n");
  EXPECT_LT(largest(off, 0), 1e-3 * largest(r, 0));
}

/// A plate 40 m before a radar that comes closer.
KeptRun run_closing(const std::string& waveform, double speed_m_s) {
  test::TinyScene tiny;
  const uint32_t concrete = tiny.material_as(testing::radio_material("concrete"));
  tiny.object("plate", 0, concrete).quad({40, -2, -2}, {40, 2, -2}, {40, 2, 2}, {40, -2, 2});
  auto world = std::make_shared<const World>(World{tiny.build(), {0}, {0}, {}, {}});
  return keep_run(make_experiment(
      parse_scenario(
          "greatx: 1\nname: test\nticks: 1\ntick_rate_hz: 10\nnodes:\n  - name: a\n"
          "    trajectory: {type: waypoints, interpolation: linear, points: [{t_s: 0, position_m: [0, 0, "
          "0]}, {t_s: 1, position_m: [" +
              std::to_string(speed_m_s) +
              ", 0, 0]}]}\n    sensors: [{name: radar, type: radar, rate_hz: 10, transmit: {columns: 1}, "
              "outputs: [range_doppler], waveform: " +
              waveform + "}]\n",
          "test.yaml", "."),
      std::move(world)));
}

TEST(RadarRun, AliasesAreWarnedOf) {
  // Spans of 30 m (5 MHz a step or a carrier), v_max of 7.6 m/s (128 us a sweep).
  const std::string steps = "{type: stepped, step_hz: 5e6, steps: 128, step_s: 1e-6, sweeps: 32}";
  const KeptRun both = run_closing(steps, 9.0);
  ASSERT_EQ(both.statistics.warnings.size(), 2u);
  EXPECT_THAT(both.statistics.warnings[0], HasSubstr("radar 'a/radar': "));
  EXPECT_THAT(both.statistics.warnings[0], HasSubstr("echoes alias in range: the farthest is at 40."));
  EXPECT_THAT(both.statistics.warnings[0], HasSubstr("the range span of its waveform is 30.0 m"));
  EXPECT_THAT(both.statistics.warnings[1], HasSubstr("alias in velocity: the fastest has 9.00 m/s"));
  EXPECT_THAT(both.statistics.warnings[1], HasSubstr("v_max of its waveform is 7.60 m/s"));
  EXPECT_EQ(run_closing(steps, 5.0).statistics.warnings.size(), 1u);
  // Symbols of 2 us: 45 m, 487 m/s.
  const std::string symbols =
      "{type: ofdm, spacing_hz: 3.3e6, subcarriers: 64, prefix_s: 0.3e-6, symbols: 64}";
  EXPECT_TRUE(run_closing(symbols, 9.0).statistics.warnings.empty());
}

}  // namespace
}  // namespace greatx::sim
