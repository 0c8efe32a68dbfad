// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs the shader source of an event camera's pixel on the CPU and checks it against closed forms.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"
#include "renderer/event/event_sort.h"
#include "shaders/shared/events.h"

namespace greatx::shared {
namespace {

constexpr double unit = 1.0 / log_one;
int32_t fixed(double x) { return static_cast<int32_t>(std::floor(x * log_one)); }

TEST(EventModel, LogarithmIsRightToThreeTenMillionths) {
  double worst = 0.0;
  for (int i = 0; i < 400000; ++i) {
    const float x = static_cast<float>(std::exp(-20.0 + i * (60.0 / 400000.0)));
    worst = std::max(worst, std::abs(fixed_log(x) * unit - std::log(double(x))));
  }
  EXPECT_LT(worst, 5 * unit);
  for (const float x : {1.0f, 2.0f, 0.5f, 1.41421354f, 1.41421366f, 1e-6f, 3e38f})
    EXPECT_NEAR(fixed_log(x) * unit, std::log(double(x)), 5 * unit) << x;
  EXPECT_EQ(fixed_log(1.0f), 0);
  for (float x = 0.5f; x < 2.0f; x = std::nextafter(x, 3.0f) + 1e-5f)
    EXPECT_LE(fixed_log(x), fixed_log(std::nextafter(x, 3.0f))) << x;
}

TEST(EventModel, RampGivesAsManyEventsAsThresholdsFit) {
  for (const double c : {0.1, 0.25, 1.0 / 3.0})
    for (const double change : {0.05, 0.1, 0.25, 1.0, 1.24, 2.0, 7.5}) {
      const int32_t on = fixed(c);
      EXPECT_EQ(count_crossings(0, fixed(change), on, on), std::floor(change / c + 1e-9))
          << c << " " << change;
      EXPECT_EQ(count_crossings(0, -fixed(change), on, on), -std::floor(change / c + 1e-9))
          << c << " " << change;
    }
}

TEST(EventModel, ManyThresholdsAddUpExactly) {
  // Ten thresholds of 0.1 make 1, a million times over. With floats, one event of the first ten is already
  // lost.
  const int32_t on = fixed(0.1);
  int32_t reference = 0;
  int64_t ups = 0, downs = 0;
  for (int i = 0; i < 1000000; ++i) {
    const int up = count_crossings(reference, log_one, on, on);
    reference += up * on;
    const int down = count_crossings(reference, 0, on, on);
    reference += down * on;
    ups += up;
    downs -= down;
  }
  EXPECT_EQ(ups, 10000000 - 0);
  EXPECT_EQ(downs, 10000000 - 0);
  EXPECT_EQ(reference, 0);
}

TEST(EventModel, HardCaseN53BlackToBlackGivesNothing) {
  const float tiny = 1e-6f;
  const int black = event_signal(0.0f, tiny);
  EXPECT_EQ(black, event_signal(-0.0f, tiny));
  EXPECT_EQ(black, event_signal(-1e-9f, tiny));  // rounding error of a renderer
  EXPECT_TRUE(std::isfinite(black * unit));
  EXPECT_EQ(count_crossings(black, event_signal(0.0f, tiny), fixed(0.01), fixed(0.01)), 0);
  EventWalk walk = begin_walk(black, black, black, fixed(0.01), fixed(0.01), 1000, 0);
  EXPECT_EQ(walk.left, 0);
  EXPECT_EQ(walk.crossing_ns, never_ns);
}

TEST(EventModel, HardCaseN54ExactlyOnTheThresholdFiresOnce) {
  const int32_t c = log_one / 4;
  for (const int sign : {1, -1}) {
    EXPECT_EQ(count_crossings(0, sign * (c - 1), c, c), 0);
    EXPECT_EQ(count_crossings(0, sign * c, c, c), sign);
    EXPECT_EQ(count_crossings(0, sign * 3 * c, c, c), 3 * sign);
    // After the event, no further event follows as long as the signal changes by less than a threshold.
    EXPECT_EQ(count_crossings(sign * c, sign * c, c, c), 0);
    EXPECT_EQ(count_crossings(sign * c, sign * (2 * c - 1), c, c), 0);
    EXPECT_EQ(count_crossings(sign * c, sign, c, c), 0);
    EXPECT_EQ(count_crossings(sign * c, 0, c, c), -sign);
    EXPECT_EQ(crossing_time(0, sign * c, sign * c, 777), 777);
  }
}

TEST(EventModel, HardCaseN55NothingIsDividedByNoChange) {
  EventWalk walk = begin_walk(5, 5, 5, 100, 100, 1000, 0);
  EXPECT_EQ(walk.left, 0);
  // The smallest possible step.
  walk = begin_walk(99, 100, 0, 100, 100, 1000, 0);
  ASSERT_EQ(walk.left, 1);
  EXPECT_EQ(take_crossing(walk), 1000);
  EXPECT_EQ(walk.crossing_ns, never_ns);
}

TEST(EventModel, CrossingTimesAreTheQuotientRoundedUp) {
  const int32_t from = -3 * log_one, to = 11 * log_one;
  for (int k = 1; k < 1000; ++k) {
    const int32_t level = from + k * 234567;
    for (const int dt : {1, 1000, 8333333, longest_interval_ns}) {
      const double exact = double(dt) * (double(level) - from) / (double(to) - from);
      const int t = crossing_time(from, to, level, dt);
      EXPECT_GE(t, 1);
      EXPECT_LE(t, dt);
      EXPECT_GE(t, exact - 1e-6);
      EXPECT_LT(t, exact + 1.0 + 1e-6);
      EXPECT_EQ(t, crossing_time(-from, -to, -level, dt));
    }
  }
}

TEST(EventModel, QuotientsOfIntegersFromFloatsAreExact) {
  uint32_t drawn = 0;
  const auto random = [&] { return random_bits(3, 0, 0, drawn++, 0).x; };
  const auto up_to = [&](uint32_t bits, uint32_t most) {  // at least 1, of all magnitudes
    return std::min(most, 1 + (random() & ((1u << (1 + random() % bits)) - 1)));
  };
  for (int i = 0; i < 100000; ++i) {
    const uint32_t whole = up_to(31, 0x7fffffffu);
    const uint32_t part = i % 4 == 0 ? whole - std::min(whole - 1, random() % 3) : up_to(31, whole);
    const auto dt = static_cast<int32_t>(up_to(31, uint32_t{longest_interval_ns}));
    const auto quotient = static_cast<int32_t>((uint64_t{part} * uint32_t(dt) + whole - 1) / whole);
    ASSERT_EQ(part_time(part, whole, 1.0f / float(whole), dt), quotient) << part << "/" << whole;
    // A reciprocal that is accurate to three units in the last place, as on a GPU, is sufficient.
    const float less = std::nextafter(std::nextafter(std::nextafter(1.0f / float(whole), 0.0f), 0.0f), 0.0f),
                more = std::nextafter(std::nextafter(std::nextafter(1.0f / float(whole), 2.0f), 2.0f), 2.0f);
    ASSERT_EQ(part_time(part, whole, less, dt), quotient) << part << "/" << whole;
    ASSERT_EQ(part_time(part, whole, more, dt), quotient) << part << "/" << whole;
  }
}

TEST(EventModel, WholePartIsTheConversion) {
  uint32_t drawn = 0;
  const auto random = [&] { return random_bits(4, 0, 0, drawn++, 0).x; };
  for (int i = 0; i < 300000; ++i) {
    const float x = uintBitsToFloat(random());
    if (std::abs(x) < 0x1p31f) {
      ASSERT_EQ(whole_part(x), static_cast<int32_t>(x)) << x;
    }
    const uint32_t n = random() & 0x7fffffu;
    ASSERT_EQ(near_whole(static_cast<float>(n)), int32_t(n));
  }
  for (const float x :
       {0.0f, -0.0f, 0.99999994f, -0.99999994f, 1.0f, 8388607.5f, -16777215.0f, 2147483520.0f})
    EXPECT_EQ(whole_part(x), static_cast<int32_t>(x)) << x;
}

TEST(EventModel, HardCaseN56TiesAreInOrderOfRowColumnPolarity) {
  using render::ListedEvent;
  std::vector<ListedEvent> events;
  const auto place = [](uint32_t y, uint32_t x, uint32_t p) { return y << 15 | x << 1 | p; };
  for (const uint32_t step : {0u, 1u})
    for (uint32_t y = 0; y < 40; ++y)
      for (uint32_t x = 0; x < 40; ++x)
        for (const uint32_t k : {2u, 0u, 1u})  // unsorted: a later event of the pixel comes first
          events.push_back({1000000 * step + 7 * ((x * y + k / 2) % 13) + 1, place(y, x, k == 2 ? 1 : k)});
  std::vector<ListedEvent> sorted = events;
  std::stable_sort(sorted.begin(), sorted.end());
  render::EventSorter<ListedEvent> sorter;
  sorter.sort(events, 33'333'333);
  events = sorter.sorted();
  ASSERT_EQ(events.size(), sorted.size());
  for (size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].t_ns, sorted[i].t_ns) << i;
    EXPECT_EQ(events[i].place, sorted[i].place) << i;
  }
}

