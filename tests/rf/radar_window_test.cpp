// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "rf/radar/signal/window.h"
#include "tests/rf/radar_support.h"

namespace greatx::rf {
namespace {

constexpr RadarWindow all_windows[] = {RadarWindow::rectangular, RadarWindow::hann, RadarWindow::hamming,
                                       RadarWindow::blackman, RadarWindow::taylor};

TEST(RadarWindow, FiguresOfHarrisTable1) {
  struct Row {
    RadarWindow kind;
    double gain, bandwidth, scalloping_db;
  };
  // F. J. Harris, table 1. The table rounds the values of Hamming and Blackman (1.36, 1.73); here they are
  // those of the closed form.
  for (const Row& row : {Row{RadarWindow::rectangular, 1.0, 1.0, 3.9224},
                         {RadarWindow::hann, 0.5, 1.5, 1.4236},
                         {RadarWindow::hamming, 0.54, 1.362826, 1.7514},
                         {RadarWindow::blackman, 0.42, 1.726757, 1.0986}}) {
    const Window window(row.kind, 1024);
    EXPECT_NEAR(window.coherent_gain(), row.gain, 1e-12);
    EXPECT_NEAR(window.noise_bandwidth(), row.bandwidth, 1e-6);
    EXPECT_NEAR(decibels(window.scalloping_loss()), row.scalloping_db, 2e-3);
  }
}

TEST(RadarWindow, TaylorsSidelobesLieAtMinus35) {
  const Window window(RadarWindow::taylor, 256);
  double highest = 0.0;
  for (double bins = 2.6; bins < 128; bins += 0.01) highest = std::max(highest, window.power(bins));
  EXPECT_NEAR(decibels(highest), -35.0, 0.4);
}

TEST(RadarWindow, ResponseIsTheTransform) {
  for (const RadarWindow kind : all_windows)
    for (const uint32_t size : {8u, 33u, 64u})
      for (const double bins : {0.0, 0.3, -0.5, 1.0, 2.75, -7.1, 31.6, 64.0, 65.2, -128.0}) {
        const Window window(kind, size);
        std::complex<double> sum = 0.0;
        double total = 0.0;
        for (uint32_t n = 0; n < size; ++n) {
          sum += double(window.values()[n]) * std::polar(1.0, 2 * pi * bins * (double(n) - size / 2) / size);
          total += window.values()[n];
        }
        EXPECT_LT(std::abs(window.response(bins) - sum / total), 1e-6) << size << " " << bins;
      }
}

TEST(RadarWindow, PeakOffsetIsExactForATone) {
  for (const RadarWindow kind : all_windows) {
    const Window window(kind, 128);
    for (double offset = -0.5; offset <= 0.5; offset += 0.03125)
      EXPECT_NEAR(
          window.peak_offset(window.power(offset + 1), window.power(offset), window.power(offset - 1)),
          offset, 1e-8);
  }
  EXPECT_EQ(Window(RadarWindow::hann, 16).peak_offset(0.0, 0.0, 0.0), 0.0);
}

}  // namespace
}  // namespace greatx::rf
