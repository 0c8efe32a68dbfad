// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests what ramps of other radars do to a radar with ramps.
#include <cmath>

#include <gtest/gtest.h>

#include "rf/radar/signal/interference.h"
#include "tests/rf/radar_waveforms.h"

namespace greatx::rf {
namespace {

using testing::dbm_of;
using testing::frame_of;
using testing::radar_of;
using testing::small_ramps;
using testing::whole_frame;

/// Returns another radar 60 m away whose ramps cover the band of `config`.
Interferer interferer_of(const RadarSignalConfig& config, double slope_ratio) {
  Interferer other;
  other.waveform = config.waveform;
  other.waveform.slope_hz_per_s = slope_ratio * config.waveform.slope_hz_per_s;
  other.waveform.transmitters = 1;
  other.waveform.slots = config.waveform.slots;
  other.arrays = config.arrays;
  other.arrays.transmit_m.resize(1);
  other.power_w = 0.01;
  other.amplitude = {3e-6, 2e-6};
  other.departure = {-1.0, 0.0, 0.0};
  other.arrival = {0.96, 0.28, 0.0};
  other.delay_s = 200e-9;
  other.rate = 1e-7;
  other.mid_s = 50e-6;
  other.phase_turns = 0.3;
  other.start_s = 0.4e-6;
  other.slots = config.waveform.slots;
  return other;
}

RadarCube cube_with(const RadarSignalConfig& config, const Interferer& other, InterferenceReport& report,
                    uint32_t threads = 0) {
  RadarCube cube(config.arrays.receive_m.size() * config.waveform.slots * config.waveform.samples);
  report = add_interference(config, other, {}, threads, cube);
  return cube;
}

TEST(RadarInterference, SamplesAreThoseOfBothOscillators) {
  // The reference multiplies the two signals at each sample, in fp64, and asks at each of them whether the
  // difference of the frequencies is within the band.
  RadarSignalConfig config = radar_of(small_ramps(), 2, 2, 6);
  const RadarWaveform& w = config.waveform;
  for (const double ratio : {1.0, 0.4, -1.0, 3.0}) {
    Interferer other = interferer_of(config, ratio);
    other.waveform.transmitters = 2;
    other.arrays = config.arrays;
    InterferenceReport report;
    const RadarCube cube = cube_with(config, other, report);
    const RadarWaveform& o = other.waveform;
    uint64_t hit = 0;
    for (uint32_t slot = 0; slot < w.slots; ++slot)
      for (uint32_t r = 0; r < 2; ++r)
        for (uint32_t n = 0; n < w.samples; ++n) {
          const double t = w.slot_start_s(slot) + w.adc_start_s + n / w.sample_rate_hz;
          const double lead_r = glm::dot(other.arrival, config.arrays.receive_m[r]) / speed_of_light;
          std::complex<double> expected = 0.0;
          for (uint32_t k = 0; k < o.slots; ++k) {
            const double lead =
                lead_r + glm::dot(other.departure, other.arrays.transmit_m[k % 2]) / speed_of_light;
            const double sent = t - (other.delay_s + other.rate * (t - other.mid_s)) + lead - other.start_s -
                                k * o.interval_s;
            if (sent < 0.0 || sent >= o.chirp_s) continue;
            const double u = t - w.slot_middle_s(slot), v = sent - o.slot_middle_s(0);
            const double beat = w.carrier_hz + w.slope_hz_per_s * u - (o.carrier_hz + o.slope_hz_per_s * v);
            if (std::abs(beat) >= 0.5 * w.sample_rate_hz) continue;
            const double turns = w.carrier_hz * u + 0.5 * w.slope_hz_per_s * u * u - o.carrier_hz * v -
                                 0.5 * o.slope_hz_per_s * v * v + other.phase_turns;
            expected += std::conj(other.amplitude) * std::sqrt(other.power_w) *
                        std::polar(1.0, 2.0 * pi * (turns - std::nearbyint(turns)));
            ++hit;
          }
          const std::complex<double> found = cube[size_t{w.row(r, slot)} * w.samples + n];
          EXPECT_LT(std::abs(found - expected), 1e-4 * std::abs(other.amplitude) * std::sqrt(other.power_w))
              << ratio << " " << slot << " " << n;
        }
    EXPECT_EQ(report.samples, hit) << ratio;
  }
}

TEST(RadarInterference, ABurstHasTheEnergyOfItsCrossing) {
  // Each crossing lasts f_s/|S - S_i|; its energy is the received power times that.
  for (const double ratio : {-1.0, -0.25, 0.5, 1.75}) {
    RadarSignalConfig config = radar_of(small_ramps(), 1, 1, 400);
    RadarWaveform& w = config.waveform;
    w.sample_rate_hz = 4e6;
    w.slope_hz_per_s = 1e13;
    w.samples = 64;  // 16 us
    Interferer other = interferer_of(config, ratio);
    other.rate = 0.0;
    InterferenceReport report;
    const RadarCube cube = cube_with(config, other, report);
    double energy = 0.0;
    for (const auto& sample : cube) energy += std::norm(std::complex<double>(sample)) / w.sample_rate_hz;
    const double power = other.power_w * std::norm(other.amplitude);
    const double burst =
        power * w.sample_rate_hz / std::abs(w.slope_hz_per_s - other.waveform.slope_hz_per_s);
    // One crossing in each slot, to one sample.
    EXPECT_NEAR(energy / (400 * burst), 1.0, 1.0 / (burst / power * w.sample_rate_hz)) << ratio;
    EXPECT_NEAR(report.energy_w_s, energy, 1e-4 * energy);
  }
}

TEST(RadarInterference, EqualRampsAreAGhost) {
  // A synchronous radar with the same ramps is a target at half the way, with its one-way power.
  RadarSignalConfig config = radar_of(small_ramps(), 1, 2, 32);
  Interferer other = interferer_of(config, 1.0);
  other.start_s = 0.0;
  other.rate = 0.0;
  other.delay_s = 2.0 * 17.3 / speed_of_light;
  const std::vector<Interferer> others{other};
  const std::vector<EchoList> lists{whole_frame(config, {})};
  const std::vector<RadarAttitude> attitudes(1);
  const RadarProcessor processor("front", config, testing::isotropic, testing::isotropic);
  const RadarFrame frame = processor.process({lists, attitudes, {}, {1, 2, 3}, others});
  ASSERT_GE(frame.detections.size(), 1u);
  EXPECT_NEAR(testing::strongest(frame).range_m, 17.3, 0.02);
  EXPECT_NEAR(dbm_of(testing::strongest(frame).power_w), dbm_of(other.power_w * std::norm(other.amplitude)),
              0.02);
  EXPECT_NEAR(std::sin(testing::strongest(frame).azimuth), 0.28, 0.01);
  ASSERT_EQ(frame.report.interference.size(), 1u);
  EXPECT_EQ(frame.report.interference[0].samples, 2u * 32 * 64);
}

TEST(RadarInterference, BytesDoNotDependOnThreads) {
  RadarSignalConfig config = radar_of(small_ramps(), 2, 3, 16);
  const Interferer other = interferer_of(config, 0.3);
  InterferenceReport one, many;
  EXPECT_EQ(cube_with(config, other, one, 1), cube_with(config, other, many, 5));
  EXPECT_EQ(one.samples, many.samples);
  EXPECT_EQ(one.energy_w_s, many.energy_w_s);
  EXPECT_GT(one.samples, 0u);
}

}  // namespace
}  // namespace greatx::rf
