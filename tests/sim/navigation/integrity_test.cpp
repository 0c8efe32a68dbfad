// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The check of a receiver's ranges against each other, weights by strength, and how honest its covariance is
// in the open and between walls.
#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/navigation/gnss.h"
#include "tests/sim/navigation/gnss_places.h"

namespace greatx::navigation {
namespace {

TEST(ChiSquared, HasTheTailOfClosedFormsAndTables) {
  for (const double x : {0.1, 1.0, 3.0, 9.0, 30.0}) {
    EXPECT_NEAR(chi_squared_tail(x, 1), std::erfc(std::sqrt(0.5 * x)), 1e-15);
    EXPECT_NEAR(chi_squared_tail(x, 2), std::exp(-0.5 * x), 1e-15);
    EXPECT_NEAR(chi_squared_tail(x, 4), std::exp(-0.5 * x) * (1.0 + 0.5 * x), 1e-15);
  }
  // Critical values of tables, to their last digit (Abramowitz and Stegun, table 26.8).
  EXPECT_NEAR(chi_squared_tail(3.84146, 1), 0.05, 1e-6);
  EXPECT_NEAR(chi_squared_tail(16.2662, 3), 0.001, 1e-6);
  EXPECT_NEAR(chi_squared_tail(11.0705, 5), 0.05, 1e-6);
  EXPECT_NEAR(chi_squared_tail(23.2093, 10), 0.01, 1e-6);
  EXPECT_EQ(chi_squared_tail(5.0, 0), 1.0);
}

/// Satellites in fixed directions, with unlike deviations and normal errors.
class Ranges {
 public:
  explicit Ranges(size_t count) {
    for (size_t i = 0; i < count; ++i) {
      const double azimuth = 2.4 * static_cast<double>(i),
                   elevation = radians(12.0 + 70.0 * std::fmod(0.37 * static_cast<double>(i), 1.0));
      const dvec3 direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                            std::sin(elevation));
      RangeMeasurement m;
      m.satellite_m = 2.2e7 * direction;
      m.range_m = 2.2e7;
      m.range_std_m = 1.0 + 0.3 * static_cast<double>(i % 4);
      m.rate_std = 0.1;
      exact_.push_back(m);
    }
  }
  std::vector<RangeMeasurement> draw(std::mt19937_64& random) const {
    std::normal_distribution<double> normal;
    std::vector<RangeMeasurement> out = exact_;
    for (RangeMeasurement& m : out)
      m.range_m += m.range_std_m * normal(random), m.rate += m.rate_std * normal(random);
    return out;
  }
  const std::vector<RangeMeasurement>& exact() const { return exact_; }

  /// Returns sum b_i^2 / s_i^2 that is left of biases when the least squares have taken up what they can: the
  /// noncentrality of the statistic.
  double noncentrality(const std::vector<double>& bias) const {
    dmat4 normal(0.0);
    dvec4 right(0.0);
    double sum = 0.0;
    for (size_t i = 0; i < exact_.size(); ++i) {
      const dvec4 row = dvec4(-glm::normalize(exact_[i].satellite_m), 1.0) / exact_[i].range_std_m;
      normal += glm::outerProduct(row, row);
      right += bias[i] / exact_[i].range_std_m * row;
      sum += std::pow(bias[i] / exact_[i].range_std_m, 2.0);
    }
    return sum - glm::dot(right, glm::inverse(normal) * right);
  }

