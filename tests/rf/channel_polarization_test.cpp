// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks antennas with complex patterns: imported patterns of circular polarization.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "core/random.h"
#include "rf/antenna/antenna.h"
#include "rf/channel/statistics.h"
#include "rf/field/field.h"
#include "rf/geometry/geometry.h"
#include "tests/rf/channel_paths.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::exhaustive_candidates;
using testing::HandScene;
using testing::solve_paths;

constexpr double carrier_hz = 3.5e9;

/// Returns an antenna of gain 1 that radiates the same circular polarization in all directions. At +x
/// theta-hat is -z and phi-hat is +y: the real part of (1, -j) e^{j omega t} turns from -z to +y, which is
/// right-handed about the direction of propagation (IEEE Std 145).
ArrayPose circular(bool right_handed, const dquat& orientation = {1.0, 0.0, 0.0, 0.0}) {
  const Complex quarter(0.0, right_handed ? -std::sqrt(0.5) : std::sqrt(0.5));
  const PatternTable::Grid grid{5, 8, 0.0};
  ArrayPose end;
  end.array.pattern = {
      Pattern::imported, PolarizationModel::model_2,
      std::make_shared<PatternTable>(
          grid, std::vector<Jones>(size_t{grid.zeniths} * grid.azimuths, Jones{std::sqrt(0.5), quarter}))};
  end.orientation = orientation;
  return end;
}

std::vector<Path> solve(const HandScene& hand, const dvec3& tx, const dvec3& rx, uint32_t depth) {
  const FacetWorld world(hand.scene);
  const RadioSurfaces surfaces(hand.scene, carrier_hz);
  std::vector<Path> paths;
  for (const GeometricPath& path :
       solve_paths(world, tx, rx, exhaustive_candidates(world.facet_count(), depth)))
    paths.push_back(path_field(path, {&world, &surfaces}, dvec3(0.0), dvec3(0.0)));
  return paths;
}

double gain(const Path& path, const ArrayPose& tx, const ArrayPose& rx) {
  return path_powers(std::span(&path, 1), tx, rx, carrier_hz)[0];
}

double friis(double distance) { return std::pow(speed_of_light / carrier_hz / (4 * pi * distance), 2); }

TEST(CircularPolarization, OneHandednessSeesItself) {
  // The result does not depend on the positions and orientations of the ends: a roll of a circularly
  // polarized antenna only turns the phase.
  RandomStream random(52, 1);
  const auto any = [&] { return random.uniform(-1, 1); };
  for (int i = 0; i < 50; ++i) {
    HandScene hand;
    const dvec3 tx(any(), any(), any()), rx = tx + 10.0 * dvec3(any(), any(), any());
    const Path direct = solve(hand, tx, rx, 0).at(0);
    const dquat a = orientation_from_yaw_pitch_roll(3 * any(), any(), 3 * any());
    const dquat b = orientation_from_yaw_pitch_roll(3 * any(), any(), 3 * any());
    const double full = friis(direct.length_m);
    EXPECT_NEAR(gain(direct, circular(true, a), circular(true, b)) / full, 1.0, 1e-12);
    EXPECT_NEAR(gain(direct, circular(false, a), circular(false, b)) / full, 1.0, 1e-12);
    EXPECT_LT(gain(direct, circular(true, a), circular(false, b)) / full, 1e-24);
    EXPECT_LT(gain(direct, circular(false, a), circular(true, b)) / full, 1e-24);
    // A linear antenna receives half of the power.
    EXPECT_NEAR(gain(direct, circular(true, a), testing::antenna()) / full, 0.5, 1e-12);
    EXPECT_NEAR(gain(direct, testing::antenna(), circular(true, b)) / full, 0.5, 1e-12);
  }
}

TEST(CircularPolarization, AConductorTurnsTheHandedness) {
  HandScene hand;
  hand.material("conductor", 1.0, 1e30);
  hand.ground(1000.0);
  const auto paths = solve(hand, {0, 0, 50}, {3, 1, 40}, 1);
  ASSERT_EQ(paths.size(), 2u);
  const Path& echo = paths[0].interactions.empty() ? paths[1] : paths[0];
  const double full = friis(echo.length_m);
  EXPECT_NEAR(gain(echo, circular(true), circular(false)) / full, 1.0, 1e-9);
  EXPECT_LT(gain(echo, circular(true), circular(true)) / full, 1e-9);
}

TEST(ReciprocityHardCase, N52_CircularPolarizationByItsOwnPatterns) {
  // Imported patterns describe the radiation of a port; the same patterns serve for reception.
  HandScene hand;
  hand.material("conductor", 1.0, 1e30);
  hand.room({7, 5, 3});
  const dvec3 a(1.1, 2.2, 0.7), b(5.3, 3.1, 2.2);
  const auto there = solve(hand, a, b, 2), back = solve(hand, b, a, 2);
  const dquat turn = orientation_from_yaw_pitch_roll(0.7, 0.2, -0.4);
  for (const bool right : {false, true})
    for (const ArrayPose& other : {circular(true), circular(false), testing::antenna()}) {
      const ChannelGrid grid{carrier_hz, 1e6, 5, 1, 1e-3};
      const auto forward = frequency_response_fp64(there, circular(right, turn), other, grid);
      const auto backward = frequency_response_fp64(back, other, circular(right, turn), grid);
      double scale = 0.0;
      for (const Complex& value : forward) scale = std::max(scale, std::abs(value));
      for (size_t k = 0; k < forward.size(); ++k) EXPECT_LT(std::abs(forward[k] - backward[k]) / scale, 1e-9);
    }
}

}  // namespace
}  // namespace greatx::rf
