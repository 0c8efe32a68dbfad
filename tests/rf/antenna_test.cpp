// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/antenna/antenna.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/rf/antenna_support.h"
#include "tests/rf/turned_field.h"

namespace greatx::rf {
namespace {

using testing::turned_field;

TEST(AntennaHardCase, N48_Poles) {
  for (const double z : {1.0, -1.0})
    for (const double slant : {0.0, pi / 2, pi / 4, -pi / 4}) {
      EXPECT_NEAR(power(element_field(Pattern::isotropic, slant, dvec3(0, 0, z))), 1.0, 1e-15);
      EXPECT_EQ(power(element_field(Pattern::half_wave_dipole, slant, dvec3(0, 0, z))), 0.0);
    }
  // Near the poles, the field of the dipole goes to zero as sin(theta) pi/4, without rounding errors.
  const double tilt = 1e-9;
  const Jones near = element_field(Pattern::half_wave_dipole, 0.0, {std::sin(tilt), 0, -std::cos(tilt)});
  EXPECT_NEAR(near.theta.real() / (std::sqrt(1.6409223770) * pi / 4 * tilt), 1.0, 1e-12);
}

TEST(AntennaHardCase, N49_ThetaByAtan2) {
  // acos(z) cannot resolve angles below 1e-8 rad. atan2(hypot, z) can, at both poles.
  EXPECT_NEAR(theta_phi({3e-12, 4e-12, 1.0}).x / 5e-12, 1.0, 1e-15);
  EXPECT_NEAR(theta_phi({3e-9, 4e-9, -1.0}).x, pi - 5e-9, 1e-15);
  EXPECT_EQ(theta_phi({0, 0, 1}), dvec2(0, 0));
  EXPECT_EQ(theta_phi({-0.0, -0.0, -2}), dvec2(pi, 0));
  EXPECT_NEAR(theta_phi({0, -3, 0}).y, -pi / 2, 1e-15);
}

TEST(Antenna, SphericalBasisIsRightHanded) {
  RandomStream random(7, 0);
  for (int i = 0; i < 100; ++i) {
    const dvec3 r = random_direction(random);
    EXPECT_LT(glm::length(glm::cross(theta_hat(r), phi_hat(r)) - r), 1e-14);
    EXPECT_LT(glm::length(theta_hat(r * 37.0) - theta_hat(r)), 1e-15);
  }
  EXPECT_EQ(theta_hat({0, 0, 1}), dvec3(1, 0, 0));
  EXPECT_EQ(theta_hat({0, 0, -1}), dvec3(-1, 0, 0));
  EXPECT_EQ(phi_hat({0, 0, -1}), dvec3(0, 1, 0));
  EXPECT_THROW(theta_hat({0, 0, 0}), ContractError);
}

TEST(Antenna, HalfWaveDipoleRadiatesAllItsPower) {
  // (1/4 pi) times the integral of the gain over the sphere is one. The midpoint rule in theta converges
  // fast.
  const int steps = 20000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double theta = (i + 0.5) * pi / steps;
    sum += power(element_field(Pattern::half_wave_dipole, 0.3, {std::sin(theta), 0, std::cos(theta)})) *
           std::sin(theta) * (pi / steps) / 2.0;
  }
  EXPECT_NEAR(sum, 1.0, 1e-8);
  EXPECT_NEAR(power(element_field(Pattern::half_wave_dipole, 0.0, {0, 1, 0})), 1.6409223770, 1e-12);
}

TEST(Antenna, PolarizationModel2) {
  AntennaArray array;
  array.polarization = Polarization::slant;
  array.columns = 2;
  ASSERT_EQ(array.port_count(), 4u);
  EXPECT_NEAR(array.slant(0), pi / 4, 1e-15);
  EXPECT_NEAR(array.slant(3), -pi / 4, 1e-15);
  const Jones field = element_field(Pattern::isotropic, array.slant(1), {1, 0, 0});
  EXPECT_NEAR(field.theta.real(), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(field.phi.real(), -std::sqrt(0.5), 1e-15);
  array.polarization = Polarization::vh;
  EXPECT_EQ(array.slant(2), 0.0);
  EXPECT_NEAR(array.slant(1), pi / 2, 1e-15);
}

TEST(Antenna, ElementsAreCentredInTheYZPlane) {
  AntennaArray array;
  array.rows = 3;
  array.columns = 2;
  array.polarization = Polarization::vh;
  array.row_spacing_m = 0.5;
  array.column_spacing_m = 0.2;
  dvec3 sum(0.0);
  for (uint32_t port = 0; port < array.port_count(); ++port) sum += array.element_position(port);
  EXPECT_LT(glm::length(sum), 1e-15);
  EXPECT_EQ(array.element_position(0), dvec3(0, -0.1, -0.5));
  EXPECT_EQ(array.element_position(1), array.element_position(0));    // the other polarization
  EXPECT_EQ(array.element_position(2), dvec3(0, 0.1, -0.5));          // next column along +y
  EXPECT_EQ(array.element_position(2 * 2 * 2), dvec3(0, -0.1, 0.5));  // the last row is the highest
  EXPECT_THROW(array.element_position(12), ContractError);
}

TEST(Antenna, TurningTheAntennaTurnsTheField) {
  // The field vector of the turned antenna is the turned field vector (TR 38.901, eq. 7.1-11).
  RandomStream random(3, 1);
  for (int i = 0; i < 50; ++i) {
    const dquat turn = orientation_from_yaw_pitch_roll(random.uniform(-3, 3), random.uniform(-1.5, 1.5),
                                                       random.uniform(-3, 3));
    const dvec3 world = random_direction(random);
    const dvec3 own = glm::conjugate(turn) * world;
    const Jones local = element_field(Pattern::half_wave_dipole, 0.4, own);
    const Jones global = turned_field(Pattern::half_wave_dipole, 0.4, turn, world);
    const dvec3 turned = turn * (local.theta.real() * theta_hat(own) + local.phi.real() * phi_hat(own));
    const dvec3 seen = global.theta.real() * theta_hat(world) + global.phi.real() * phi_hat(world);
    EXPECT_LT(glm::length(turned - seen), 1e-14);
  }
  // A dipole rolled by 90 degrees about x lies along y: the front sees horizontal polarization.
  const Jones rolled =
      turned_field(Pattern::half_wave_dipole, 0.0, orientation_from_yaw_pitch_roll(0, 0, pi / 2), {1, 0, 0});
  EXPECT_NEAR(std::abs(rolled.phi), std::sqrt(1.6409223770), 1e-12);
  EXPECT_NEAR(std::abs(rolled.theta), 0.0, 1e-15);
}

}  // namespace
}  // namespace greatx::rf