TEST(EventModel, EventsOfAnyNumberAreSortedWhereverTheyCrowd) {
  using render::ListedEvent;
  RandomStream random(3, 1);
  render::EventSorter<ListedEvent> sorter;  // keeps its memory from one list to the next
  for (const uint32_t interval_ns : {1u, 1000u, 1'000'000u, 2'000'000'000u})
    for (const size_t count : {0u, 1u, 2u, 100u, 3000u, 50'000u})
      for (const double crowd : {1.0, 0.01}) {
        std::vector<ListedEvent> events;
        const auto last = static_cast<uint32_t>(std::max(1.0, crowd * interval_ns));
        for (size_t i = 0; i < count; ++i)
          events.push_back({1 + random.below(last), static_cast<uint32_t>(i / 2) << 1 | (i & 1 ? 0u : 1u)});
        std::vector<ListedEvent> sorted = events;
        std::stable_sort(sorted.begin(), sorted.end());
        sorter.sort(events, interval_ns);
        ASSERT_TRUE(std::ranges::equal(sorter.sorted(), sorted,
                                       [](const ListedEvent& a, const ListedEvent& b) {
                                         return a.t_ns == b.t_ns && a.place == b.place;
                                       }))
            << interval_ns << " ns, " << count << " events, " << crowd;
      }
}

TEST(EventModel, LowPassAnswersStepAndRampAsTheDifferentialEquation) {
  const double tau = 3.0;
  const auto run = [&](double h, const std::function<double(double)>& u, double y) {
    int32_t out = fixed(y), before = fixed(u(0));
    double t = 0.0;
    for (; t < 6.0 - 1e-9; t += h) {
      const int32_t now = fixed(u(t + h));
      out = low_pass(out, before, now, float(h / tau));
      before = now;
    }
    return out * unit;
  };
  for (const double h : {0.003, 0.1, 1.0, 6.0}) {
    // A constant input yields an exponential decay, a ramp yields u - tau + (y0 + tau) e^(-t/tau). Both are
    // exact for any step.
    EXPECT_NEAR(run(
                    h, [](double) { return 1.0; }, 5.0),
                1.0 + 4.0 * std::exp(-2.0), 2e-4)
        << h;
    EXPECT_NEAR(run(
                    h, [](double t) { return t; }, 2.0),
                6.0 - tau + (2.0 + tau) * std::exp(-2.0), 2e-4)
        << h;
  }
  EXPECT_EQ(low_pass(17, 17, 17, 0.5f), 17);
  EXPECT_EQ(low_pass(0, 0, 1000, 1e9f), 1000);  // no trace of the past remains
}

TEST(EventModel, LeakOfManyStepsIsTheLeakOfOne) {
  const int32_t on = fixed(0.237);
  const uint64_t rate = uint64_t(0.37 * 4294967296.0);
  int64_t sum = 0;
  const uint64_t steps = 12345;
  for (uint64_t i = 0; i < steps; ++i) sum += leak_between(rate * i / 7, rate * (i + 1) / 7, on);
  EXPECT_NEAR(double(sum), double(on) * 0.37 * steps / 7, 2.0);
}

TEST(EventModel, RefractoryPixelLetsNothingThrough) {
  // Ten crossings are 100 ns apart and the pixel is dead for 250 ns after each event: crossings 1, 4, 7 and
  // 10 pass.
  EventWalk walk = begin_walk(0, 1000, 0, 100, 100, 1000, 0);
  std::vector<int> times;
  while (walk.left > 0) {
    const int t = take_crossing(walk);
    if (pass_refractory(walk, t, 250)) times.push_back(t);
  }
  EXPECT_EQ(times, (std::vector<int>{100, 400, 700, 1000}));
  EXPECT_EQ(walk.alive_ns, 1250);
}

}  // namespace
}  // namespace greatx::shared
