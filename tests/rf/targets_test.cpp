// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests of targets as points: the radar equation through H, the frame of a target, the statistics of TR
// 38.901, and tables.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "rf/channel/frequency_response.h"
#include "rf/targets/echo_path.h"
#include "rf/targets/rcs_table.h"
#include "rf/targets/tr38901_target.h"
#include "tests/rf/channel_paths.h"

namespace greatx::rf {
namespace {

using testing::direction_at;

dvec3 random_direction(RandomStream& random) {
  return glm::normalize(dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
}

/// Returns the line of sight between two points in free space: its transfer turns the basis at one end into
/// that at the other, over the distance.
Path free_leg(const dvec3& from, const dvec3& to) {
  Path path;
  path.vertices = {from, to};
  path.length_m = glm::distance(from, to);
  path.delay_s = path.length_m / speed_of_light;
  path.departure = (to - from) / path.length_m;
  path.arrival = -path.departure;
  const dvec3 out[] = {theta_hat(path.departure), phi_hat(path.departure)};
  const dvec3 in[] = {theta_hat(path.arrival), phi_hat(path.arrival)};
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 2; ++column)
      path.transfer[2 * row + column] = glm::dot(in[row], out[column]) / path.length_m;
  return path;
}

/// Returns the vector that a matrix on the bases of two directions makes of an incident field vector.
dvec3 scattered(const ScatterMatrix& s, const Aspect& aspect, const dvec3& incident) {
  const double t = glm::dot(incident, theta_hat(aspect.to_source)),
               p = glm::dot(incident, phi_hat(aspect.to_source));
  return (s[0] * t + s[1] * p).real() * theta_hat(aspect.to_receiver) +
         (s[2] * t + s[3] * p).real() * phi_hat(aspect.to_receiver);
}

class Constant : public TargetModel {
 public:
  explicit Constant(const ScatterMatrix& s) : s_(s) {}
  ScatterMatrix scatter(const Aspect&, const EchoKey&) const override { return s_; }

