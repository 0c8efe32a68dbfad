// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "rf/radar/signal/delay.h"
#include "tests/rf/radar_support.h"

namespace greatx::rf {
namespace {

using ::testing::HasSubstr;
using testing::small_radar;

TEST(RadarWaveform, DerivedFigures) {
  RadarWaveform w;
  w.slope_hz_per_s = 20e12;
  w.samples = 250;
  w.sample_rate_hz = 5e6;  // 50 us, 1 GHz
  EXPECT_NEAR(w.bandwidth_hz(), 1e9, 1e-3);
  EXPECT_NEAR(w.range_bin_m(), 0.149896229, 1e-9);
  EXPECT_NEAR(w.range_span_m(), speed_of_light * 5e6 / (2 * 20e12), 1e-9);  // f_s c/2S
  EXPECT_EQ(w.chirps(), 128u);
  EXPECT_NEAR(w.repetition_s(), 240e-6, 1e-15);
  EXPECT_NEAR(w.velocity_span_m_s(), w.wavelength_m() / (2 * 240e-6), 1e-12);
  EXPECT_NEAR(w.velocity_bin_m_s() * 128, w.velocity_span_m_s(), 1e-12);
}

TEST(RadarWaveform, AxesOfMaps) {
  const RadarSignalConfig config = small_radar();
  const RadarAxes axes = radar_axes(config);
  EXPECT_EQ(axes.range_m.size(), 64u);
  EXPECT_DOUBLE_EQ(axes.range_m[5], 5 * config.waveform.range_bin_m());
  EXPECT_DOUBLE_EQ(axes.velocity_m_s[0], -config.waveform.velocity_span_m_s() / 2);
  EXPECT_DOUBLE_EQ(axes.velocity_m_s[16], 0.0);
  EXPECT_DOUBLE_EQ(axes.azimuth.front(), -pi / 2);
  EXPECT_DOUBLE_EQ(axes.azimuth.back(), pi / 2);
}

template <typename Change>
std::string fault_of(const Change& change) {
  RadarSignalConfig config = small_radar();
  change(config);
  const auto fault = check(config);
  return fault ? fault->field + ": " + fault->message : "";
}

TEST(RadarConfig, FaultsNameFieldExpectationAndFinding) {
  EXPECT_EQ(fault_of([](auto&) {}), "");
  EXPECT_EQ(fault_of([](auto& c) { c.waveform.chirp_s = 61e-6; }),
            "waveform.chirp_s: expected a chirp no longer than the interval from one to the next, 6e-05 s; "
            "found 6.1e-05 s");
  EXPECT_EQ(fault_of([](auto& c) { c.waveform.chirp_s = c.waveform.interval_s; }), "");
  EXPECT_THAT(fault_of([](auto& c) { c.waveform.samples = 128; }),
              HasSubstr("waveform.samples: expected samples that fit"));
  EXPECT_EQ(fault_of([](auto& c) { c.waveform.slots = 1; }),
            "waveform.chirps: expected at least one slot for each of 2 transmitters, which send one at a "
            "time; found 1");
  EXPECT_EQ(fault_of([](auto& c) { c.waveform.slots = 63; }),
            "waveform.chirps: expected a multiple of the 2 transmitters, found 63");
  EXPECT_THAT(fault_of([](auto& c) { c.waveform.carrier_hz = 0; }),
              HasSubstr("waveform.carrier_hz: expected a number above 0"));
  EXPECT_THAT(fault_of([](auto& c) { c.waveform.slope_hz_per_s = NAN; }),
              HasSubstr("waveform.slope_hz_per_s"));
  EXPECT_THAT(fault_of([](auto& c) { c.arrays.transmit_m.pop_back(); }),
              HasSubstr("expected the waveform's 2 transmitters"));
  EXPECT_THAT(fault_of([](auto& c) { c.arrays.receive_m.clear(); }), HasSubstr("at least one receiver"));
  EXPECT_THAT(fault_of([](auto& c) { c.receiver.noise_figure_db = -1.0; }),
              HasSubstr("receiver.noise_figure_db"));
  EXPECT_THAT(fault_of([](auto& c) {
                c.receiver.adc = AnalogToDigital{1, -30};
              }),
              HasSubstr("receiver.adc.bits"));
  EXPECT_THAT(fault_of([](auto& c) { c.processing.cfar.false_alarm = 0.0; }),
              HasSubstr("processing.cfar.false_alarm"));
  EXPECT_THAT(fault_of([](auto& c) { c.processing.cfar.train_doppler = 30; }),
              HasSubstr("processing.cfar.train_doppler"));
}

TEST(RadarEchoes, TargetInsideTheAntennaIsRefusedByName) {
  const RadarSignalConfig config = small_radar();
  Echo echo = testing::point_echo(config, 0.002, 0.0);
  echo.instance = 7;
  const auto list = testing::whole_frame(config, {echo});
  try {
    check_echoes(list, config, "front");
    FAIL() << "accepted";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("radar 'front': a target (instance 7) stands inside the antenna"));
  }
  echo.delay.coefficients[0] = NAN;
  EXPECT_THROW(check_echoes(testing::whole_frame(config, {echo}), config, "front"), UserError);
  EXPECT_NO_THROW(
      check_echoes(testing::whole_frame(config, {testing::point_echo(config, 0.1, 0.0)}), config, "front"));
}

TEST(RadarEchoes, TablesAreReadAsCubicsBetweenSlots) {
  // The tip of a rotor with a radius of 0.15 m at 100 Hz is interpolated between slots of 60 us to 1e-9 m.
  const double omega = 2 * pi * 100, interval = 60e-6;
  const auto delay = [&](double t) { return (2 / speed_of_light) * (20 + 0.15 * std::cos(omega * t)); };
  const auto rate = [&](double t) { return -(2 / speed_of_light) * 0.15 * omega * std::sin(omega * t); };
  EchoList list{32, 64, {}, {}};
  for (uint32_t s = 0; s < 64; ++s)
    list.tables.push_back({delay((32 + s) * interval), rate((32 + s) * interval)});
  DelayTrack track;
  track.table = 0;
  for (double slot = 32.0; slot < 96.0; slot += 0.37) {
    const DelayAt at = delay_at(list, track, interval, slot * interval);
    const double tolerance_m = slot < 95.0 ? 1e-9 : 3e-8;  // extrapolated after the start of the last slot
    EXPECT_NEAR(at.delay_s * speed_of_light / 2, delay(slot * interval) * speed_of_light / 2, tolerance_m)
        << slot;
    EXPECT_NEAR(at.rate * speed_of_light / 2, rate(slot * interval) * speed_of_light / 2, tolerance_m / 5e-6)
        << slot;
  }
}

}  // namespace
}  // namespace greatx::rf