 private:
  std::vector<RangeMeasurement> exact_;
};

TEST(Integrity, WithoutFaultsStatisticsAreChiSquaredAndErrorsHaveTheCovariance) {
  constexpr int draws = 4000;
  std::mt19937_64 random(1);
  for (const size_t count : {5u, 8u, 11u}) {
    const Ranges ranges(count);
    const auto k = static_cast<double>(count - 4);
    double sum = 0.0, rates = 0.0, quadratic = 0.0, squared_normalized = 0.0;
    int alarms = 0;
    dmat3 covariance(0.0), stated(0.0);
    for (int i = 0; i < draws; ++i) {
      const auto measurements = ranges.draw(random);
      const auto fix = solve_position(measurements, dvec3(0.0));
      ASSERT_TRUE(fix);
      EXPECT_EQ(fix->redundancy, count - 4);
      sum += fix->range_statistic, rates += fix->rate_statistic;
      alarms += chi_squared_tail(fix->range_statistic, fix->redundancy) < 0.05;
      covariance += glm::outerProduct(fix->position_m, fix->position_m) / static_cast<double>(draws);
      stated = fix->position_covariance;
      quadratic += glm::dot(fix->position_m, glm::inverse(stated) * fix->position_m);
      squared_normalized += fix->range_residuals[count - 1] * fix->range_residuals[count - 1];
    }
    // The bounds are 4 standard deviations of the means.
    EXPECT_NEAR(sum / draws, k, 4.0 * std::sqrt(2.0 * k / draws));
    EXPECT_NEAR(rates / draws, k, 4.0 * std::sqrt(2.0 * k / draws));
    EXPECT_NEAR(quadratic / draws, 3.0, 4.0 * std::sqrt(6.0 / draws));
    EXPECT_NEAR(squared_normalized / draws, 1.0, 4.0 * std::sqrt(2.0 / draws));
    EXPECT_NEAR(alarms / static_cast<double>(draws), 0.05, 4.0 * std::sqrt(0.05 * 0.95 / draws));
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(covariance[axis][axis] / stated[axis][axis], 1.0, 4.0 * std::sqrt(2.0 / draws));
  }
}

TEST(Integrity, TwoBiasedRangesAreFoundWithTheOddsOfNoncentralChiSquared) {
  constexpr int draws = 4000;
  constexpr double false_alarm = 1e-3;
  constexpr size_t count = 9;
  const Ranges ranges(count);
  std::mt19937_64 random(2);
  for (const double size_m : {5.0, 7.0, 9.0}) {
    std::vector<double> bias(count, 0.0);
    bias[2] = size_m, bias[5] = 0.7 * size_m;
    int found = 0;
    for (int i = 0; i < draws; ++i) {
      auto measurements = ranges.draw(random);
      for (size_t j = 0; j < count; ++j) measurements[j].range_m += bias[j];
      const auto fix = solve_position(measurements, dvec3(0.0));
      ASSERT_TRUE(fix);
      found += chi_squared_tail(fix->range_statistic, fix->redundancy) < false_alarm;
    }
    // The threshold by bisection, and the tail of a Poisson mixture of central ones.
    double low = 0.0, high = 1000.0;
    while (high - low > 1e-9)
      (chi_squared_tail(0.5 * (low + high), count - 4) > false_alarm ? low : high) = 0.5 * (low + high);
    const double half = 0.5 * ranges.noncentrality(bias);
    double odds = 0.0, weight = std::exp(-half);
    for (uint32_t j = 0; j < 400; ++j, weight *= half / j)
      odds += weight * chi_squared_tail(low, static_cast<uint32_t>(count) - 4 + 2 * j);
    EXPECT_NEAR(found / static_cast<double>(draws), odds,
                4.0 * std::sqrt(odds * (1.0 - odds) / draws) + 1e-9);
    EXPECT_GT(odds, 0.1);
    EXPECT_LT(odds, 0.999);
  }
}

TEST(Integrity, TheWrongRangeOrRateIsLeftOut) {
  const Ranges ranges(11);
  std::mt19937_64 random(3);
  for (size_t wrong = 0; wrong < 11; ++wrong) {
    SCOPED_TRACE(wrong);
    std::vector<bool> all_but_one(11, true);
    all_but_one[wrong] = false;
    auto measurements = ranges.draw(random), rates = ranges.draw(random);
    measurements[wrong].range_m += 80.0;
    const auto checked = solve_checked(measurements, dvec3(0.0), 1e-6);
    ASSERT_TRUE(checked);
    EXPECT_EQ(checked->used, all_but_one);
    EXPECT_FALSE(checked->ranges_disagree);
    const auto with = solve_position(measurements, dvec3(0.0));
    measurements.erase(measurements.begin() + static_cast<long>(wrong));
    const auto without = solve_position(measurements, dvec3(0.0));
    EXPECT_LT(glm::length(checked->fix.position_m - without->position_m), 1e-6);
    EXPECT_LT(glm::length(checked->fix.velocity - without->velocity), 1e-9);
    EXPECT_GT(glm::length(with->position_m), glm::length(checked->fix.position_m));
    rates[wrong].rate -= 8.0;
    EXPECT_EQ(solve_checked(rates, dvec3(0.0), 1e-6)->used, all_but_one);
  }
}

TEST(Integrity, FiveRangesRemain) {
  // Errors far beyond what is stated: the check goes on as long as it can.
  const Ranges ranges(9);
  std::mt19937_64 random(5);
  auto measurements = ranges.draw(random);
  for (size_t i = 0; i < measurements.size(); ++i)
    measurements[i].range_m += 100.0 * std::sin(7.0 * double(i));
  const auto checked = solve_checked(measurements, dvec3(0.0), 1e-3);
  ASSERT_TRUE(checked);
  EXPECT_EQ(std::ranges::count(checked->used, true), 5);
  EXPECT_EQ(checked->fix.redundancy, 1u);
}

TEST(Integrity, FiveRangesThatDisagreeWidenTheCovarianceByTheirStatistic) {
  const Ranges ranges(5);
  std::mt19937_64 random(4);
  auto measurements = ranges.draw(random);
  measurements[2].range_m += 90.0;
  const auto plain = solve_position(measurements, dvec3(0.0));
  const auto checked = solve_checked(measurements, dvec3(0.0), 1e-3);
  ASSERT_TRUE(plain && checked);
  EXPECT_TRUE(checked->ranges_disagree);
  EXPECT_FALSE(checked->rates_disagree);
  EXPECT_EQ(checked->used, std::vector<bool>(5, true));
  EXPECT_EQ(checked->fix.position_m, plain->position_m);
  EXPECT_NEAR(checked->fix.position_covariance[0][0],
              plain->range_statistic * plain->position_covariance[0][0], 1e-9 * plain->range_statistic);
  EXPECT_EQ(checked->fix.velocity_covariance, plain->velocity_covariance);
  // Of four ranges each is believed.
  measurements.pop_back();
  const auto four = solve_checked(measurements, dvec3(0.0), 1e-3);
  ASSERT_TRUE(four);
  EXPECT_FALSE(four->ranges_disagree);
  EXPECT_EQ(four->fix.redundancy, 0u);
}

TEST(Reflections, LoseWhatFresnelsCoefficientsSay) {
  // At right angles the sense of rotation turns round as a whole: |(1 - n) / (1 + n)|^2, 6 dB less for it.
  const double imaginary = 17.98 * 0.0462 * std::pow(1.57542, 0.7822 - 1.0);
  const std::complex<double> n = std::sqrt(std::complex<double>(5.24, -imaginary));
  EXPECT_NEAR(reflection_loss_db(1.0), 6.0 - 20.0 * std::log10(std::abs((1.0 - n) / (1.0 + n))), 1e-9);
  EXPECT_NEAR(reflection_loss_db(0.0), 0.0, 1e-9) << "a mirror at grazing incidence";
  // At 45 degrees the coefficient along is the square of that across (Fresnel's identity).
  const double c = std::sqrt(0.5);
  const std::complex<double> inside = std::sqrt(n * n - 0.5), across = (c - inside) / (c + inside);
  const double same = std::norm(0.5 * (across * across + across)),
               other = std::norm(0.5 * (across * across - across));
  EXPECT_NEAR(reflection_loss_db(c), -10.0 * std::log10(same + other * std::pow(10.0, -0.6)), 1e-9);
  for (double cosine = 0.05; cosine < 1.0; cosine += 0.05)
    EXPECT_GT(reflection_loss_db(cosine), reflection_loss_db(cosine - 0.05));
  EXPECT_NEAR(weakness_factor(1.9), 1.0, 1e-12);
  EXPECT_NEAR(weakness_factor(12.0), 10.0, 1e-12);
}

/// A street along y between walls at x = +- 8 m, of this height without end, and an antenna in it: what is
/// hidden comes over the other wall, if its mirror image is on the wall and the wall sees the satellite.
Sky walled_street(double height_m, const dvec3& at, const dvec3& velocity) {
  constexpr double half_m = 8.0;
  return [=](const dvec3& direction) {
    const double side = direction.x < 0.0 ? -1.0 : 1.0, slope = direction.z / std::abs(direction.x);
    if (at.z + (half_m - side * at.x) * slope > height_m) return SignalPath{};
    const double to_mirror_m = half_m + side * at.x, on_mirror_m = at.z + to_mirror_m * slope;
    if (on_mirror_m > height_m || on_mirror_m + 2.0 * half_m * slope < height_m)
      return SignalPath{SignalPath::State::blocked, 0.0, 0.0};
    return reflected_path(direction, {side, 0.0, 0.0}, to_mirror_m, velocity);
  };
}

/// Means of e^T C^-1 e / 3 over epochs, 1 if the covariance is honest, and medians of errors.
struct Honesty {
  double position = 0.0, velocity = 0.0, median_m = 0.0, share_reflected = 0.0;
};

Honesty honesty(const GnssReceiver& receiver, double height_m) {
  const LocalFrame frame(delft);
  const dvec3 at(2.0, 3.0, 1.5), velocity(0.0, 10.0, 0.0);
  const Sky sky = walled_street(height_m, at, velocity);
  Honesty sum;
  std::vector<double> errors;
  double satellites = 0.0;
  for (int epoch = 0; epoch < 96; ++epoch)
    for (uint32_t sequence = 0; sequence < 10; ++sequence) {
      Gnss gnss(receiver, frame, 1, "g", sequence, 1.0);
      const GnssEpoch found = gnss.measure(noon_unix_s + 900.0 * epoch, at, velocity, sky, 0);
      if (!found.fix) continue;
      const dvec3 error = found.fix->position_m - at, drift = found.fix->velocity - velocity;
      sum.position += glm::dot(error, glm::inverse(found.fix->position_covariance) * error) / 3.0;
      sum.velocity += glm::dot(drift, glm::inverse(found.fix->velocity_covariance) * drift) / 3.0;
      errors.push_back(glm::length(error));
      for (const SatelliteView& view : found.satellites) {
        if (view.used) satellites += 1.0;
        if (view.used && view.path.state == SignalPath::State::reflected) sum.share_reflected += 1.0;
      }
    }
  EXPECT_GT(errors.size(), 200u);
  std::ranges::nth_element(errors, errors.begin() + static_cast<long>(errors.size() / 2));
  const auto count = static_cast<double>(errors.size());
  return {sum.position / count, sum.velocity / count, errors[errors.size() / 2],
          sum.share_reflected / satellites};
}

TEST(Gnss, StatesItsErrorsHonestlyInTheOpenInAStreetAndInACanyon) {
  GnssReceiver checked, believer;
  believer.integrity = false;
  for (const double height_m : {0.0, 10.0, 22.0}) {
    SCOPED_TRACE(height_m);
    const Honesty honest = honesty(checked, height_m), naive = honesty(believer, height_m);
    std::printf(
        "%.0f m: position %.2f (%.2f), velocity %.2f (%.2f), median %.2f m (%.2f m), reflected %.2f\n",
        height_m, honest.position, naive.position, honest.velocity, naive.velocity, honest.median_m,
        naive.median_m, naive.share_reflected);
    EXPECT_GT(honest.position, 0.5);
    EXPECT_LT(honest.position, 1.5);
    EXPECT_LT(honest.velocity, 1.5);
    if (height_m == 0.0) {
      EXPECT_EQ(naive.share_reflected, 0.0);
      EXPECT_NEAR(honest.median_m, naive.median_m, 0.05 * naive.median_m) << "nothing is lost in the open";
    } else {
      EXPECT_GT(naive.position, 2.0 * honest.position);
      EXPECT_LT(honest.median_m, naive.median_m);
    }
  }
}

}  // namespace
}  // namespace greatx::navigation