 private:
  ScatterMatrix s_;
};

TEST(Targets, TheRadarEquationHoldsThroughH) {
  for (const double carrier_hz : {0.5e9, 3.5e9, 28e9, 77e9, 150e9})
    for (const double sigma_m2 : {1e-3, 1.0, 250.0}) {
      const dvec3 tx(0, 0, 10), target(30, 40, 12), rx(-50, 10, 3);
      const double amplitude = std::sqrt(sigma_m2 / (4.0 * pi));
      const Path out = free_leg(tx, target), home = free_leg(target, rx);
      // A target that keeps the plane of the vertical as it is, seen by vertical antennas.
      const Path echo = echo_path(out, home, 7, {amplitude, 0.0, 0.0, amplitude});
      ASSERT_EQ(echo.interactions.size(), 1u);
      EXPECT_EQ(echo.interactions[0].type, InteractionType::target);
      EXPECT_EQ(echo.interactions[0].element, 7u);
      EXPECT_EQ(echo.vertices.size(), 3u);
      const ArrayPose antenna = testing::antenna();
      const std::vector<Complex> h =
          frequency_response_fp64(std::span(&echo, 1), antenna, antenna, {carrier_hz, 1e6, 1, 1, 0.0});
      const double lambda = speed_of_light / carrier_hz;
      const double expected =
          lambda * lambda * sigma_m2 /
          (std::pow(4.0 * pi, 3) * std::pow(out.length_m, 2) * std::pow(home.length_m, 2));
      EXPECT_NEAR(std::norm(h[0]) / expected, 1.0, 1e-9);
    }
}

TEST(Targets, AReversedPathIsTheWayBack) {
  const Path there = free_leg({1, 2, 3}, {40, -20, 9}), back = free_leg({40, -20, 9}, {1, 2, 3});
  const Path turned = reversed(there);
  EXPECT_EQ(turned.vertices, back.vertices);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(std::abs(turned.transfer[i] - back.transfer[i]), 0.0, 1e-15);
  EXPECT_NEAR(glm::length(turned.departure - back.departure), 0.0, 1e-15);
}

/// The matrix of a turned target is that of its frame, written with vectors.
TEST(Targets, TheFrameOfATargetTurnsWithIt) {
  RandomStream random(5, 1);
  for (int i = 0; i < 200; ++i) {
    ScatterMatrix s;
    for (Complex& entry : s) entry = random.uniform(-1, 1);
    const dquat orientation = orientation_from_yaw_pitch_roll(
        random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3));
    const Aspect world{random_direction(random), random_direction(random)};
    const dvec3 incident = glm::cross(world.to_source, random_direction(random));  // any field across
    const ScatterMatrix turned = scatter_in_world(Constant(s), orientation, world, {});
    const dquat back = glm::conjugate(orientation);
    const dvec3 expected =
        orientation * scattered(s, {back * world.to_source, back * world.to_receiver}, back * incident);
    EXPECT_LT(glm::length(scattered(turned, world, incident) - expected), 1e-13);
  }
}

TEST(Targets, BistaticAngleAndBisector) {
  const Aspect back{{1, 0, 0}, {1, 0, 0}}, across{{1, 0, 0}, {0, 1, 0}}, forward{{1, 0, 0}, {-1, 0, 0}};
  EXPECT_EQ(back.bistatic_angle(), 0.0);
  EXPECT_NEAR(across.bistatic_angle(), pi / 2, 1e-15);
  EXPECT_NEAR(forward.bistatic_angle(), pi, 1e-15);
  EXPECT_NEAR(across.bisector().x, std::sqrt(0.5), 1e-15);
  EXPECT_EQ(forward.bisector(), dvec3(1, 0, 0));
}

// ------------------------------------------------------------------------------------------------ TR 38.901

Aspect towards(double theta_deg, double phi_deg) {
  const dvec3 d = direction_at(radians(theta_deg), radians(phi_deg));
  return {d, d};
}

TEST(TargetsTr38901, PatternsAreThoseOfTheTables) {
  const auto dbsm = tr38901_pattern_dbsm;
  EXPECT_NEAR(dbsm(Tr38901Kind::uav_small, towards(70, 20)), -12.81, 1e-12);
  EXPECT_NEAR(dbsm(Tr38901Kind::human, towards(10, 120)), -1.37, 1e-12);
  // The middle of each face has G_max.
  EXPECT_NEAR(dbsm(Tr38901Kind::uav_large, towards(90, 0)), 1.02, 1e-9);
  EXPECT_NEAR(dbsm(Tr38901Kind::uav_large, towards(90, 90)), 7.43, 1e-9);
  EXPECT_NEAR(dbsm(Tr38901Kind::uav_large, towards(90, 180)), 3.99, 1e-9);
  EXPECT_NEAR(dbsm(Tr38901Kind::uav_large, towards(90, -90)), 7.43, 1e-9);
  EXPECT_NEAR(dbsm(Tr38901Kind::uav_large, towards(0, 0)), 13.55, 1e-9);
  EXPECT_NEAR(dbsm(Tr38901Kind::uav_large, towards(180, 0)), 13.55, 1e-9);
  EXPECT_NEAR(dbsm(Tr38901Kind::vehicle, towards(71.75, 0)), 15.52, 1e-9);
  EXPECT_NEAR(dbsm(Tr38901Kind::vehicle, towards(79.70, -90)), 20.75, 1e-9);
  EXPECT_NEAR(dbsm(Tr38901Kind::agv, towards(75, 90)), 7.33, 1e-9);
  EXPECT_NEAR(dbsm(Tr38901Kind::human_2, towards(90, 180)), 2.14, 1e-9);
  // Half a beam width off, a lobe has lost 3 dB; far off, sigma_max.
  EXPECT_NEAR(dbsm(Tr38901Kind::vehicle, towards(71.75 + 29.13 / 2, 0)), 15.52 - 3.0, 1e-9);
  EXPECT_NEAR(dbsm(Tr38901Kind::vehicle, towards(71.75, 40.54 / 2)), 15.52 - 3.0, 1e-9);
  EXPECT_NEAR(dbsm(Tr38901Kind::vehicle, towards(170, 0)), 15.52 - 8.45, 1e-9);
  // A face wraps: azimuths of the right side are the same as those beyond 180 degrees.
  EXPECT_NEAR(dbsm(Tr38901Kind::agv, towards(75, -80)), dbsm(Tr38901Kind::agv, towards(75, 80)), 1e-9);
}

TEST(TargetsTr38901, BistaticTermsAreThoseOfTheEquations) {
  const double beta = radians(60.0);
  const Aspect around_front{direction_at(pi / 2, beta / 2), direction_at(pi / 2, -beta / 2)};
  EXPECT_NEAR(tr38901_pattern_dbsm(Tr38901Kind::human, around_front), -1.37 - 3.0 * std::sin(beta / 2), 1e-9);
  EXPECT_NEAR(tr38901_pattern_dbsm(Tr38901Kind::human_2, around_front),
              2.14 - 0.5714 * std::sin(0.05 * beta) + 5.0 * std::log10(std::cos(beta / 2)), 1e-9);
  // Forward scattering stops at the floor G_max - sigma_max.
  const Aspect forward{{1, 0, 0}, {-1, 0, 0}};
  EXPECT_NEAR(tr38901_pattern_dbsm(Tr38901Kind::human_2, forward), 2.14 - 7.7, 1e-9);
}

TEST(TargetsTr38901, DrawsHaveTheStatisticsOfTheReport) {
  for (size_t k = 0; k < tr38901_kinds.size(); ++k) {
    const auto kind = static_cast<Tr38901Kind>(k);
    const Tr38901Spread spread = tr38901_spread(kind);
    const Tr38901Target target(kind, 11, 3);
    constexpr int draws = 40000;
    double sum = 0.0, squares = 0.0, most = -1e9, co_sum = 0.0;
    double xpr = 0.0, xpr_squares = 0.0;
    const Aspect aspect = towards(90, 0);
    for (int i = 0; i < draws; ++i) {
      const EchoKey key{static_cast<uint64_t>(2 * i + 1), static_cast<uint64_t>(7 * i + 4), 0};
      const double db = target.small_scale_db(key);
      sum += db, squares += db * db, most = std::max(most, db);
      const ScatterMatrix s = target.scatter(aspect, key);
      EXPECT_NEAR(std::abs(s[0]), std::abs(s[3]), 1e-12);
      EXPECT_NEAR(std::abs(s[1]), std::abs(s[2]), 1e-12);
      co_sum += 4.0 * pi * std::norm(s[0]);
      const double ratio_db = 20.0 * std::log10(std::abs(s[0]) / std::abs(s[1]));
      xpr += ratio_db, xpr_squares += ratio_db * ratio_db;
    }
    const double mean = sum / draws, deviation = std::sqrt(squares / draws - mean * mean);
    EXPECT_NEAR(mean, -std::log(10.0) / 20.0 * spread.small_scale_db * spread.small_scale_db, 0.08);
    EXPECT_NEAR(deviation, spread.small_scale_db, 0.06);
    EXPECT_NEAR(most, spread.small_scale_most_db(), 1e-9);  // some of 40000 reach three deviations
    // The mean of sigma_S is 1, less what the cap takes.
    const double mean_db = 10.0 * std::log10(co_sum / draws) - tr38901_pattern_dbsm(kind, aspect);
    EXPECT_NEAR(mean_db, 0.0, 0.1) << tr38901_kinds[k];
    EXPECT_NEAR(xpr / draws, spread.xpr_mean_db, 0.15);
    EXPECT_NEAR(std::sqrt(xpr_squares / draws - std::pow(xpr / draws, 2)), spread.xpr_deviation_db, 0.1);
  }
}

TEST(TargetsTr38901, DrawsAreFunctionsOfSeedSequenceAndLegs) {
  const Tr38901Target a(Tr38901Kind::vehicle, 1, 0), same(Tr38901Kind::vehicle, 1, 0),
      other_seed(Tr38901Kind::vehicle, 2, 0), other_target(Tr38901Kind::vehicle, 1, 1);
  const Aspect aspect = towards(80, 10);
  const EchoKey key{3, 9, 0};
  EXPECT_EQ(a.scatter(aspect, key), same.scatter(aspect, key));
  EXPECT_NE(a.scatter(aspect, key), other_seed.scatter(aspect, key));
  EXPECT_NE(a.scatter(aspect, key), other_target.scatter(aspect, key));
  EXPECT_NE(a.scatter(aspect, key), a.scatter(aspect, {3, 9, 1}));
  EXPECT_EQ(a.scatter(aspect, {9, 3, 0}), transposed(a.scatter(aspect, key)));
  const ScatterMatrix back = a.scatter(aspect, {3, 3, 0});
  EXPECT_EQ(back, transposed(back));
}

// -------------------------------------------------------------------------------------------------- tables

/// Samples a function of four angles that is linear in each.
Complex linear(double a, double b) { return {0.3 + 0.2 * a, 0.1 - 0.4 * b}; }

TEST(TargetsTable, AMonostaticTableInterpolatesBetweenItsSamples) {
  const RcsTable::Grid grid{7, 12, 0.0};
  std::vector<ScatterMatrix> samples;
  for (uint32_t i = 0; i < grid.zeniths; ++i)
    for (uint32_t j = 0; j < grid.azimuths; ++j) {
      const Complex s = linear(pi * i / 6.0, 0.0);
      samples.push_back({s, 0.1 * s, 0.1 * s, -s});
    }
  const RcsTable table(grid, {}, samples, "t.csv", "");
  EXPECT_FALSE(table.bistatic());
  for (const double theta : {0.0, 0.2, 1.0, 2.5, pi}) {
    const dvec3 d = direction_at(theta, 2.0);
    const ScatterMatrix s = table.scatter({d, d}, {});
    EXPECT_NEAR(std::abs(s[0] - linear(theta, 0.0)), 0.0, 1e-14);
    EXPECT_NEAR(std::abs(s[3] + linear(theta, 0.0)), 0.0, 1e-14);
  }
  // A bistatic aspect uses the direction halfway.
  const ScatterMatrix halfway = table.scatter({direction_at(1.0, 2.0), direction_at(1.4, 2.0)}, {});
  EXPECT_NEAR(std::abs(halfway[0] - linear(1.2, 0.0)), 0.0, 1e-14);
}

TEST(TargetsTable, ABistaticTableInterpolatesOverFourAngles) {
  const RcsTable::Grid source{4, 5, radians(-180.0)}, receiver{3, 8, 0.0};
  std::vector<ScatterMatrix> samples;
  for (uint32_t i = 0; i < 4; ++i)
    for (uint32_t j = 0; j < 5; ++j)
      for (uint32_t k = 0; k < 3; ++k)
        for (uint32_t l = 0; l < 8; ++l) {
          const Complex s = linear(pi * i / 3.0, pi * k / 2.0) + 0.01 * double(j) + 0.001 * double(l);
          samples.push_back({s, 2.0 * s, 3.0 * s, 4.0 * s});
        }
  const RcsTable table(source, receiver, samples, "t.csv", "");
  EXPECT_TRUE(table.bistatic());
  // At samples, and halfway between azimuths; the last azimuth leads to the first.
  const auto at = [&](double ti, double pi_deg, double to, double po_deg) {
    return table.scatter({direction_at(ti, radians(pi_deg)), direction_at(to, radians(po_deg))}, {})[0];
  };
  EXPECT_NEAR(std::abs(at(pi / 3, -180.0 + 72.0, pi / 2, 45.0) - (linear(pi / 3, pi / 2) + 0.01 + 0.001)),
              0.0, 1e-12);
  EXPECT_NEAR(std::abs(at(1.0, -180.0 + 36.0, 2.0, 45.0 * 7.5) - (linear(1.0, 2.0) + 0.005 + 0.5 * 0.007)),
              0.0, 1e-12);
}

/// The error of a smooth function falls with the square of the step and stays within the bound.
TEST(TargetsTable, TheErrorStaysWithinItsBound) {
  double last = 1e9;
  for (const uint32_t zeniths : {19u, 37u, 73u}) {
    const RcsTable::Grid grid{zeniths, 4, 0.0};
    const auto truth = [](double theta) { return std::cos(5.0 * theta); };
    std::vector<ScatterMatrix> samples;
    for (uint32_t i = 0; i < zeniths; ++i)
      for (uint32_t j = 0; j < 4; ++j) samples.push_back({truth(pi * i / (zeniths - 1.0)), 0.0, 0.0, 0.0});
    const RcsTable table(grid, {}, samples, "t.csv", "");
    double worst = 0.0;
    for (int i = 0; i <= 1000; ++i) {
      const double theta = pi * i / 1000.0;
      const dvec3 d = direction_at(theta, 0.3);
      worst = std::max(worst, std::abs(table.scatter({d, d}, {})[0] - truth(theta)));
    }
    const double step = pi / (zeniths - 1.0);
    EXPECT_LT(worst, step * step * 25.0 / 8.0);
    EXPECT_LT(worst, 0.3 * last);
    last = worst;
  }
}

}  // namespace
}  // namespace greatx::rf
