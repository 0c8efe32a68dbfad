// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the codes of phase-modulated radars and what they make of a range profile.
#include <cmath>

#include <gtest/gtest.h>

#include "rf/radar/signal/codes.h"
#include "tests/rf/radar_waveforms.h"

namespace greatx::rf {
namespace {

using testing::frame_of;
using testing::radar_of;
using testing::whole_frame;

TEST(RadarCodes, MSequencesHaveTheirAutocorrelation) {
  for (uint32_t k = 5; k <= 16; ++k) {
    const uint32_t n = (1u << k) - 1;
    const std::vector<float> chips = code_chips(RadarCode::m_sequence, n);
    ASSERT_EQ(chips.size(), n);
    for (uint32_t shift = 1; shift < n; shift += k < 12 ? 1 : 997) {
      int sum = 0;
      for (uint32_t i = 0; i < n; ++i) sum += static_cast<int>(chips[i] * chips[(i + shift) % n]);
      ASSERT_EQ(sum, -1) << k << " " << shift;
    }
  }
}

TEST(RadarCodes, AlmostPerfectSequencesHaveTheirAutocorrelation) {
  for (const uint32_t n : {16u, 28u, 64u, 124u, 256u, 1000u, 1020u, 2044u}) {
    ASSERT_TRUE(code_exists(RadarCode::apas, n));
    const std::vector<float> chips = code_chips(RadarCode::apas, n);
    for (uint32_t shift = 0; shift < n; ++shift) {
      int sum = 0;
      for (uint32_t i = 0; i < n; ++i) sum += static_cast<int>(chips[i] * chips[(i + shift) % n]);
      const int expected = shift == 0 ? static_cast<int>(n) : shift == n / 2 ? 4 - static_cast<int>(n) : 0;
      ASSERT_EQ(sum, expected) << n << " " << shift;
    }
  }
  for (const uint32_t n : {17u, 20u, 32u, 100u}) EXPECT_FALSE(code_exists(RadarCode::apas, n)) << n;
}

TEST(RadarCodes, TheRangeProfileIsTheAutocorrelation) {
  for (const RadarCode code : {RadarCode::m_sequence, RadarCode::apas}) {
    RadarSignalConfig config = radar_of(testing::small_code(code), 1, 1, 16);
    config.processing.range_window = config.processing.doppler_window = RadarWindow::rectangular;
    const RadarWaveform& w = config.waveform;
    const double bin = w.range_bin_m();
    const Echo echo = testing::point_echo(config, 9.0 * bin, 0.0);
    const RadarFrame frame = frame_of(config, {whole_frame(config, {echo})});
    const std::vector<float> chips = code_chips(code, w.samples);
    const double power = config.transmit_power_w * std::norm(echo.amplitude);
    for (uint32_t k = 0; k < w.samples; ++k) {
      double correlation = 0.0;
      for (uint32_t i = 0; i < w.samples; ++i)
        correlation += chips[i] * chips[(i + k + w.samples - 9) % w.samples] / double(w.samples);
      EXPECT_NEAR(std::sqrt(frame.range_doppler[k * w.chirps() + w.chirps() / 2] / power),
                  std::abs(correlation), 2e-5)
          << k;
    }
  }
}

TEST(RadarCodes, AveragesLowerTheNoise) {
  for (const uint32_t averages : {1u, 8u}) {
    RadarSignalConfig config = radar_of(testing::small_code(RadarCode::m_sequence, averages), 1, 1, 256);
    config.receiver.noise_figure_db = 10.0;
    const RadarCube cube = frame_of(config, {whole_frame(config, {})}).cube;
    double mean = 0.0;
    for (const auto& sample : cube) mean += std::norm(std::complex<double>(sample)) / double(cube.size());
    EXPECT_NEAR(decibels(mean), decibels(noise_power_w(100e6 / averages, 10.0)), 0.15);
  }
}

}  // namespace
}  // namespace greatx::rf
