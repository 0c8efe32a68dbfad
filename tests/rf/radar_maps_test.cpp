// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/rf/radar_support.h"

namespace greatx::rf {
namespace {

using testing::dbm_of;
using testing::frame_of;
using testing::peak_of;
using testing::point_echo;
using testing::set_row;
using testing::small_radar;
using testing::whole_frame;

/// Returns a radar with 4 x 4 antennas, 200 MHz over 250 samples (187 m) and 32 chirps of each transmitter
/// (up to 4.06 m/s).
RadarSignalConfig long_range_radar() {
  RadarSignalConfig config;
  config.waveform.slope_hz_per_s = 4e12;
  config.waveform.samples = 250;
  config.waveform.sample_rate_hz = 5e6;
  config.waveform.chirp_s = 55e-6;
  config.waveform.slots = 128;
  set_row(config, 4, 4);
  return config;
}

/// Returns the echo of a target whose tone is at these bins. Doppler is counted in turns.
Echo at_bins(const RadarSignalConfig& config, double range_bins, double turns) {
  const RadarWaveform& w = config.waveform;
  const double nu = turns / (w.chirps() * w.repetition_s());
  const double tau = (range_bins / w.sampled_s() - nu) / w.slope_hz_per_s;
  Echo echo = point_echo(config, 0.5 * speed_of_light * tau, 0.0);
  echo.delay.coefficients[1] = nu / (w.carrier_hz - w.slope_hz_per_s * tau);
  return echo;
}

TEST(RadarChain, RadarEquationToAHundredthOfADecibel) {
  // For 12 dBm, 12 dBi, 1 m^2, 77 GHz and 100 m, P_r = P_t G^2 lambda^2 sigma/((4 pi)^3 R^4) = -125.1697 dBm.
  // The test covers echo, cube, transforms and detection.
  RadarSignalConfig config = long_range_radar();
  const double gain = from_decibels(12.0);
  for (const double velocity : {0.0, 3.21, -3.7})
    for (const double azimuth : {0.0, 0.4}) {
      const RadarFrame frame =
          frame_of(config, {whole_frame(config, {point_echo(config, 100.0, velocity, azimuth, 0, 1, gain)})},
                   {1, 2, 3}, gain);
      double mean = 0.0;
      for (const auto& sample : frame.cube)
        mean += std::norm(std::complex<double>(sample)) / double(frame.cube.size());
      EXPECT_NEAR(dbm_of(mean), -125.1697, 1e-3);
      ASSERT_GE(frame.detections.size(), 1u);
      const auto strongest =
          std::max_element(frame.detections.begin(), frame.detections.end(),
                           [](const auto& a, const auto& b) { return a.power_w < b.power_w; });
      EXPECT_NEAR(dbm_of(strongest->power_w), -125.1697, 0.01) << velocity << " " << azimuth;
      EXPECT_NEAR(decibels(strongest->rcs_m2), 0.0, 0.01);
      EXPECT_NEAR(strongest->range_m, 100.0, 2e-3);
      EXPECT_NEAR(strongest->velocity_m_s, velocity, 2e-3);
      EXPECT_NEAR(strongest->azimuth, azimuth, 2e-3);
      EXPECT_EQ(strongest->instance, 1u);
    }
}

TEST(RadarChainHardCase, N62_AtABinsCentreBetweenBinsAndBeyondTheSpan) {
  RadarSignalConfig config = small_radar();
  set_row(config, 2, 1);
  for (const RadarWindow window : {RadarWindow::rectangular, RadarWindow::hann, RadarWindow::taylor}) {
    config.processing.range_window = config.processing.doppler_window = window;
    const RadarMaps maps(config);
    const uint32_t chirps = config.waveform.chirps(), zero = chirps / 2;
    const auto map_of = [&](double range_bins, double turns, double& power) {
      const Echo echo = at_bins(config, range_bins, turns);
      power = std::norm(echo.amplitude) * config.transmit_power_w;
      return maps.range_doppler(maps.spectrum(testing::cube_of(config, whole_frame(config, {echo})), 0), 0);
    };
    double power;
    // At the centre of a bin, this bin shows the received power.
    auto map = map_of(20.0, 0.0, power);
    EXPECT_EQ(peak_of(map), 20 * chirps + zero);
    EXPECT_NEAR(decibels(map[peak_of(map)] / power), 0.0, 1e-4);
    // Between two bins, both show the scalloping loss.
    map = map_of(20.5, 0.0, power);
    const double loss = decibels(maps.range_window().scalloping_loss());
    EXPECT_NEAR(decibels(map[20 * chirps + zero] / power), -loss, 1e-3);
    EXPECT_NEAR(decibels(map[21 * chirps + zero] / power), -loss, 1e-3);
    map = map_of(20.0, 4.5, power);  // moves by a small part of a bin during the frame
    EXPECT_NEAR(decibels(map[20 * chirps + zero + 4] / power),
                -decibels(maps.doppler_window().scalloping_loss()), 0.02);
    EXPECT_NEAR(decibels(map[20 * chirps + zero + 5] / power),
                -decibels(maps.doppler_window().scalloping_loss()), 0.02);
    // Beyond v_max, the turns alias by a multiple of the chirps; beyond R_max, the bin aliases by a multiple
    // of the samples.
    map = map_of(20.0, chirps / 2 + 3, power);
    EXPECT_EQ(peak_of(map), 20 * chirps + 3);  // -chirps/2 + 3 turns
    map = map_of(20.0, -int(chirps) - 2, power);
    EXPECT_EQ(peak_of(map), 20 * chirps + zero - 2);
    map = map_of(config.waveform.samples + 7.0, 1.0, power);
    EXPECT_EQ(peak_of(map), 7 * chirps + zero + 1);
  }
}

TEST(RadarChain, DetectionsBeyondTheSpanReadTheDocumentedAlias) {
  RadarSignalConfig config = small_radar();
  set_row(config, 1, 1);
  const RadarWaveform& w = config.waveform;
  const double span = w.velocity_span_m_s();
  const auto detection = [&](double range, double velocity) {
    const auto frame = frame_of(config, {whole_frame(config, {point_echo(config, range, velocity)})});
    return *std::max_element(frame.detections.begin(), frame.detections.end(),
                             [](const auto& a, const auto& b) { return a.power_w < b.power_w; });
  };
  auto found = detection(30.0, 0.5 * span + 1.0);
  EXPECT_NEAR(found.velocity_m_s, -0.5 * span + 1.0, 0.01);
  // The measured velocity corrects the range; an aliased velocity leaves an error of f_c/S times the velocity
  // error.
  EXPECT_NEAR(found.range_m, 30.0 + w.carrier_hz / w.slope_hz_per_s * span, 0.01);
  found = detection(w.range_span_m() + 30.0, 2.0);
  EXPECT_NEAR(found.range_m, 30.0, 0.01);
  EXPECT_NEAR(found.velocity_m_s, 2.0, 0.01);
}

TEST(RadarChain, RecedingTargetsHavePositiveVelocities) {
  RadarSignalConfig config = small_radar();
  const RadarAxes axes = radar_axes(config);
  for (const double velocity : {4.0, -4.0}) {
    const auto frame = frame_of(config, {whole_frame(config, {point_echo(config, 30.0, velocity)})});
    EXPECT_NEAR(axes.velocity_m_s[peak_of(frame.range_doppler) % axes.velocity_m_s.size()], velocity,
                0.5 * config.waveform.velocity_bin_m_s() + 1e-9);
  }
}

TEST(RadarChain, ProcessingGainIsSamplesTimesChirpsOverNoiseBandwidths) {
  RadarSignalConfig config = small_radar();
  config.receiver.noise_figure_db = 10.0;
  config.waveform.slots = 128;
  for (const RadarWindow window : {RadarWindow::rectangular, RadarWindow::hann}) {
    config.processing.range_window = config.processing.doppler_window = window;
    const RadarMaps maps(config);
    const double per_sample = noise_power_w(config.waveform.sample_rate_hz, 10.0);
    const auto frame = frame_of(config, {});
    double mean = 0.0;
    for (const float cell : frame.range_doppler) mean += cell / double(frame.range_doppler.size());
    const double bandwidths = maps.range_window().noise_bandwidth() * maps.doppler_window().noise_bandwidth();
    const double expected = per_sample * bandwidths / (64.0 * 64.0);
    // The map averages 4 antennas and 64 x 64 cells; the bandwidths reduce the number of independent cells.
    // The significance is 1e-5.
    EXPECT_LT(std::abs(mean / expected - 1.0) * std::sqrt(4 * 64.0 * 64.0 / bandwidths), 4.42);
    // A target at the centre of a bin gains 10 log10(N M) minus the noise bandwidths of the windows.
    const Echo echo = at_bins(config, 30.0, 5.0);
    const double in = std::norm(echo.amplitude) * config.transmit_power_w / per_sample;
    RadarSignalConfig silent = config;
    silent.receiver.noise_figure_db.reset();
    const auto target = frame_of(silent, {whole_frame(silent, {echo})});
    const double out = target.range_doppler[peak_of(target.range_doppler)] / expected;
    EXPECT_NEAR(decibels(out / in), decibels(64.0 * 64.0 / bandwidths), 0.01);
  }
}

TEST(RadarChain, RangeAzimuthShowsPowerAndDirectionWhateverTheVelocity) {
  RadarSignalConfig config = small_radar();
  set_row(config, 2, 4);
  config.processing.azimuths = 181;
  for (const double velocity : {0.0, 5.3, -7.1}) {
    const Echo echo = point_echo(config,
                                 40 * config.waveform.range_bin_m() -
                                     config.waveform.carrier_hz * velocity / config.waveform.slope_hz_per_s,
                                 velocity, radians(20.0));
    const auto frame = frame_of(config, {whole_frame(config, {echo})});
    EXPECT_EQ(peak_of(frame.range_azimuth), 40 * 181 + 110u);
    EXPECT_NEAR(
        decibels(frame.range_azimuth[40 * 181 + 110] / (std::norm(echo.amplitude) * config.transmit_power_w)),
        0.0, 0.05);
  }
}

TEST(RadarChain, RotorsFrequencyFromATable) {
  // A row of a table describes the tip of a blade. The frequency from chirp to chirp varies by 2 r
  // omega/lambda at the frequency of the rotor.
  RadarSignalConfig config = small_radar();
  set_row(config, 1, 1);
  config.waveform.samples = 16;
  config.waveform.sample_rate_hz = 16 / 20e-6;
  config.waveform.chirp_s = 26e-6;
  config.waveform.interval_s = 30e-6;
  config.waveform.slots = 4096;  // 0.12 s
  EchoList list = whole_frame(config, {});
  Echo echo = point_echo(config, 5.0, 0.0);
  echo.delay = {};
  echo.delay.table = 0;
  list.echoes.push_back(echo);
  const double rotor_hz = 65.0, radius = 0.06, omega = 2 * pi * rotor_hz;
  for (uint32_t s = 0; s < list.slots; ++s) {
    const double angle = omega * s * config.waveform.interval_s;
    list.tables.push_back({2 / speed_of_light * (5.0 + radius * std::sin(angle)),
                           2 / speed_of_light * radius * omega * std::cos(angle)});
  }
  const auto cube = testing::cube_of(config, list);
  // Returns the spectral line at `hz` of the frequency from chirp to chirp.
  const auto line = [&](double hz) {
    std::complex<double> sum = 0.0;
    for (uint32_t s = 0; s + 1 < list.slots; ++s) {
      const size_t i = size_t{s} * 16 + 8;
      const double doppler =
          std::arg(cube[i + 16] * std::conj(cube[i])) / (2 * pi * config.waveform.interval_s);
      sum += doppler * std::polar(2.0 / (list.slots - 1), -2 * pi * hz * s * config.waveform.interval_s);
    }
    return std::abs(sum);
  };
  const double peak_hz = 2 * radius * omega / config.waveform.wavelength_m();
  ASSERT_LT(peak_hz, 0.5 / config.waveform.interval_s);
  double best = 0.0, at = 0.0;
  for (double hz = 20; hz < 200; hz += 0.25)
    if (const double value = line(hz); value > best) best = value, at = hz;
  EXPECT_NEAR(at, rotor_hz, 0.5);
  EXPECT_NEAR(best / peak_hz, 1.0, 0.01);
}

}  // namespace
}  // namespace greatx::rf
