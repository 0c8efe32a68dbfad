// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks noise, mismatch, refractory period and bandwidth against their laws. The draws are fixed, so that a
// test always passes or always fails. A limit of 4 standard deviations would reject one in 16 000 fair draws.
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/renderer/event_rig.h"

namespace greatx::test {
namespace {

using render::EventDesc;
using render::EventFrame;

constexpr int64_t ms = 1'000'000;
constexpr double limit = 4.0;  ///< standard deviations

struct Count {
  size_t on = 0, off = 0;
  std::vector<size_t> by_pixel;
  size_t all() const { return on + off; }
};

Count count(const std::vector<EventFrame>& frames, uint32_t width, uint32_t height) {
  Count c;
  c.by_pixel.resize(size_t(width) * height);
  for (const EventFrame& frame : frames)
    for (size_t i = 0; i < frame.size(); ++i) {
      ++(frame.p[i] ? c.on : c.off);
      ++c.by_pixel[size_t(frame.y[i]) * width + frame.x[i]];
    }
  return c;
}

TEST(EventNoise, ShotNoiseIsPoissonAtTheStatedRate) {
  constexpr uint32_t w = 64, h = 64;
  for (const double luminance : {0.0, 300.0, 5000.0})
    for (const uint32_t substeps : {1u, 4u}) {
      EventDesc desc = plain_events(w, h, 0.2);
      desc.substeps = substeps;
      desc.shot_rate_hz = 12.0;
      desc.seed = 7;
      desc.stream = 3;
      EventRig rig(desc, [&](uint32_t, uint32_t, double) { return luminance; });
      const std::vector<EventFrame> frames = rig.run(50 * ms, 21);
      const Count c = count(frames, w, h);
      const double intensity = std::min(1.0, (255.0 * luminance / 1000.0 + 20.0) / 275.0);
      const double rate = 12.0 * (1.0 - 0.75 * intensity), expected = rate * 1.0 * w * h;
      EXPECT_LT(std::abs(double(c.all()) - expected) / std::sqrt(expected), limit) << luminance;
      EXPECT_LT(std::abs(double(c.on) - double(c.off)) / std::sqrt(expected), limit) << luminance;
      // The index of dispersion over pixels is chi-square with w h - 1 degrees of freedom.
      double chi = 0.0;
      const double mean = double(c.all()) / (w * h);
      for (const size_t n : c.by_pixel) chi += std::pow(double(n) - mean, 2) / mean;
      const double freedom = w * h - 1;
      EXPECT_LT(std::abs(chi - freedom) / std::sqrt(2.0 * freedom), limit) << luminance;
      // Times are uniform over the interval, also across the boundaries of steps.
      std::vector<double> bins(20);
      for (const EventFrame& frame : frames)
        for (const uint32_t t : frame.t_ns) ++bins[std::min<size_t>(19, (t - 1) / (5 * ms / 2))];
      double uniform = 0.0;
      for (const double n : bins) uniform += std::pow(n - double(c.all()) / 20, 2) / (double(c.all()) / 20);
      EXPECT_LT(std::abs(uniform - 19.0) / std::sqrt(38.0), limit + 1.0) << luminance;
    }
}

TEST(EventNoise, DrawsDependOnSeedSensorAndSequenceAlone) {
  EventDesc desc = plain_events(32, 32, 0.2);
  desc.shot_rate_hz = 30.0;
  const auto times = [&](uint64_t seed, uint32_t stream, uint32_t sequence) {
    desc.seed = seed;
    desc.stream = stream;
    EventRig rig(desc, [](uint32_t, uint32_t, double) { return 1.0; });
    return rig.run(50 * ms, 3, sequence)[2].t_ns;
  };
  const std::vector<uint32_t> base = times(1, 2, 0);
  EXPECT_FALSE(base.empty());
  EXPECT_EQ(base, times(1, 2, 0));
  EXPECT_NE(base, times(2, 2, 0));
  EXPECT_NE(base, times(1, 3, 0));
  EXPECT_NE(base, times(1, 2, 1));
}

TEST(EventNoise, LeakGivesOnEventsAtItsRateAndNotInStep) {
  constexpr uint32_t w = 64, h = 32;
  EventDesc desc = plain_events(w, h, 0.2);
  desc.threshold_sigma = 0.04;  // the rate does not depend on the threshold of the pixel
  desc.leak_rate_hz = 3.3;
  desc.substeps = 3;
  EventRig rig(desc, [](uint32_t, uint32_t, double) { return 50.0; });
  const std::vector<EventFrame> frames = rig.run(100 * ms, 21);
  const Count c = count(frames, w, h);
  EXPECT_EQ(c.off, 0u);
  // 6.6 events per pixel are expected: 6 or 7, depending on the phase of the pixel.
  const double mean = 3.3 * 2.0, fraction = mean - std::floor(mean);
  for (const size_t n : c.by_pixel) EXPECT_TRUE(n == 6 || n == 7) << n;
  EXPECT_LT(std::abs(double(c.all()) - mean * w * h) / std::sqrt(fraction * (1 - fraction) * w * h), limit);
  // Phases are uniform; so the counts over the intervals are uniform, too.
  double chi = 0.0;
  const double expected = double(c.all()) / 20;
  for (size_t k = 1; k < frames.size(); ++k)
    chi += std::pow(double(frames[k].size()) - expected, 2) / expected;
  EXPECT_LT(chi, 19.0 + limit * std::sqrt(38.0));
  // The events of one pixel are 1 / rate apart.
  for (const uint32_t x : {0u, 13u, 63u}) {
    const std::vector<PixelEvent> events = events_of(frames, 100 * ms, x, 7);
    for (size_t i = 1; i < events.size(); ++i)
      EXPECT_NEAR(1e-9 * double(events[i].t_ns - events[i - 1].t_ns), 1.0 / 3.3, 2e-5);
  }
}

TEST(EventNoise, MismatchIsGaussianAndStays) {
  constexpr uint32_t w = 80, h = 60;
  EventDesc desc = plain_events(w, h, 0.2);
  desc.threshold_sigma = 0.03;
  desc.substeps = 4;
  // The logarithm rises by 16, then falls by 16: about 80 events of each polarity per pixel.
  EventRig rig(desc, [](uint32_t, uint32_t, double t) {
    return std::exp(t < 0.1 ? 160.0 * t - 8.0 : 24.0 - 160.0 * t);
  });
  std::vector<size_t> up(w * h), down(w * h);
  const std::vector<EventFrame> frames = rig.run(10 * ms, 21);
  for (const EventFrame& frame : frames)
    for (size_t i = 0; i < frame.size(); ++i) ++(frame.p[i] ? up : down)[size_t(frame.y[i]) * w + frame.x[i]];
  // On the way down, the reference starts below the signal, by half a threshold on average.
  const auto path = [&](const std::vector<size_t>& counts) { return &counts == &up ? 16.0 : 15.9; };
  const auto statistics = [&](const std::vector<size_t>& counts) {
    double mean = 0.0, square = 0.0;
    for (const size_t n : counts) {
      const double c = path(counts) / (double(n) + 0.5);
      mean += c / (w * h);
      square += c * c / (w * h);
    }
    return std::pair(mean, std::sqrt(square - mean * mean));
  };
  for (const std::vector<size_t>* counts : {&up, &down}) {
    const auto [mean, sigma] = statistics(*counts);
    EXPECT_NEAR(mean, 0.2, limit * 0.03 / std::sqrt(w * h) + 2e-4);
    EXPECT_NEAR(sigma, 0.03, limit * 0.03 / std::sqrt(2.0 * w * h) + 3e-4);
  }
  // ON and OFF thresholds are drawn independently.
  double covariance = 0.0;
  const auto [mean_up, sigma_up] = statistics(up);
  const auto [mean_down, sigma_down] = statistics(down);
  for (size_t i = 0; i < up.size(); ++i)
    covariance +=
        (16.0 / (double(up[i]) + 0.5) - mean_up) * (16.0 / (double(down[i]) + 0.5) - mean_down) / (w * h);
  EXPECT_LT(std::abs(covariance) / (sigma_up * sigma_down) * std::sqrt(w * h), limit);
}

TEST(EventNoise, ThresholdsAreBoundedBelow) {
  EventDesc desc = plain_events(64, 64, 0.02);
  desc.threshold_sigma = 0.02;
  EventRig rig(desc, [](uint32_t, uint32_t, double t) { return std::exp(100.0 * t); });
  const Count c = count(rig.run(10 * ms, 2), 64, 64);
  EXPECT_EQ(*std::ranges::max_element(c.by_pixel), 100u);  // 1 / 0.01
}

TEST(EventNoise, RefractoryPixelsRest) {
  EventDesc desc = plain_events(48, 48, 0.2);
  desc.shot_rate_hz = 400.0;
  desc.refractory_s = 2.5e-3;
  desc.substeps = 3;
  EventRig rig(desc, [](uint32_t, uint32_t, double) { return 0.0; });
  const std::vector<EventFrame> frames = rig.run(20 * ms, 26);
  std::vector<int64_t> last(48 * 48, -1);
  size_t events = 0;
  for (size_t k = 1; k < frames.size(); ++k)
    for (size_t i = 0; i < frames[k].size(); ++i, ++events) {
      int64_t& before = last[size_t(frames[k].y[i]) * 48 + frames[k].x[i]];
      const int64_t t = int64_t(k - 1) * 20 * ms + frames[k].t_ns[i];
      EXPECT_TRUE(before < 0 || t - before >= 2500000);
      before = t;
    }
  // A Poisson process with a dead time has the rate r / (1 + r dead), and its variance is smaller by (1 + r
  // dead)^2 (Mueller 1973).
  const double rate = 400.0 * (1.0 - 0.75 * 20.0 / 275.0), slow = 1.0 + rate * 2.5e-3;
  const double expected = rate / slow * 0.5 * 48 * 48;
  // All pixels are awake at the beginning.
  const double start = 0.5 * std::pow(rate * 2.5e-3 / slow, 2) * 48 * 48;
  EXPECT_LT(std::abs(double(events) - expected - start) / std::sqrt(expected / (slow * slow)), limit + 1.0);
}

TEST(EventNoise, RefractoryCrossingsAreLostNotDelayed) {
  // One fast edge crosses 20 thresholds within 1 ms, and the pixel is dead for 10 ms: it sends one event, and
  // none when it wakes up. It sees a later edge of one threshold again.
  EventDesc desc = plain_events(1, 1, 0.1);
  desc.refractory_s = 0.01;
  EventRig rig(desc, [](uint32_t, uint32_t, double t) {
    return std::exp(std::min(t / 1e-3, 1.0) * 2.05 + (t > 0.0295 ? 0.1 : 0.0));
  });
  const std::vector<PixelEvent> events = events_of(rig.run(1 * ms, 40), ms, 0, 0);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].t_ns, 48781);  // 0.1 / 2.05 of a millisecond
  EXPECT_GT(events[1].t_ns, 29 * ms);
}

