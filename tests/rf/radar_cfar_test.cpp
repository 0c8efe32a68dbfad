// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/rf/radar_support.h"

namespace greatx::rf {
namespace {

TEST(RadarCfar, FactorsOfOneLookAreTheClosedForms) {
  for (const double cells : {8.0, 24.0, 37.5})
    EXPECT_NEAR(cell_averaging_factor(cells, 1, 1e-6) / (cells * (std::pow(1e-6, -1 / cells) - 1)), 1.0,
                1e-10);
  // The product formula for Rohling's case of 24 cells, the 18th value and P_fa = 1e-6.
  const double t = ordered_statistic_factor(24, 18, 1, 1e-6);
  double product = 1.0;
  for (int i = 0; i < 18; ++i) product *= (24.0 - i) / (24.0 - i + t);
  EXPECT_NEAR(product / 1e-6, 1.0, 1e-9);
}

TEST(RadarCfar, FactorsOfManyLooksHoldTheirProbability) {
  // With draws of Gamma(looks), counts how often noise exceeds the threshold, at a significance of 1e-5.
  RandomStream random(11, 1);
  const uint32_t looks = 3, cells = 12, rank = 9;
  const auto draw = [&] {
    double sum = 0.0;
    for (uint32_t i = 0; i < looks; ++i) sum -= std::log(1.0 - random.uniform());
    return sum / looks;
  };
  const double p = 0.02;
  const double average = cell_averaging_factor(cells, looks, p),
               ordered = ordered_statistic_factor(cells, rank, looks, p);
  const int trials = 40000;
  int by_average = 0, by_order = 0;
  double statistic = 0.0;
  for (int i = 0; i < trials; ++i) {
    double cell = draw(), sum = 0.0, values[12];
    for (double& value : values) sum += value = draw();
    std::sort(values, values + cells);
    by_average += cell > average * sum / cells;
    by_order += cell > ordered * values[rank - 1];
    statistic += values[rank - 1] / trials;
  }
  const double deviation = std::sqrt(trials * p * (1 - p));
  EXPECT_LT(std::abs(by_average - trials * p) / deviation, 4.42);
  EXPECT_LT(std::abs(by_order - trials * p) / deviation, 4.42);
  EXPECT_NEAR(statistic, ordered_statistic_mean(cells, rank, looks), 0.01);
}

/// Returns the share of cells above their thresholds in frames of pure noise, and the number of cells.
std::pair<double, double> alarms(const RadarSignalConfig& config, int frames, bool edges) {
  const RadarMaps maps(config);
  const Cfar cfar(config.processing.cfar, maps.range_window(), maps.doppler_window(), 4);
  const uint32_t ranges = config.waveform.samples, velocities = config.waveform.chirps();
  const uint32_t reach = config.processing.cfar.guard_range + config.processing.cfar.train_range;
  double count = 0.0, cells = 0.0;
  RadarCube cube(4 * ranges * velocities);
  for (int f = 0; f < frames; ++f) {
    std::fill(cube.begin(), cube.end(), 0.0f);
    add_noise({21, 1, static_cast<uint32_t>(f)}, 1e-12, 0, cube);
    const auto map = maps.range_doppler(maps.spectrum(cube, 0), 0);
    for (uint32_t r = 0; r < ranges; ++r) {
      if (edges != (r < reach || r + reach >= ranges)) continue;
      const Cfar::Row row = cfar.row(map, r);
      for (uint32_t d = 0; d < velocities; ++d)
        count += map[r * velocities + d] > row.noise_w[d] * row.factor;
      cells += velocities;
    }
  }
  return {count / cells, cells};
}

TEST(RadarCfar, FalseAlarmsOfNoiseComeAtTheirRate) {
  RadarSignalConfig config = testing::small_radar();
  config.processing.range_window = config.processing.doppler_window = RadarWindow::rectangular;
  config.processing.cfar.false_alarm = 0.01;
  for (const auto kind : {RadarCfar::Kind::cell_averaging, RadarCfar::Kind::ordered_statistic}) {
    config.processing.cfar.kind = kind;
    for (const bool edges : {false, true}) {
      const auto [share, cells] = alarms(config, kind == RadarCfar::Kind::cell_averaging ? 60 : 12, edges);
      // Cells that share training cells have slightly correlated alarms: the bound is half as wide again as
      // for independent cells.
      EXPECT_LT(std::abs(share - 0.01) / std::sqrt(0.01 * 0.99 / cells), 1.5 * 4.42) << edges << " " << share;
    }
  }
}

TEST(RadarCfar, WindowsThatCorrelateCellsKeepTheRate) {
  // With few training cells, their correlation matters: if they were counted as independent, half as many
  // alarms again would pass. The effective number of cells is correct to second order: the rate is within a
  // quarter.
  RadarSignalConfig config = testing::small_radar();
  config.processing.cfar.false_alarm = 0.002;
  config.processing.cfar.train_range = config.processing.cfar.train_doppler = 1;
  for (const RadarWindow window : {RadarWindow::hann, RadarWindow::taylor}) {
    config.processing.range_window = config.processing.doppler_window = window;
    const auto [share, cells] = alarms(config, 100, false);
    EXPECT_NEAR(share, 0.002, 0.0005) << cells;
  }
}

TEST(RadarCfar, OnePeakForEachGroup) {
  RadarSignalConfig config = testing::small_radar();
  const RadarMaps maps(config);
  const Cfar cfar(config.processing.cfar, maps.range_window(), maps.doppler_window(), 4);
  std::vector<float> map(64 * 32, 1.0f);
  map[10 * 32 + 5] = map[10 * 32 + 6] = 50.0f;  // equal values: the first one is the peak
  map[11 * 32 + 6] = 49.0f;
  // These cells are neighbours across the end of the Doppler axis, at the end of the range axis.
  map[63 * 32 + 31] = map[63 * 32 + 0] = 30.0f;
  const auto peaks = cfar.peaks(map, 0);
  ASSERT_EQ(peaks.size(), 2u);
  EXPECT_EQ(peaks[0].range, 10u);
  EXPECT_EQ(peaks[0].velocity, 5u);
  EXPECT_EQ(peaks[0].noise_w, 1.0);
  EXPECT_EQ(peaks[1].range, 63u);
  EXPECT_EQ(peaks[1].velocity, 0u);
}

}  // namespace
}  // namespace greatx::rf
