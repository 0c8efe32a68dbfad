// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks events on the GPU, from luminance given by a formula, against closed forms.
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/renderer/event_rig.h"

namespace greatx::test {
namespace {

using render::EventDesc;
using render::EventFrame;
using render::EventSteps;

constexpr int64_t millisecond_ns = 1'000'000;

size_t total(const std::vector<EventFrame>& frames) {
  size_t sum = 0;
  for (const EventFrame& frame : frames) sum += frame.size();
  return sum;
}

void expect_same(const std::vector<EventFrame>& a, const std::vector<EventFrame>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].t_ns, b[k].t_ns) << k;
    EXPECT_EQ(a[k].x, b[k].x) << k;
    EXPECT_EQ(a[k].y, b[k].y) << k;
    EXPECT_EQ(a[k].p, b[k].p) << k;
    EXPECT_EQ(a[k].difference, b[k].difference) << k;
  }
}

TEST(Events, RampHasTheExactCountAndTimes) {
  // With ln L = 8 + slope t, event k is at k C / |slope|. 35 columns make more than two runs of pixels, the
  // last one shorter.
  const auto slope = [](uint32_t column, uint32_t row) {
    return (double(column) - 17.0) * (row == 0 ? 0.7 : 2.3);
  };
  for (const double c : {0.1, 0.25})
    for (const uint32_t substeps : {1u, 4u}) {
      EventDesc desc = plain_events(35, 2, c);
      desc.substeps = substeps;
      EventRig rig(desc, [&](uint32_t x, uint32_t y, double t) { return std::exp(8.0 + slope(x, y) * t); });
      const std::vector<EventFrame> frames = rig.run(33 * millisecond_ns, 4);
      EXPECT_EQ(frames[0].size(), 0u);
      for (uint32_t row = 0; row < 2; ++row)
        for (uint32_t column = 0; column < 35; ++column) {
          const double s = slope(column, row);
          const double change = rig.signal(column, row, 0.099) - rig.signal(column, row, 0.0);
          const std::vector<PixelEvent> events = events_of(frames, 33 * millisecond_ns, column, row);
          ASSERT_EQ(events.size(), std::floor(std::abs(change) / c + 1e-6)) << column << " " << row;
          for (size_t k = 0; k < events.size(); ++k) {
            EXPECT_EQ(events[k].on, s > 0);
            // The tolerance covers two logarithms and k thresholds rounded to 2^-24.
            EXPECT_NEAR(1e-9 * double(events[k].t_ns), double(k + 1) * c / std::abs(s),
                        1e-9 + (7e-7 + 6e-8 * double(k + 1)) / std::abs(s));
          }
        }
    }
}

TEST(Events, TenthsAddUpToOne) {
  // A step from 1 to e crosses ten thresholds of 0.1. A sum in single precision would find only nine.
  EventRig rig(plain_events(1, 1, 0.1),
               [](uint32_t, uint32_t, double t) { return (t > 0 ? 2.7182818 : 1.0) - 1e-6; });
  EXPECT_EQ(total(rig.run(10 * millisecond_ns, 3)), 10u);
}

TEST(Events, ReconstructionStaysWithinOneThreshold) {
  EventDesc desc = plain_events(50, 40, 0.2);
  desc.threshold_on = 0.17;
  desc.threshold_off = 0.23;
  desc.substeps = 3;
  const auto luminance = [](uint32_t x, uint32_t y, double t) {
    return std::exp(4.0 + 2.0 * std::sin(0.3 * x + 0.7 * y + 40.0 * t) + std::sin(0.11 * x * y - 90.0 * t));
  };
  EventRig rig(desc, luminance);
  const std::vector<EventFrame> frames = rig.run(20 * millisecond_ns, 12);
  std::vector<double> level(50 * 40);
  for (uint32_t y = 0; y < 40; ++y)
    for (uint32_t x = 0; x < 50; ++x) level[y * 50 + x] = rig.signal(x, y, 0.0);
  for (size_t k = 1; k < frames.size(); ++k) {
    const EventFrame& frame = frames[k];
    for (size_t i = 0; i < frame.size(); ++i)
      level[size_t(frame.y[i]) * 50 + frame.x[i]] += frame.p[i] ? 0.17 : -0.23;
    for (uint32_t y = 0; y < 40; ++y)
      for (uint32_t x = 0; x < 50; ++x) {
        const double error = rig.signal(x, y, 0.02 * double(k)) - level[y * 50 + x];
        EXPECT_LT(error, 0.17 + 2e-6) << x << " " << y << " " << k;
        EXPECT_GT(error, -0.23 - 2e-6) << x << " " << y << " " << k;
      }
  }
  EXPECT_GT(total(frames), 50u * 40u * 20u);
}

