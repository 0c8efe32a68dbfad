// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks patterns that are given by samples.
#include <gtest/gtest.h>

#include "core/error.h"
#include "rf/antenna/pattern_table.h"
#include "tests/rf/antenna_support.h"
#include "tests/rf/turned_field.h"

namespace greatx::rf {
namespace {

using testing::turned_field;

/// Returns the largest error of F_theta and F_phi over directions between the samples.
double worst(const PatternTable& table, const std::function<Jones(double, double)>& field,
             double theta_low = 0.0, double theta_high = pi, double phi_low = -pi, double phi_high = pi) {
  double largest = 0.0;
  for (int i = 0; i <= 211; ++i)
    for (int j = 0; j <= 211; ++j) {
      const double theta = theta_low + (theta_high - theta_low) * i / 211.0;
      const double phi = phi_low + (phi_high - phi_low) * j / 211.0;
      const Jones ours = table.at(theta, phi), exact = field(theta, phi);
      largest = std::max({largest, std::abs(ours.theta - exact.theta), std::abs(ours.phi - exact.phi)});
    }
  return largest;
}

Jones analytic_field(Pattern shape, double theta, double phi) {
  return element_field(shape, 0.0, direction_of(theta, phi));
}

TEST(PatternTable, ItsOwnSamples) {
  for (const double first : {-pi, 0.0, 0.1}) {
    const PatternTable table = sampled(19, 36, first, curly_field);
    for (int i = 0; i < 19; ++i)
      for (int j = -36; j < 72; ++j) {
        const double theta = i * pi / 18, phi = first + j * pi / 18;
        const Jones ours = table.at(theta, phi), exact = curly_field(theta, phi);
        EXPECT_LT(std::abs(ours.theta - exact.theta) + std::abs(ours.phi - exact.phi), 1e-13);
      }
  }
}

TEST(PatternTable, ErrorIsWithinItsBound) {
  // For both components of curly_field, |d2/dtheta2| is at most 2 and |d2/dphi2| at most 4.
  const auto bound = [](double dtheta, double dphi) {
    return (dtheta * dtheta * 2.0 + dphi * dphi * 4.0) / 8.0;
  };
  for (const uint32_t n : {19u, 37u, 181u}) {
    const double error = worst(sampled(n, 2 * (n - 1), -pi, curly_field), curly_field);
    const double step = pi / (n - 1);
    EXPECT_LT(error, bound(step, step));
    EXPECT_GT(error, bound(step, step) / 10.0);  // the bound is not much too large
  }
}

TEST(PatternTable, SecondOrderAgainstDipoles) {
  for (const Pattern shape : {Pattern::short_dipole, Pattern::half_wave_dipole}) {
    const auto field = [&](double theta, double phi) { return analytic_field(shape, theta, phi); };
    double last = 0.0;
    for (const uint32_t n : {19u, 37u, 73u, 145u}) {
      const double error = worst(sampled(n, 8, 0.0, field), field);
      if (last > 0.0) {
        EXPECT_NEAR(last / error, 4.0, 0.3) << n;
      }
      last = error;
    }
    EXPECT_LT(last, 1.2e-4);  // for steps of 1.25 degrees
  }
}

TEST(PatternTable, SecondOrderAgainstTr38901WhereItIsSmooth) {
  const auto field = [](double theta, double phi) { return analytic_field(Pattern::tr38901, theta, phi); };
  double last = 0.0;
  for (const uint32_t n : {37u, 73u, 145u}) {
    // The range lies within 45 degrees of boresight, where A_v + A_h does not reach the floor.
    const double error =
        worst(sampled(n, 2 * (n - 1), -pi, field), field, pi / 4, 3 * pi / 4, -pi / 4, pi / 4);
    if (last > 0.0) {
      EXPECT_NEAR(last / error, 4.0, 0.3) << n;
    }
    last = error;
  }
  // With steps of one degree, the kink at the floor adds no larger error. The first row next to the poles is
  // left out: there the pattern depends on azimuth and has no limit.
  EXPECT_LT(worst(sampled(181, 360, -pi, field), field, pi / 180, 179 * pi / 180), 1.2e-3);
}

TEST(PatternTable, AnElementOfSamplesIsTheElement) {
  // The test covers the whole evaluation with slants, models and turns.
  const auto table =
      std::make_shared<const PatternTable>(sampled(361, 720, 0.0, [](double theta, double phi) {
        return analytic_field(Pattern::half_wave_dipole, theta, phi);
      }));
  RandomStream random(6, 1);
  for (const PolarizationModel model : {PolarizationModel::model_1, PolarizationModel::model_2})
    for (int i = 0; i < 200; ++i) {
      const dvec3 r = random_direction(random);
      const dquat turn = orientation_from_yaw_pitch_roll(random.uniform(-3, 3), random.uniform(-1, 1), 0.5);
      const double slant = random.uniform(-pi, pi);
      const Jones ours = turned_field({Pattern::imported, model, table}, slant, turn, r);
      const Jones exact = turned_field({Pattern::half_wave_dipole, model}, slant, turn, r);
      EXPECT_LT(std::abs(ours.theta - exact.theta) + std::abs(ours.phi - exact.phi), 5e-5);
    }
}

TEST(PatternTable, SlantTurnsBothComponents) {
  const auto table = std::make_shared<const PatternTable>(sampled(37, 72, 0.0, curly_field));
  const dvec3 r = direction_of(radians(50.0), radians(40.0));
  const Jones plain = element_field({Pattern::imported, PolarizationModel::model_2, table}, 0.0, r);
  const Jones slanted = element_field({Pattern::imported, PolarizationModel::model_2, table}, 0.3, r);
  EXPECT_LT(std::abs(slanted.theta - (std::cos(0.3) * plain.theta - std::sin(0.3) * plain.phi)), 1e-15);
  EXPECT_LT(std::abs(slanted.phi - (std::sin(0.3) * plain.theta + std::cos(0.3) * plain.phi)), 1e-15);
}

TEST(PatternTable, BreaksOfTheContract) {
  EXPECT_THROW(PatternTable({2, 8, 0.0}, std::vector<Jones>(16)), ContractError);
  EXPECT_THROW(PatternTable({3, 8, 0.0}, std::vector<Jones>(16)), ContractError);
  EXPECT_THROW(PatternTable({3, 4, 0.0}, std::vector<Jones>(12, Jones{NAN, 0.0})), ContractError);
}

}  // namespace
}  // namespace greatx::rf
