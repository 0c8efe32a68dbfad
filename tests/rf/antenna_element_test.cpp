// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks element patterns and polarization models.
#include <gtest/gtest.h>

#include "core/error.h"
#include "rf/antenna/element.h"
#include "tests/rf/antenna_support.h"
#include "tests/rf/turned_field.h"

namespace greatx::rf {
namespace {

using testing::turned_field;

constexpr Pattern analytic[] = {Pattern::isotropic, Pattern::short_dipole, Pattern::half_wave_dipole,
                                Pattern::tr38901};
constexpr PolarizationModel models[] = {PolarizationModel::model_1, PolarizationModel::model_2};

/// Returns all patterns under both models, including an imported one with both components.
std::vector<ElementPattern> all_patterns() {
  const auto table = std::make_shared<const PatternTable>(sampled(37, 72, -pi, curly_field));
  std::vector<ElementPattern> patterns;
  for (const PolarizationModel model : models) {
    for (const Pattern shape : analytic) patterns.emplace_back(shape, model);
    patterns.emplace_back(Pattern::imported, model, table);
  }
  return patterns;
}

double gain_dbi(double theta_deg, double phi_deg) {
  return 10.0 * std::log10(power(element_field(Pattern::tr38901, 0.0,
                                               direction_of(radians(theta_deg), radians(phi_deg)))));
}

TEST(AntennaElement, Tr38901AtKnownAngles) {
  EXPECT_NEAR(gain_dbi(90, 0), 8.0, 1e-12);
  EXPECT_NEAR(gain_dbi(90, 65), -4.0, 1e-12);
  EXPECT_NEAR(gain_dbi(90, 32.5), 5.0, 1e-12);      // half of 65 degrees: 3 dB
  EXPECT_NEAR(gain_dbi(90 - 32.5, 0), 5.0, 1e-12);  // symmetric in elevation
  EXPECT_NEAR(gain_dbi(90 + 32.5, 0), 5.0, 1e-12);
  EXPECT_NEAR(gain_dbi(90 + 32.5, -32.5), 2.0, 1e-12);
  EXPECT_NEAR(gain_dbi(90, 180), -22.0, 1e-12);  // the floor, 30 dB below the maximum
  EXPECT_NEAR(gain_dbi(90, 110), -22.0, 1e-12);
  EXPECT_NEAR(gain_dbi(30, -100), -22.0, 1e-12);  // 10.2 + 28.4 dB: the floor of the sum
  // The attenuation on the z axis, where phi is 0, is 12 (90/65)^2 dB.
  EXPECT_NEAR(gain_dbi(0, 0), 8.0 - 12.0 * 90.0 * 90.0 / (65.0 * 65.0), 1e-12);
  EXPECT_NEAR(power(element_field(Pattern::tr38901, 0.0, {0, 0, 1})),
              power(element_field(Pattern::tr38901, 0.0, {0, 0, -1})), 1e-15);
}

TEST(AntennaElement, MeanGainOverTheSphere) {
  // Lossless elements radiate all their power for any slant; the element of TR 38.901 does not.
  for (const PolarizationModel model : models)
    for (const double slant : {0.0, 0.3}) {
      EXPECT_NEAR(mean_gain({Pattern::isotropic, model}, slant, 400, 8), 1.0, 1e-5);
      EXPECT_NEAR(mean_gain({Pattern::short_dipole, model}, slant, 400, 8), 1.0, 1e-5);
      EXPECT_NEAR(mean_gain({Pattern::half_wave_dipole, model}, slant, 400, 8), 1.0, 1e-5);
      EXPECT_NEAR(mean_gain({Pattern::tr38901, model}, slant, 720, 720), 0.656798, 1e-6);
    }
  EXPECT_NEAR(mean_gain(Pattern::short_dipole, 0.0, 20000, 1), 1.0, 1e-8);
}

TEST(AntennaElement, ShortDipole) {
  EXPECT_NEAR(power(element_field(Pattern::short_dipole, 0.0, {1, 0, 0})), 1.5, 1e-15);
  EXPECT_NEAR(element_field(Pattern::short_dipole, 0.0, direction_of(0.3, 2.0)).theta.real(),
              std::sqrt(1.5) * std::sin(0.3), 1e-15);
}

TEST(AntennaElement, ModelsAgreeWithoutSlantAndAtBoresight) {
  RandomStream random(4, 1);
  for (const Pattern shape : analytic) {
    for (int i = 0; i < 200; ++i) {
      const dvec3 r = random_direction(random);
      const Jones one = element_field({shape, PolarizationModel::model_1}, 0.0, r);
      const Jones two = element_field({shape, PolarizationModel::model_2}, 0.0, r);
      EXPECT_LT(std::abs(one.theta - two.theta) + std::abs(one.phi - two.phi), 1e-15);
    }
    for (const double slant : {pi / 4, -pi / 4, pi / 2, 1.0}) {
      const Jones one = element_field({shape, PolarizationModel::model_1}, slant, {1, 0, 0});
      const Jones two = element_field({shape, PolarizationModel::model_2}, slant, {1, 0, 0});
      EXPECT_LT(std::abs(one.theta - two.theta) + std::abs(one.phi - two.phi), 1e-15);
      // Behind the antenna, a rolled element is slanted the other way.
      const Jones behind = element_field({shape, PolarizationModel::model_1}, slant, {-1, 0, 0});
      const Jones mirrored = element_field({shape, PolarizationModel::model_2}, -slant, {-1, 0, 0});
      EXPECT_LT(std::abs(behind.theta - mirrored.theta) + std::abs(behind.phi - mirrored.phi), 1e-15);
    }
  }
}

TEST(AntennaElement, ModelOneIsEquation733) {
  RandomStream random(4, 2);
  for (int i = 0; i < 500; ++i) {
    const double theta = random.uniform(0.01, pi - 0.01), phi = random.uniform(-pi, pi),
                 zeta = random.uniform(-pi, pi);
    const double axis = std::cos(zeta) * std::cos(theta) - std::sin(zeta) * std::sin(phi) * std::sin(theta);
    const double d = std::sqrt(1.0 - axis * axis);
    if (d < 1e-3) continue;  // the equation itself cancels here
    const Jones field =
        element_field({Pattern::isotropic, PolarizationModel::model_1}, zeta, direction_of(theta, phi));
    EXPECT_NEAR(field.theta.real(),
                (std::cos(zeta) * std::sin(theta) + std::sin(zeta) * std::sin(phi) * std::cos(theta)) / d,
                1e-9);
    EXPECT_NEAR(field.phi.real(), std::sin(zeta) * std::cos(phi) / d, 1e-9);
  }
}

TEST(AntennaElement, ModelOneIsThePolarizationOfARolledElement) {
  // A roll about x by pi/3 turns a short dipole as a body. Model 1 with a slant of pi/3 has the polarization
  // of this dipole in every direction.
  const dquat roll = orientation_from_yaw_pitch_roll(0, 0, pi / 3);
  RandomStream random(4, 3);
  for (int i = 0; i < 200; ++i) {
    const dvec3 r = random_direction(random);
    const Jones body = turned_field(Pattern::short_dipole, 0.0, roll, r);
    const Jones model = element_field({Pattern::isotropic, PolarizationModel::model_1}, pi / 3, r);
    const double length = std::sqrt(power(body));
    EXPECT_LT(std::abs(body.theta / length - model.theta) + std::abs(body.phi / length - model.phi), 1e-13);
  }
}

TEST(AntennaElement, SlantLeavesThePowerAlone) {
  RandomStream random(4, 4);
  for (const ElementPattern& pattern : all_patterns())
    for (int i = 0; i < 50; ++i) {
      const dvec3 r = random_direction(random);
      EXPECT_NEAR(power(element_field(pattern, random.uniform(-pi, pi), r)),
                  power(element_field(pattern, 0.0, r)), 1e-13);
    }
}

TEST(AntennaElement, CrossPolarPairsAreOrthogonal) {
  // The pairs are orthogonal at boresight under both models, and everywhere under model 2.
  RandomStream random(4, 5);
  for (const ElementPattern& pattern : all_patterns())
    for (int i = 0; i < 20; ++i) {
      const dvec3 r =
          i == 0 || pattern.model == PolarizationModel::model_1 ? dvec3(1, 0, 0) : random_direction(random);
      for (const auto& [first, second] : {std::pair(0.0, pi / 2), std::pair(pi / 4, -pi / 4)}) {
        const Jones a = element_field(pattern, first, r), b = element_field(pattern, second, r);
        const double both = std::norm(a.theta) + std::norm(a.phi);
        // For real patterns a^H b = 0. For complex patterns, b is a turned by 90 degrees, (-F_phi, F_theta),
        // so that a^T b = 0.
        const Complex inner = a.theta * b.theta + a.phi * b.phi;
        EXPECT_LT(std::abs(inner), 1e-15 * (1.0 + both));
      }
    }
}

TEST(AntennaElement, TurningTheAntennaTurnsTheFieldOfAllPatterns) {
  // The field vector of the turned antenna is the turned field vector (TR 38.901, eq. 7.1-11).
  RandomStream random(3, 1);
  for (const ElementPattern& pattern : all_patterns())
    for (int i = 0; i < 50; ++i) {
      const dquat turn = orientation_from_yaw_pitch_roll(random.uniform(-3, 3), random.uniform(-1.5, 1.5),
                                                         random.uniform(-3, 3));
      const double slant = random.uniform(-pi, pi);
      const dvec3 world = random_direction(random), own = glm::conjugate(turn) * world;
      const Jones local = element_field(pattern, slant, own),
                  global = turned_field(pattern, slant, turn, world);
      for (const auto part :
           {+[](const Complex& c) { return c.real(); }, +[](const Complex& c) { return c.imag(); }}) {
        const dvec3 turned = turn * (part(local.theta) * theta_hat(own) + part(local.phi) * phi_hat(own));
        const dvec3 seen = part(global.theta) * theta_hat(world) + part(global.phi) * phi_hat(world);
        EXPECT_LT(glm::length(turned - seen), 1e-13);
      }
    }
}

TEST(AntennaElement, TwoPolarizationsAtOnceAreThoseOneByOne) {
  const dquat turn = orientation_from_yaw_pitch_roll(0.3, -0.2, 1.0);
  const double slants[] = {pi / 4, -pi / 4};
  for (const ElementPattern& pattern : all_patterns()) {
    Jones both[2];
    const TurnedElement element(pattern, slants, turn);
    element.respond({1, -2, 0.5}, both);
    for (int p = 0; p < 2; ++p) {
      const Jones one = turned_field(pattern, slants[p], turn, {1, -2, 0.5});
      EXPECT_EQ(both[p].theta, one.theta);
      EXPECT_EQ(both[p].phi, one.phi);
    }
    EXPECT_THROW(element.respond({0, 0, 1}, std::span<Jones>(both, 1)), ContractError);
  }
}

TEST(AntennaElement, ImportedWithoutATableBreaksTheContract) {
  EXPECT_THROW(element_field(Pattern::imported, 0.0, {1, 0, 0}), ContractError);
}

TEST(AntennaElementHardCase, N48_PolesOfAllPatterns) {
  for (const ElementPattern& pattern : all_patterns())
    for (const double z : {1.0, -1.0})
      for (const double slant : {0.0, pi / 4, -pi / 4, pi / 2}) {
        const Jones field = element_field(pattern, slant, {0, 0, z});
        ASSERT_TRUE(std::isfinite(power(field)));
        if (pattern.shape == Pattern::isotropic) {
          EXPECT_NEAR(power(field), 1.0, 1e-15);
        }
        if (pattern.shape == Pattern::short_dipole || pattern.shape == Pattern::half_wave_dipole) {
          EXPECT_EQ(power(field), 0.0);
        }
        // A pole of the antenna's frame that is not one of the world's frame, and vice versa.
        const dquat turn = orientation_from_yaw_pitch_roll(0.0, pi / 2, 0.0);
        for (const dvec3 world : {turn * dvec3(0, 0, z), dvec3(0, 0, z)}) {
          const Jones turned = turned_field(pattern, slant, turn, world);
          EXPECT_TRUE(std::isfinite(power(turned)));
          if (pattern.shape == Pattern::isotropic) {
            EXPECT_NEAR(power(turned), 1.0, 1e-14);
          }
        }
      }
  // Along the axis of a slanted element, model 1 has no angle, but the power remains.
  for (const double side : {1.0, -1.0})
    EXPECT_NEAR(power(element_field({Pattern::isotropic, PolarizationModel::model_1}, pi / 2, {0, side, 0})),
                1.0, 1e-15);
}

TEST(AntennaElementHardCase, N49_PatternsKeepTheirDigitsBesideThePoles) {
  for (const double tilt : {1e-6, 1e-9, 1e-12})
    for (const double z : {1.0, -1.0}) {
      const dvec3 beside{0.6 * tilt, 0.8 * tilt, z};
      EXPECT_NEAR(element_field(Pattern::short_dipole, 0.0, beside).theta.real() / (std::sqrt(1.5) * tilt),
                  1.0, 1e-11);
      EXPECT_NEAR(
          element_field({Pattern::short_dipole, PolarizationModel::model_1}, pi / 4, beside).theta.real() /
              (std::sqrt(1.5) * tilt * (z * 0.8)),
          1.0, 1e-5);  // cos(psi) = sin(phi) cos(theta) beside the axis
    }
}

TEST(AntennaElementHardCase, N50_UprightAntennasAreContinuous) {
  // At beta = +-90 degrees, yaw and roll turn about the same axis. The field equals that of neighbouring
  // orientations.
  RandomStream random(4, 6);
  for (const ElementPattern& pattern : all_patterns())
    for (const double pitch : {pi / 2, -pi / 2})
      for (int i = 0; i < 20; ++i) {
        const dvec3 r = random_direction(random);
        const auto field = [&](double p) {
          return turned_field(pattern, 0.4, orientation_from_yaw_pitch_roll(0.7, p, -0.4), r);
        };
        const Jones exact = field(pitch);
        ASSERT_TRUE(std::isfinite(power(exact)));
        for (const double beside : {-1e-9, 1e-9}) {
          const Jones near = field(pitch + beside);
          EXPECT_LT(std::abs(near.theta - exact.theta) + std::abs(near.phi - exact.phi), 1e-6);
        }
      }
}

TEST(AntennaElementHardCase, N51_HalfTurns) {
  // After a half turn, a direction seen from behind is the same as one seen from the front. This holds for
  // every pattern and half turns about all three axes.
  RandomStream random(4, 7);
  for (const ElementPattern& pattern : all_patterns())
    for (int i = 0; i < 20; ++i) {
      const dvec3 r = random_direction(random);
      for (const dvec3 axis : {dvec3(0, 0, 1), dvec3(0, 1, 0), dvec3(1, 0, 0)}) {
        const dquat half = glm::angleAxis(pi, axis);
        const Jones turned = turned_field(pattern, 0.4, half, half * r);
        const Jones own = element_field(pattern, 0.4, r);
        EXPECT_NEAR(power(turned), power(own), 1e-12);
        const Jones whole = turned_field(pattern, 0.4, half * half, r);
        EXPECT_LT(std::abs(whole.theta - own.theta) + std::abs(whole.phi - own.phi), 1e-12);
      }
      // Directions exactly behind, above and below.
      for (const dvec3 d : {dvec3(-1, 0, 0), dvec3(-1, -0.0, -0.0), dvec3(-0.0, -0.0, -1)})
        EXPECT_TRUE(std::isfinite(power(element_field(pattern, 0.4, d))));
    }
}

}  // namespace
}  // namespace greatx::rf