TEST(Events, HardCaseN56StreamIsInOrderOfTimeRowColumnPolarity) {
  EventDesc desc = plain_events(70, 20, 0.05);
  desc.substeps = 4;
  desc.shot_rate_hz = 200.0;
  EventRig rig(desc,
               [](uint32_t x, uint32_t y, double t) { return std::exp(2 + 20 * t * ((x / 5 + y) % 3)); });
  for (const EventFrame& frame : rig.run(10 * millisecond_ns, 5)) {
    size_t ties = 0;
    for (size_t i = 1; i < frame.size(); ++i) {
      const auto key = [&](size_t j) {
        return std::tuple(frame.t_ns[j], frame.y[j], frame.x[j], frame.p[j]);
      };
      EXPECT_LE(key(i - 1), key(i));
      ties += frame.t_ns[i] == frame.t_ns[i - 1];
    }
    EXPECT_TRUE(frame.size() == 0 || ties > 100) << ties;
  }
}

TEST(Events, HalvingTheStepQuartersTheErrorOfTimes) {
  // A grating moves and brightens: ln L rises all the time, but not linearly.
  constexpr double c = 0.15;
  const auto signal = [](double x, double t) { return 2.0 + 100.0 * t + 0.9 * std::sin(60.0 * t + 0.8 * x); };
  const auto exact = [&](double x, double level) {
    double low = 0.0, high = 0.2;
    for (int i = 0; i < 100; ++i) (signal(x, 0.5 * (low + high)) < level ? low : high) = 0.5 * (low + high);
    return low;
  };
  std::vector<double> errors;
  for (const uint32_t substeps : {1u, 2u, 4u, 8u, 16u}) {
    EventDesc desc = plain_events(16, 1, c);
    desc.substeps = substeps;
    EventRig rig(desc, [&](uint32_t x, uint32_t, double t) { return std::exp(signal(x, t)); });
    const std::vector<EventFrame> frames = rig.run(40 * millisecond_ns, 4);
    double sum = 0.0;
    size_t count = 0;
    for (uint32_t x = 0; x < 16; ++x) {
      const std::vector<PixelEvent> events = events_of(frames, 40 * millisecond_ns, x, 0);
      EXPECT_EQ(events.size(), std::floor((signal(x, 0.12) - signal(x, 0.0)) / c)) << x;
      for (size_t k = 0; k < events.size(); ++k, ++count)
        sum += std::pow(1e-9 * double(events[k].t_ns) - exact(x, signal(x, 0) + double(k + 1) * c), 2);
    }
    errors.push_back(std::sqrt(sum / double(count)));
  }
  // The error of a chord is of second order.
  for (size_t i = 1; i < errors.size(); ++i)
    EXPECT_THAT(errors[i - 1] / errors[i], testing::AllOf(testing::Ge(i == 1 ? 2.5 : 3.4), testing::Le(4.8)))
        << i << ": " << errors[i];
  EXPECT_LT(errors.back(), 2e-5);
}

TEST(Events, HardCaseN53BlackToBlackGivesNoEvent) {
  EventDesc desc = plain_events(33, 3, 0.01);
  desc.substeps = 2;
  EventRig rig(desc, [](uint32_t, uint32_t, double t) { return t > 0.015 ? 0.0 : -0.0; });
  EXPECT_EQ(total(rig.run(10 * millisecond_ns, 6)), 0u);
}

TEST(Events, HardCaseN54ExactlyOnTheThresholdFiresOnce) {
  // ln 2 and the threshold are the same fixed-point number, bit for bit. The luminance steps are 1, 2, 2, 4,
  // 2.
  EventDesc desc = plain_events(1, 1, double(shared::fixed_log(2.0f)) / shared::log_one);
  desc.dark_cd_m2 = 1e-6;
  const auto levels = [](uint32_t, uint32_t, double t) {
    constexpr double steps[] = {1 - 1e-6, 2 - 1e-6, 2 - 1e-6, 4 - 1e-6, 2 - 1e-6};
    return steps[std::min<size_t>(size_t(t * 100 + 0.5), 4)];
  };
  EventRig rig(desc, levels);
  std::vector<size_t> counts;
  for (const EventFrame& frame : rig.run(10 * millisecond_ns, 5)) counts.push_back(frame.size());
  EXPECT_THAT(counts, testing::ElementsAre(0, 1, 0, 1, 1));
}

TEST(Events, HardCaseN55StillPicturesGiveNothing) {
  EventDesc desc = plain_events(40, 4, 0.01);
  desc.substeps = 4;
  desc.cutoff_hz = 100.0;
  EventRig rig(desc, [](uint32_t x, uint32_t y, double) { return std::exp(0.3 * x - y); });
  EXPECT_EQ(total(rig.run(10 * millisecond_ns, 4)), 0u);
}