TEST(EventNoise, BandwidthSlowsByBrightness) {
  // A first-order low pass delays a step of ten thresholds: event k comes at -tau ln(1 - k / 10.5). The time
  // constant tau is shorter in bright light.
  for (const double luminance : {20.0, 2000.0}) {
    EventDesc desc = plain_events(1, 1, 0.1);
    desc.cutoff_hz = 30.0;
    desc.substeps = 16;
    EventRig rig(
        desc, [&](uint32_t, uint32_t, double t) { return t > 0 ? luminance * std::exp(1.05) : luminance; });
    const std::vector<PixelEvent> events = events_of(rig.run(10 * ms, 30), 10 * ms, 0, 0);
    const double intensity = std::min(1.0, (255.0 * luminance * std::exp(1.05) / 1000.0 + 20.0) / 275.0);
    const double tau = 1.0 / (2.0 * pi * 30.0 * intensity);
    ASSERT_EQ(events.size(), 10u);
    for (size_t k = 1; k <= 10; ++k)
      EXPECT_NEAR(1e-9 * double(events[k - 1].t_ns), -tau * std::log(1.0 - double(k) / 10.5),
                  0.02 * tau + 4e-4)
          << luminance << " " << k;
  }
}

}  // namespace
}  // namespace greatx::test
