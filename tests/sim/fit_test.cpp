// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests fits in a world whose materials are known.
#include <complex>

#include <gmock/gmock.h>

#include "core/units.h"
#include "tests/sim/fit_world.h"

namespace greatx::sim {
namespace {

using namespace sim::testing;
using Complex = std::complex<double>;

FitUnknown unknown(FitUnknownKind kind, double low, double high,
                   FitUnknown::Each each = FitUnknown::Each::file) {
  FitUnknown one;
  one.kind = kind;
  one.range.low = low, one.range.high = high;
  one.each = each;
  return one;
}

/// Powers of ground and wall, with an unknown scale.
FitProblem two_materials(size_t points) {
  FitProblem problem;
  problem.sets = {fit_set(FitQuantity::power_db, points)};
  problem.parameters = {parameter("ground", FitProperty::permittivity, 1.5, 30.0),
                        parameter("wall", FitProperty::permittivity, 1.5, 30.0)};
  problem.unknowns = {unknown(FitUnknownKind::scale_db, -100.0, 100.0)};
  problem.starts = 1;
  return problem;
}

TEST(Fit, RecoversTheTruthWithoutNoise) {
  FitWorld world(two_materials(60), fit_scene(false));
  world.measure({9.0, 6.0, 12.5}, 0.0, 1);
  const std::vector<uint32_t> links = world.all();
  const FitState state = world.fitted(links);
  EXPECT_TRUE(state.converged);
  EXPECT_NEAR(state.coordinates[0], 9.0, 1e-5);
  EXPECT_NEAR(state.coordinates[1], 6.0, 1e-5);
  EXPECT_NEAR(state.coordinates[2], 12.5, 1e-6);
  // Before: the scene's materials, with the scale that suits them best.
  EXPECT_EQ(state.before[0], 5.0);
  EXPECT_EQ(state.before[1], 4.0);
  EXPECT_NEAR(state.before[2], 12.5, 1.0);
}

/// Over many draws of the noise, the errors over the stated deviations have the deviation 1, with each loss,
/// and with deviations that are given as well as estimated. 60 draws of 3 variables tell 1 from 0.8 and 1.25
/// with three deviations of their own.
TEST(Fit, StatedDeviationsAreThoseOfTheErrors) {
  const std::vector<double> truth{9.0, 6.0, 12.5};
  FitWorld world(two_materials(80), fit_scene(false));
  for (const FitLossKind kind : {FitLossKind::squares, FitLossKind::huber, FitLossKind::cauchy}) {
    world.problem().loss = {kind, kind == FitLossKind::cauchy ? 2.385 : 1.345};
    for (const bool given : {true, false}) {
      double squares = 0.0;
      size_t count = 0, within = 0;
      for (uint64_t seed = 0; seed < 60; ++seed) {
        world.problem().sets[0].sigma.reset();
        if (given) world.problem().sets[0].sigma = 0.1;
        world.measure(truth, 0.1, seed);
        const std::vector<uint32_t> links = world.all();
        const FitState state = world.fitted(links);
        const FitAssessment assessment = world.assessed(state, links);
        for (size_t v = 0; v < truth.size(); ++v) {
          const double error =
              (state.coordinates[v] - truth[v]) / assessment.estimates[v].deviation_of_residuals;
          squares += error * error;
          within += std::abs(state.coordinates[v] - truth[v]) < 2.0 * assessment.estimates[v].deviation;
          ++count;
        }
      }
      const double deviation = std::sqrt(squares / static_cast<double>(count));
      EXPECT_GT(deviation, 0.8) << static_cast<int>(kind) << given;
      EXPECT_LT(deviation, 1.25) << static_cast<int>(kind) << given;
      EXPECT_GT(within, 9 * count / 10) << static_cast<int>(kind) << given;
    }
  }
}

/// A cause that positions of one block share makes the deviations of residuals too small; those of blocks are
/// right.
TEST(Fit, DeviationsOfBlocksHoldCommonCauses) {
  const std::vector<double> truth{9.0, 6.0, 12.5};
  FitWorld world(two_materials(240), fit_scene(false));
  const FitSplit split{10.0, 0.0, 1};
  const FitBlocks blocks = split_by_place(world.problem().sets[0].points, split);
  double of_residuals = 0.0, of_blocks = 0.0;
  const size_t draws = 40;
  for (uint64_t seed = 0; seed < draws; ++seed) {
    world.measure(truth, 0.2, seed);
    RandomStream random(seed, 3);
    std::vector<double> common(blocks.count());
    for (double& of : common) of = 0.7 * normal(random);
    for (size_t i = 0; i < blocks.of.size(); ++i) world.problem().sets[0].values[i] += common[blocks.of[i]];
    world.make_model();
    const std::vector<uint32_t> links = world.all();
    ASSERT_EQ(links.size(), blocks.of.size());
    const FitState state = world.fitted(links);
    const FitAssessment assessment = assess(world.model(), FitSolver(world.model(), links), state, blocks.of);
    const FitEstimate& scale = assessment.estimates[2];
    ASSERT_FALSE(std::isnan(scale.deviation_of_blocks));
    const double error = state.coordinates[2] - truth[2];
    of_residuals += error * error / (scale.deviation_of_residuals * scale.deviation_of_residuals * draws);
    of_blocks += error * error / (scale.deviation_of_blocks * scale.deviation_of_blocks * draws);
  }
  EXPECT_GT(std::sqrt(of_residuals), 1.8);
  EXPECT_LT(std::sqrt(of_blocks), 1.5);
  EXPECT_GT(std::sqrt(of_blocks), 0.7);
}

TEST(Fit, RobustLossesWithstandOutliers) {
  const std::vector<double> truth{9.0, 6.0, 12.5};
  FitWorld world(two_materials(200), fit_scene(false));
  double errors[3] = {};
  for (uint64_t seed = 0; seed < 10; ++seed) {
    world.measure(truth, 0.3, seed);
    for (size_t i = 0; i < 200; i += 10) world.problem().sets[0].values[i] -= 15.0;  // one in ten is blocked
    world.make_model();
    const std::vector<uint32_t> links = world.all();
    for (const FitLossKind kind : {FitLossKind::squares, FitLossKind::huber, FitLossKind::cauchy}) {
      world.problem().loss = {kind, kind == FitLossKind::cauchy ? 2.385 : 1.345};
      const FitState state = world.fitted(links);
      errors[static_cast<size_t>(kind)] += std::abs(state.coordinates[2] - truth[2]) / 10.0;
    }
  }
  EXPECT_GT(errors[0], 0.5);
  EXPECT_LT(errors[1], 0.25 * errors[0]);
  EXPECT_LT(errors[2], 0.1 * errors[0]);
}

/// Complex responses with a scale for all, and a clock and a phase for each position.
TEST(Fit, FindsClocksPhasesAndScale) {
  FitSet set = fit_set(FitQuantity::cfr, 24);
  set.complex_values = true;
  set.values.clear();
  set.responses.assign(24 * 32, Complex(1e-6));
  FitProblem problem = two_materials(1);
  problem.sets = {set};
  problem.unknowns.push_back(unknown(FitUnknownKind::clock_s, -300e-9, 300e-9, FitUnknown::Each::position));
  FitWorld world(problem, fit_scene(false));
  // The response is made from path gains by an independent sum.
  const rf::RadioSurfaces surfaces = world.materials().surfaces(std::vector{9.0, 6.0});
  RandomStream random(8, 1);
  for (uint32_t l = 0; l < world.model().links().size(); ++l) {
    const FitLink& link = world.model().links()[l];
    rf::FieldModel fields = link.fields;
    fields.surfaces = &surfaces;
    const double clock_s = random.uniform(-250e-9, 250e-9), phase = random.uniform(0.0, 2.0 * pi);
    for (uint32_t k = 0; k < 32; ++k) {
      const double hz = (k - 16.0) * 2.5e6;
      Complex sum = 0.0;
      for (const rf::Path& path : link.paths) {
        Complex transfer[4];
        rf::path_transfer(path, fields, transfer);
        // Vertical elements meet the theta components alone.
        sum +=
            speed_of_light / fit_carrier_hz / (4.0 * pi) * transfer[0] *
            std::polar(1.0, -2.0 * pi * (std::fmod(fit_carrier_hz * path.delay_s, 1.0) + hz * path.delay_s));
      }
      const Complex noise(1e-3 * normal(random), 1e-3 * normal(random));
      world.problem().sets[0].responses[link.position * 32 + k] =
          std::pow(10.0, -7.0 / 20.0) * std::polar(1.0, phase - 2.0 * pi * hz * clock_s) *
          (sum + std::abs(sum) * noise);
    }
  }
  world.make_model();
  const std::vector<uint32_t> links = world.all();
  const FitState state = world.fitted(links);
  const FitAssessment assessment = world.assessed(state, links);
  EXPECT_TRUE(state.converged);
  const double truth[] = {9.0, 6.0, -7.0};
  for (size_t v = 0; v < 3; ++v) {
    EXPECT_NEAR(state.coordinates[v], truth[v], 4.0 * assessment.estimates[v].deviation) << v;
    EXPECT_LT(assessment.estimates[v].deviation, 0.05) << v;
  }
  EXPECT_NEAR(state.sigmas[0], 1e-3, 2e-4);
}

/// One clock for all positions of power delay profiles, in dB above a floor.
TEST(Fit, FindsTheClockOfProfiles) {
  FitSet set = fit_set(FitQuantity::cir, 24);
  FitProblem problem = two_materials(1);
  problem.sets = {set};
  problem.unknowns.push_back(unknown(FitUnknownKind::clock_s, -100e-9, 100e-9));
  FitWorld world(problem, fit_scene(false));
  const double clock_s = 31.7e-9;
  const std::vector<double> truth{9.0, 6.0, 4.0, clock_s};
  // Measurements at 0 dB and a floor 200 dB below make the residual the level itself.
  world.problem().sets[0].floor_db = 200.0;
  world.make_model();
  const std::vector<FitBlock> blocks = world.model().blocks(truth, world.all(), false);
  for (size_t i = 0; i < 24; ++i)
    for (size_t tap = 0; tap < 32; ++tap)
      world.problem().sets[0].values[i * 32 + tap] = blocks[i].residuals[static_cast<Eigen::Index>(tap)];
  world.problem().sets[0].floor_db = 40.0;
  world.make_model();
  const FitState state = world.fitted(world.all());
  EXPECT_NEAR(state.coordinates[0], 9.0, 1e-3);
  EXPECT_NEAR(state.coordinates[1], 6.0, 1e-3);
  EXPECT_NEAR(state.coordinates[2], 4.0, 1e-4);
  EXPECT_NEAR(state.coordinates[3], clock_s, 1e-13);
}

/// An antenna that is turned and off its place, seen by fields that add.
TEST(Fit, FindsOrientationAndOffset) {
  FitSet set = fit_set(FitQuantity::power_db, 120);
  set.coherent = true;
  set.receiver = "ue/antenna";
  FitProblem problem;
  problem.sets = {set};
  problem.parameters = {parameter("ground", FitProperty::permittivity, 2.0, 30.0)};
  problem.unknowns = {unknown(FitUnknownKind::orientation_deg, -40.0, 40.0),
                      unknown(FitUnknownKind::antenna_offset_m, -0.03, 0.03)};
  problem.starts = 12;
  FitWorld world(problem, fit_scene(false), fit_scenario(", pattern: tr38901"));
  const std::vector<double> truth{8.0, 11.0, 0.012, -0.02, 0.008};
  world.measure(truth, 0.0, 1);
  const FitState state = world.fitted(world.all());
  for (size_t v = 0; v < truth.size(); ++v)
    EXPECT_NEAR(state.coordinates[v], truth[v], 1e-4 * std::max(1.0, std::abs(truth[v]))) << v;
}

/// The cost of a slab has many minima. A run from the scene's value ends in the nearest one; draws find the
/// lowest.
TEST(Fit, SearchFindsTheLowestMinimum) {
  FitProblem problem;
  problem.sets = {fit_set(FitQuantity::power_db, 60)};
  problem.parameters = {parameter("wall", FitProperty::thickness, 0.02, 0.3)};
  problem.starts = 1;
  FitWorld world(problem, fit_scene(false, true));
  world.measure({0.21}, 0.05, 1);
  const std::vector<uint32_t> links = world.all();
  const FitState near = world.fitted(links);
  world.problem().starts = 12;
  const FitState best = world.fitted(links);
  EXPECT_GT(std::abs(near.coordinates[0] - 0.21), 0.01);
  EXPECT_NEAR(best.coordinates[0], 0.21, 1e-3);
}

TEST(Fit, SaysWhatTheMeasurementsDoNotTell) {
  FitProblem problem;
  problem.sets = {fit_set(FitQuantity::power_db, 80)};
  problem.parameters = {parameter("ground", FitProperty::permittivity, 1.5, 30.0),
                        parameter("away", FitProperty::permittivity, 1.5, 30.0),
                        parameter("first pane", FitProperty::conductivity, 1e-3, 1.0),
                        parameter("second pane", FitProperty::conductivity, 1e-3, 1.0),
                        parameter("ground", FitProperty::roughness, 0.0, 0.1),
                        parameter("wall", FitProperty::permittivity, 3.0, 5.0),
                        parameter("wall", FitProperty::conductivity, 1e-3, 1.0)};
  problem.parameters[6].range.prior = FitPrior{0.02, 0.3};
  problem.starts = 4;  // draws move what has no effect, and the end moves it back
  FitWorld world(problem, fit_scene(true));
  world.measure({9.0, 3.0, 0.05, 0.05, 0.0, 7.0, 0.02}, 0.3, 5);
  const std::vector<uint32_t> links = world.all();
  const FitAssessment assessment = world.assessed(world.fitted(links), links);
  const auto verdict = [&](size_t v) { return assessment.estimates[v].verdict; };
  EXPECT_EQ(verdict(0), FitVerdict::determined);
  EXPECT_EQ(verdict(1), FitVerdict::untouched);
  EXPECT_EQ(assessment.estimates[1].value, 3.0);
  EXPECT_EQ(assessment.positions[1], 0u);
  EXPECT_EQ(assessment.shares[1], 0.0);
  EXPECT_GT(assessment.shares[2], 0.99);         // every path passes the panes
  EXPECT_EQ(verdict(4), FitVerdict::no_effect);  // the effect is off
  EXPECT_EQ(assessment.estimates[4].value, 0.0);
  EXPECT_EQ(verdict(5), FitVerdict::at_bound);
  EXPECT_EQ(verdict(6), FitVerdict::by_prior);
  ASSERT_FALSE(assessment.pairs.empty());
  EXPECT_EQ(assessment.pairs[0].first, 2u);
  EXPECT_EQ(assessment.pairs[0].second, 3u);
  EXPECT_LT(assessment.pairs[0].correlation, -0.99);
  ASSERT_FALSE(assessment.directions.empty());
  const FitDirection& weakest = assessment.directions[0];
  EXPECT_LT(weakest.singular_value, 0.01);
  EXPECT_NEAR(std::abs(weakest.parts[2]), std::sqrt(0.5), 0.05);
  EXPECT_NEAR(weakest.parts[2], -weakest.parts[3], 0.05);
}

/// A prior and the measurements add like two measurements.
TEST(Fit, PriorsCountAsMeasurements) {
  FitProblem problem;
  problem.sets = {fit_set(FitQuantity::power_db, 80)};
  problem.sets[0].sigma = 0.5;
  problem.loss = {FitLossKind::squares, 1.0};
  problem.parameters = {parameter("ground", FitProperty::permittivity, 1.5, 30.0)};
  problem.starts = 1;
  FitWorld world(problem, fit_scene(false));
  world.measure({9.0}, 0.0, 1);
  const std::vector<uint32_t> links = world.all();
  const FitSolver solver(world.model(), links);
  const double information = solver.sums(world.fitted(links)).weighted(0, 0);
  world.problem().parameters[0].range.prior = FitPrior{9.1, 1.0 / std::sqrt(information)};
  world.make_model();
  // The prior knows as much as the measurements, so the result lies in the middle, as far as it is linear.
  const FitState state = world.fitted(links);
  EXPECT_NEAR(state.coordinates[0], 9.05, 2e-3);
  const FitAssessment assessment = world.assessed(state, links);
  EXPECT_NEAR(assessment.estimates[0].deviation_of_residuals, 1.0 / std::sqrt(2.0 * information),
              0.5 / std::sqrt(2.0 * information));
}

/// A state that was written and read again goes on with the same bits: nothing else is remembered.
TEST(Fit, AStateIsAllThatAFitRemembers) {
  FitProblem problem = two_materials(40);
  problem.starts = 3;
  FitWorld world(problem, fit_scene(false));
  world.measure({9.0, 6.0, 12.5}, 0.3, 3);
  const std::vector<uint32_t> links = world.all();
  const FitState straight = world.fitted(links);
  FitState state = FitSolver(world.model(), links).begin();
  while (!state.done) {
    world.make_model();
    FitState copy = state;
    FitSolver(world.model(), links).step(copy);
    state = copy;
  }
  EXPECT_EQ(state.coordinates, straight.coordinates);
  EXPECT_EQ(state.sigmas, straight.sigmas);
  EXPECT_EQ(state.before, straight.before);
}

}  // namespace
}  // namespace greatx::sim