TEST(Events, OverflowIsCountedAndKeepsTheFirst) {
  EventDesc desc = plain_events(40, 10, 0.1);
  desc.substeps = 2;
  const auto luminance = [](uint32_t x, uint32_t, double t) { return std::exp(3 + 0.01 * x + 80 * t); };
  const std::vector<EventFrame> whole = EventRig(desc, luminance).run(10 * millisecond_ns, 3);
  desc.capacity = 1000;
  const std::vector<EventFrame> cut = EventRig(desc, luminance).run(10 * millisecond_ns, 3),
                                again = EventRig(desc, luminance).run(10 * millisecond_ns, 3);
  expect_same(cut, again);
  for (size_t k = 1; k < 3; ++k) {
    EXPECT_EQ(whole[k].dropped, 0u);
    EXPECT_EQ(cut[k].size(), 1000u);
    EXPECT_EQ(cut[k].size() + cut[k].dropped, whole[k].size());
    EXPECT_EQ(std::ranges::count_if(cut[k].t_ns, [](uint32_t t) { return t > 5 * millisecond_ns; }), 0);
  }
}

TEST(Events, DifferenceImageHasThreeValues) {
  EventDesc desc = plain_events(7, 3, 0.2);
  desc.events = false;
  desc.differences = true;
  desc.difference_on_cd_m2 = 10.0;
  desc.difference_off_cd_m2 = 20.0;
  // The luminance changes by -30, -20, ..., 30 cd/m^2 between samples, independently of the brightness of the
  // row.
  EventRig rig(desc, [](uint32_t x, uint32_t y, double t) {
    return 1000.0 * (y + 1) + 10.0 * (double(x) - 3.0) * std::round(t * 100);
  });
  const std::vector<EventFrame> frames = rig.run(10 * millisecond_ns, 3);
  EXPECT_THAT(frames[0].difference, testing::Each(0));
  for (size_t k = 1; k < 3; ++k)
    for (uint32_t y = 0; y < 3; ++y)
      EXPECT_THAT(std::vector<int8_t>(frames[k].difference.begin() + 7 * y,
                                      frames[k].difference.begin() + 7 * (y + 1)),
                  testing::ElementsAre(-1, -1, 0, 0, 1, 1, 1));
}

TEST(Events, AdaptiveStepsByBrightness) {
  // The signal is calm, then crosses 60 thresholds within about 30 ms, then is calm again.
  const auto luminance = [](uint32_t x, uint32_t, double t) {
    return std::exp(3.0 + 0.001 * x + 6.0 / (1.0 + std::exp(-(t - 0.055) * 200.0)) + t);
  };
  EventDesc desc = plain_events(40, 4, 0.1);
  desc.substeps = 16;
  const std::vector<EventFrame> fixed = EventRig(desc, luminance).run(20 * millisecond_ns, 6);
  desc.steps = EventSteps::by_brightness;
  desc.wanted = 1e-6;  // never reached: every instant is rendered, and nothing differs
  const std::vector<EventFrame> all = EventRig(desc, luminance).run(20 * millisecond_ns, 6);
  expect_same(fixed, all);
  desc.wanted = 2.0;
  const std::vector<EventFrame> some = EventRig(desc, luminance).run(20 * millisecond_ns, 6);
  expect_same(some, EventRig(desc, luminance).run(20 * millisecond_ns, 6));
  EXPECT_EQ(all[2].pictures, 16u);
  EXPECT_EQ(some[1].pictures, 5u);  // without a history the steps are 1, 2, 4, 8 and the rest
  EXPECT_LE(some[2].pictures, 4u);
  EXPECT_GE(some[3].pictures, 10u);
  EXPECT_LE(some[5].pictures, 8u);
  EXPECT_LT(some[1].pictures + some[2].pictures + some[3].pictures + some[4].pictures + some[5].pictures,
            40u);
  // The change comes gradually, so that pictures are never much too far apart.
  for (size_t k = 1; k < some.size(); ++k) EXPECT_LT(some[k].largest, 5.0) << k;
  EXPECT_GT(some[3].coarse, 0u);
  for (size_t k = 1; k < some.size(); ++k)  // the level follows the signal for any steps
    EXPECT_EQ(some[k].size(), fixed[k].size()) << k;
}

TEST(Events, BadValuesAreNamed) {
  const auto message = [](auto change) {
    EventDesc desc = plain_events(4, 4, 0.2);
    change(desc);
    try {
      EventRig rig(desc, [](uint32_t, uint32_t, double) { return 1.0; });
    } catch (const UserError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  using testing::HasSubstr;
  EXPECT_THAT(message([](EventDesc& d) { d.threshold_on = 0.0; }),
              HasSubstr("threshold: expected 0.01 to 1, found 0"));
  EXPECT_THAT(message([](EventDesc& d) { d.substeps = 0; }), HasSubstr("steps"));
  EXPECT_THAT(message([](EventDesc& d) { d.capacity = 0; }), HasSubstr("max_events_per_pixel"));
  EXPECT_THAT(message([](EventDesc& d) { d.shot_rate_hz = -1.0; }), HasSubstr("shot_rate_hz"));
  if (device().limits().maxStorageBufferRange / 8 < 16384u * 16384u) {
    EXPECT_THAT(message([](EventDesc& d) { d.width = d.height = 16384; }),
                HasSubstr("width, height: expected at most"));
  }
}

}  // namespace
}  // namespace greatx::test
