// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests Doppler-division multiplexing, and what the receiver takes from its own transmitters.
#include <cmath>

#include <gtest/gtest.h>

#include "rf/radar/signal/demultiplex.h"
#include "tests/rf/radar_waveforms.h"

namespace greatx::rf {
namespace {

using testing::all_radars;
using testing::dbm_of;
using testing::frame_of;
using testing::point_echo;
using testing::radar_of;
using testing::small_ramps;
using testing::strongest;
using testing::whole_frame;

TEST(RadarDdm, AStaticSceneHasTheMapsOfTdm) {
  RadarSignalConfig tdm = radar_of(small_ramps(), 3, 2, 8), ddm = radar_of(small_ramps(), 3, 2, 32, 1);
  for (RadarSignalConfig* config : {&tdm, &ddm}) config->processing.detections = false;
  for (RadarSignalConfig* config : {&tdm, &ddm})
    config->processing.range_window = config->processing.doppler_window = RadarWindow::rectangular;
  RandomStream random(5, 6);
  std::vector<Echo> echoes;
  for (int i = 0; i < 12; ++i) {
    echoes.push_back(point_echo(tdm, random.uniform(3.0, 80.0), 0.0, random.uniform(-1.0, 1.0)));
    echoes.back().amplitude = std::polar(1e-5, random.uniform(-pi, pi));
  }
  const auto spectrum = [&](const RadarSignalConfig& config) {
    return RadarMaps(config).spectrum(frame_of(config, {whole_frame(config, echoes)}).cube, 0);
  };
  const auto a = spectrum(tdm), b = spectrum(ddm);
  double largest = 0.0, worst = 0.0;
  for (size_t v = 0; v < 6; ++v)
    for (size_t range = 0; range < 64; ++range) {
      const std::complex<float> x = a[(v * 64 + range) * 8 + 4], y = b[(v * 64 + range) * 32 + 16];
      largest = std::max<double>(largest, std::abs(x));
      worst = std::max<double>(worst, std::abs(x - y));
    }
  EXPECT_LT(worst, 3e-5 * largest);
  // The range-azimuth maps sum over the velocities.
  const RadarFrame c = frame_of(tdm, {whole_frame(tdm, echoes)}),
                   d = frame_of(ddm, {whole_frame(ddm, echoes)});
  const float top = *std::max_element(c.range_azimuth.begin(), c.range_azimuth.end());
  for (size_t i = 0; i < c.range_azimuth.size(); ++i)
    EXPECT_NEAR(c.range_azimuth[i], d.range_azimuth[i], 1e-4f * top);
}

TEST(RadarDdm, TheWholeDopplerBandIsUnambiguous) {
  for (const uint32_t empty : {1u, 2u})
    for (const double share : {-0.95, -0.6, -0.3, 0.1, 0.45, 0.7, 0.96}) {
      RadarSignalConfig config = radar_of(small_ramps(), 3, 4, 24 * (3 + empty), empty);
      config.receiver.noise_figure_db = 10.0;
      const double v_max = 0.5 * config.waveform.velocity_span_m_s();
      EXPECT_NEAR(v_max, config.waveform.wavelength_m() / (4.0 * config.waveform.interval_s), 1e-9);
      Echo echo = point_echo(config, 30.0, share * v_max, 0.3, 0.0, 10.0);
      const RadarFrame frame = frame_of(config, {whole_frame(config, {echo})});
      ASSERT_EQ(frame.detections.size(), 1u) << share;
      EXPECT_NEAR(frame.detections[0].velocity_m_s, share * v_max, 0.1 * config.waveform.velocity_bin_m_s());
      EXPECT_NEAR(frame.detections[0].azimuth, 0.3, 0.02);
      EXPECT_NEAR(dbm_of(frame.detections[0].power_w),
                  dbm_of(config.transmit_power_w * std::norm(echo.amplitude)), 1.0);
    }
}

TEST(RadarDdm, NoiseGivesNoMoreAlarmsThanRequested) {
  RadarSignalConfig config = radar_of(small_ramps(), 3, 2, 64, 1);
  config.receiver.noise_figure_db = 10.0;
  config.processing.range_azimuth = false;
  config.processing.cfar.false_alarm = 0.01;
  size_t alarms = 0, cells = 0;
  const RadarMaps maps(config);
  RadarCfar cfar_config = config.processing.cfar;
  cfar_config.false_alarm /= 4.0;
  const double rise = noise_rise(config.waveform, 2);
  EXPECT_GT(rise, 1.1);
  const Cfar cfar(cfar_config, maps.range_window(), Window(config.processing.doppler_window, 16), 6, rise);
  double noise_w = 0.0;
  for (uint32_t frame = 0; frame < 60; ++frame) {
    const RadarFrame noise = frame_of(config, {whole_frame(config, {})}, {1, 2, frame});
    const auto folded = folded_map(config.waveform, noise.range_doppler);
    for (uint32_t range = 0; range < 64; ++range) {
      const Cfar::Row row = cfar.row(folded, range);
      for (uint32_t k = 0; k < 16; ++k, ++cells) {
        alarms += folded[range * 16 + k] > row.noise_w[k] * row.factor;
        noise_w += row.noise_w[k];
      }
    }
  }
  const double share = double(alarms) / double(cells);
  EXPECT_LT(share, 0.01);
  EXPECT_GT(share, 0.004);
  // The noise of a cell is that of all slots: k T_0 f_s F with the windows' bandwidths over N M.
  const double bandwidths = maps.range_window().noise_bandwidth() * maps.doppler_window().noise_bandwidth();
  EXPECT_NEAR(decibels(noise_w / double(cells)),
              decibels(noise_power_w(config.waveform.sample_rate_hz, 10.0) * bandwidths / (64.0 * 64.0)),
              0.1);
}

TEST(RadarDdm, TransmittersTogetherHaveThePowerOfEach) {
  // Each transmitter sends transmit_power_w all the time: with as many slots of the same length, the noise in
  // a virtual antenna is lower by the number of transmitters than with TDM.
  RadarSignalConfig tdm = radar_of(small_ramps(), 3, 2, 16), ddm = radar_of(small_ramps(), 3, 2, 48, 1);
  for (RadarSignalConfig* config : {&tdm, &ddm}) config->receiver.noise_figure_db = 10.0;
  ASSERT_EQ(tdm.waveform.slots, ddm.waveform.slots);
  EXPECT_NEAR(hidden_ratio(tdm) / hidden_ratio(ddm), 3.0, 1e-9);
  const Echo echo = point_echo(tdm, 30.0, 0.0, 0.0, 0.0, 1e4);
  const RadarFrame a = frame_of(tdm, {whole_frame(tdm, {echo})}),
                   b = frame_of(ddm, {whole_frame(ddm, {echo})});
  EXPECT_NEAR(dbm_of(strongest(a).power_w), dbm_of(strongest(b).power_w), 0.3);
  EXPECT_GT(decibels(strongest(b).snr / strongest(a).snr), 2.0);
}

TEST(RadarLeakage, IsAToneAtItsLengthWithItsLevel) {
  for (auto [name, config] : all_radars(16, 1023)) {
    const RadarWaveform& w = config.waveform;
    config.processing.range_window = config.processing.doppler_window = RadarWindow::rectangular;
    // Twice the range of bin 3: the whole way.
    config.receiver.leakage = RadarLeakage{-43.0, 6.0 * w.range_bin_m()};
    const RadarFrame frame = frame_of(config, {whole_frame(config, {})});
    const double power = config.transmit_power_w * from_decibels(-43.0);
    EXPECT_NEAR(dbm_of(frame.range_doppler[3 * w.chirps() + w.chirps() / 2]), dbm_of(power), 0.01) << name;
    ASSERT_GE(frame.detections.size(), 1u) << name;
    EXPECT_NEAR(strongest(frame).range_m, 3.0 * w.range_bin_m(), 0.01 * w.range_bin_m()) << name;
    EXPECT_NEAR(strongest(frame).velocity_m_s, 0.0, 0.01 * w.velocity_bin_m_s()) << name;
    EXPECT_EQ(strongest(frame).instance, 0u) << name;
    // It is the same for every pair of elements: straight ahead.
    EXPECT_NEAR(strongest(frame).azimuth, 0.0, 1e-4) << name;
  }
}

TEST(RadarLeakage, PhaseNoiseGrowsWithItsLength) {
  // The variance of the phase is 2 pi f_p L_0 (1 - e^{-2 pi f_p tau}).
  for (const double length_m : {3.0, 30.0}) {
    RadarSignalConfig config = radar_of(small_ramps(), 1, 1, 512);
    config.receiver.phase_noise = PhaseNoise{-90.0, 1e6};
    config.receiver.leakage = RadarLeakage{-30.0, length_m};
    config.processing.detections = config.processing.range_azimuth = config.processing.range_doppler = false;
    const RadarCube noisy = frame_of(config, {whole_frame(config, {})}).cube;
    config.receiver.phase_noise.reset();
    const RadarCube clean = frame_of(config, {whole_frame(config, {})}).cube;
    double variance = 0.0;
    for (size_t i = 0; i < noisy.size(); ++i)
      variance += std::pow(std::arg(std::complex<double>(noisy[i]) / std::complex<double>(clean[i])), 2) /
                  double(noisy.size());
    const double expected =
        2.0 * pi * 1e6 * 1e-9 * (1.0 - std::exp(-2.0 * pi * 1e6 * length_m / speed_of_light));
    EXPECT_NEAR(decibels(variance), decibels(expected), 0.6) << length_m;
  }
}

}  // namespace
}  // namespace greatx::rf
