// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests what a fit predicts, its slopes, its losses and its split.
#include <complex>
#include <set>

#include <gmock/gmock.h>

#include "core/units.h"
#include "sim/fit/clock.h"
#include "tests/sim/fit_world.h"

namespace greatx::sim {
namespace {

using namespace sim::testing;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Complex = std::complex<double>;

/// Returns the amplitude of the direct path and of the ground's between two vertical isotropic elements: the
/// field is along theta, so that the ground reflects TM.
std::pair<Complex, Complex> two_rays(const dvec3& from, const dvec3& to, double permittivity,
                                     double conductivity) {
  const double wavelength = speed_of_light / fit_carrier_hz, k = 2.0 * pi / wavelength;
  const double across = std::hypot(to.x - from.x, to.y - from.y);
  const double direct = std::hypot(across, to.z - from.z), reflected = std::hypot(across, to.z + from.z);
  const Complex eta(permittivity, -conductivity / (2.0 * pi * fit_carrier_hz * vacuum_permittivity));
  const double cosine = (to.z + from.z) / reflected;
  const Complex a = std::sqrt(eta - 1.0 + cosine * cosine);
  const Complex gamma = (eta * cosine - a) / (eta * cosine + a);
  const auto ray = [&](double length) {
    return wavelength / (4.0 * pi) / length * std::polar(1.0, -k * length);
  };
  // theta_hat of both ends points downwards, and the reflection turns its vertical part over: at grazing
  // incidence gamma = -1 of the field along k x s is a reflected vertical field of opposite sign.
  return {ray(direct), gamma * ray(reflected)};
}

FitProblem ground_problem(FitSet set) {
  FitProblem problem;
  problem.sets = {std::move(set)};
  problem.parameters = {parameter("ground", FitProperty::permittivity, 1.5, 20.0),
                        parameter("ground", FitProperty::conductivity, 1e-3, 2.0)};
  return problem;
}

scene::Scene ground_alone() {
  test::TinyScene tiny;
  const uint32_t ground = tiny.material_as(flat_material("ground", 5.0, 0.05));
  tiny.object("ground", 0, ground).quad({-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0});
  return tiny.build();
}

TEST(FitModel, TwoRaysHaveTheClosedForm) {
  const double permittivity = 7.5, conductivity = 0.3;
  for (const bool coherent : {false, true}) {
    FitSet set = fit_set(FitQuantity::power_db, 20);
    set.coherent = coherent;
    set.band = {1, 1e6, false, 0, 1};
    const FitWorld world(ground_problem(set), ground_alone());
    const std::vector<uint32_t> links = world.all();
    ASSERT_EQ(links.size(), 20u);
    const std::vector<FitBlock> blocks =
        world.model().blocks(world.coordinates({permittivity, conductivity}), links, false);
    for (size_t i = 0; i < links.size(); ++i) {
      const auto [direct, reflected] = two_rays({-70, 0, 10}, set.points[i], permittivity, conductivity);
      const double expected =
          coherent ? std::norm(direct + reflected) : std::norm(direct) + std::norm(reflected);
      EXPECT_NEAR(blocks[i].residuals[0], decibels(expected), 1e-6) << i << " " << coherent;
    }
  }
}

TEST(FitModel, DelaySpreadsOfTwoRaysHaveTheClosedForm) {
  FitSet set = fit_set(FitQuantity::delay_spread_ns, 20);
  const FitWorld world(ground_problem(set), ground_alone());
  const std::vector<uint32_t> links = world.all();
  const std::vector<FitBlock> blocks = world.model().blocks(world.coordinates({7.5, 0.3}), links, false);
  for (size_t i = 0; i < links.size(); ++i) {
    const dvec3 from(-70, 0, 10), to = set.points[i];
    const auto [direct, reflected] = two_rays(from, to, 7.5, 0.3);
    const double p = std::norm(direct), q = std::norm(reflected);
    const double across = std::hypot(to.x - from.x, to.y - from.y);
    const double apart_ns =
        1e9 * (std::hypot(across, to.z + from.z) - std::hypot(across, to.z - from.z)) / speed_of_light;
    EXPECT_NEAR(blocks[i].residuals[0], std::sqrt(p * q) / (p + q) * apart_ns, 1e-6) << i;
  }
}

/// The taps hold the power of the band, and their delay spread tends to that of the paths in a wide band.
TEST(FitModel, TapsHoldTheResponse) {
  PathTerms terms;
  terms.amplitudes = {Complex(1e-3, 2e-4), Complex(-3e-4, 5e-4)};
  terms.delays_s = {40.0 / 80e6, 47.0 / 80e6};  // whole taps of 80 MHz
  FitBand band{64, 80e6 / 64, false, 0, 64};
  const Signal response = response_of(terms, band, 3.5e9, false), taps = taps_of(response, band, 1);
  double of_band = 0.0, of_taps = 0.0;
  for (size_t k = 0; k < 64; ++k) {
    of_band += std::norm(response.value[k]) / 64.0;
    of_taps += std::norm(taps.value[k]);
    const double expected = k == 40   ? std::abs(terms.amplitudes[0])
                            : k == 47 ? std::abs(terms.amplitudes[1])
                                      : 0.0;
    EXPECT_NEAR(std::abs(taps.value[k]), expected, 1e-15) << k;
  }
  EXPECT_NEAR(of_taps, of_band, 1e-18);
  const std::vector<Complex> back = response_of_taps(taps.value);
  for (size_t k = 0; k < 64; ++k) EXPECT_LT(std::abs(back[k] - response.value[k]), 1e-15);
  const Signal straight = [&] {  // e^{-j 2 pi (f_c + f) tau} summed directly
    Signal sum;
    for (uint32_t k = 0; k < 64; ++k) {
      const double hz = 3.5e9 + (k - 32.0) * band.spacing_hz;
      sum.value.push_back(terms.amplitudes[0] * std::polar(1.0, -2.0 * pi * hz * terms.delays_s[0]) +
                          terms.amplitudes[1] * std::polar(1.0, -2.0 * pi * hz * terms.delays_s[1]));
    }
    return sum;
  }();
  for (size_t k = 0; k < 64; ++k) EXPECT_LT(std::abs(straight.value[k] - response.value[k]), 1e-14);
}

struct SlopeCase {
  const char* name;
  FitQuantity quantity;
  bool coherent, from_response, complex_values;
};

/// Every slope of every quantity, against differences of the model as a whole.
TEST(FitModel, SlopesAreThoseOfDifferences) {
  const SlopeCase cases[] = {{"incoherent", FitQuantity::power_db, false, false, false},
                             {"coherent", FitQuantity::power_db, true, false, false},
                             {"spread of paths", FitQuantity::delay_spread_ns, false, false, false},
                             {"spread of the response", FitQuantity::delay_spread_ns, false, true, false},
                             {"cir", FitQuantity::cir, false, false, false},
                             {"cfr", FitQuantity::cfr, false, false, false},
                             {"complex", FitQuantity::cfr, false, false, true}};
  for (const SlopeCase& one : cases) {
    FitSet set = fit_set(one.quantity, 4);
    set.receiver = "ue/antenna";
    set.coherent = one.coherent;
    set.from_response = one.from_response;
    set.complex_values = one.complex_values;
    set.phase_known = true;
    if (one.complex_values) {
      set.values.clear();
      for (int i = 0; i < 4 * 32; ++i)
        set.responses.emplace_back(1e-4 * std::cos(1.0 * i), 1e-4 * std::sin(2.0 * i));
    } else if (set.width > 1) {
      std::ranges::fill(set.values, -80.0);
    }
    FitProblem problem = ground_problem(set);
    problem.parameters.push_back(parameter("wall", FitProperty::permittivity, 1.5, 20.0));
    problem.parameters.push_back(parameter("first pane", FitProperty::thickness, 0.005, 0.1));
    const auto unknown = [&](FitUnknownKind kind, double start) {
      FitUnknown more;
      more.kind = kind;
      more.range.low = -10.0, more.range.high = 10.0, more.range.start = start;
      problem.unknowns.push_back(more);
    };
    if (one.quantity != FitQuantity::delay_spread_ns) unknown(FitUnknownKind::scale_db, 1.5);
    if (one.complex_values || one.quantity == FitQuantity::cir) unknown(FitUnknownKind::clock_s, 3e-9);
    unknown(FitUnknownKind::orientation_deg, 7.0);
    unknown(FitUnknownKind::antenna_offset_m, 0.013);
    const FitWorld world(problem, fit_scene(true),
                         fit_scenario(", slant_deg: 30, pattern: half_wave_dipole"));
    const FitModel& model = world.model();
    const std::vector<uint32_t> links = world.all();
    ASSERT_EQ(links.size(), 4u) << one.name;
    std::vector<double> at = model.start(links);
    for (size_t v = 0; v < at.size(); ++v)
      at[v] = model.variables()[v].coordinate(model.variables()[v].start);
    const std::vector<FitBlock> blocks = model.blocks(at, links, true);
    for (size_t v = 0; v < at.size(); ++v) {
      // A clock is nanoseconds, the rest is of the order of 1.
      const double step = model.variables()[v].unit == "s" ? 1e-14 : 1e-5;
      std::vector<double> below = at, above = at;
      below[v] -= step, above[v] += step;
      const std::vector<FitBlock> low = model.blocks(below, links, false),
                                  high = model.blocks(above, links, false);
      for (size_t l = 0; l < links.size(); ++l) {
        const Eigen::VectorXd expected = (high[l].residuals - low[l].residuals) / (2.0 * step);
        const auto column = std::ranges::find(blocks[l].columns, v) - blocks[l].columns.begin();
        const bool depends = column < static_cast<ptrdiff_t>(blocks[l].columns.size());
        const Eigen::VectorXd slope =
            depends ? Eigen::VectorXd(blocks[l].slopes.col(column)) : Eigen::VectorXd::Zero(expected.size());
        const double scale = expected.cwiseAbs().maxCoeff(), noise = 1e-11 / step;
        EXPECT_LT((slope - expected).cwiseAbs().maxCoeff(), 2e-5 * scale + noise)
            << one.name << ": " << model.variables()[v].name << " link " << l << " scale " << scale;
      }
    }
  }
}

/// The weights of finite reflectors are factors of the fields, so that fields without them, times the weight,
/// are the fields of the solver, also with other materials.
TEST(FitModel, FiniteReflectorsAreFactors) {
  FitProblem problem = ground_problem(fit_set(FitQuantity::power_db, 10));
  problem.parameters.push_back(parameter("wall", FitProperty::permittivity, 1.5, 20.0));
  std::string scenario = fit_scenario();
  scenario.replace(scenario.find("finite_reflectors: off"), 22, "finite_reflectors: on");
  const FitWorld world(problem, fit_scene(true), scenario);
  const std::vector<double> values{9.0, 0.2, 7.0};
  const TransferSlopes fields(world.materials(), problem.parameters, values, false);
  const rf::RadioSurfaces surfaces = world.materials().surfaces(values);
  size_t weighted = 0;
  for (const FitLink& link : world.model().links()) {
    rf::FieldModel whole = link.radio->model().field_model();
    whole.world = link.world.get();
    whole.surfaces = &surfaces;
    ASSERT_TRUE(whole.effects.finite_reflectors);
    const FitFields got = fields.of(link);
    for (size_t t = 0; t < link.touched.size(); ++t) {
      rf::Complex expected[4];
      rf::path_transfer(link.paths[link.touched[t].path], whole, expected);
      double size = 0.0;
      for (const rf::Complex& entry : expected) size += std::abs(entry);
      for (size_t e = 0; e < 4; ++e) EXPECT_LT(std::abs(got.transfers[t][e] - expected[e]), 1e-12 * size);
      weighted += std::abs(link.touched[t].weight - 1.0) > 1e-3;
    }
  }
  EXPECT_GT(weighted, 5u);
}

TEST(FitModel, ClocksAndPhasesOfPositionsAreFound) {
  FitBand band{64, 1e6, false, 0, 64};
  std::vector<Complex> modelled, measured;
  RandomStream random(4, 4);
  for (int k = 0; k < 64; ++k) modelled.emplace_back(normal(random), normal(random));
  const double clock_s = 33.21e-9;
  const std::vector<Complex> turn = clock_turn(band, clock_s);
  for (int k = 0; k < 64; ++k) measured.push_back(std::polar(2.0, 0.7) * turn[k] * modelled[k]);
  EXPECT_NEAR(best_clock(band, modelled, measured, -200e-9, 200e-9), clock_s, 1e-14);
}

TEST(FitModel, LossesHaveTheirDerivatives) {
  for (const FitLossKind kind : {FitLossKind::squares, FitLossKind::huber, FitLossKind::cauchy}) {
    const FitLoss loss{kind, 1.7};
    for (const double x : {-5.0, -1.2, 0.0, 0.4, 1.6, 1.8, 30.0}) {
      const double h = 1e-5;
      EXPECT_NEAR(loss.slope(x), (loss.cost(x + h) - loss.cost(x - h)) / (2.0 * h), 1e-8) << x;
      EXPECT_NEAR(loss.curvature(x), (loss.slope(x + h) - loss.slope(x - h)) / (2.0 * h), 1e-8) << x;
      EXPECT_NEAR(loss.slope(x), loss.weight(x) * x, 1e-15) << x;
    }
  }
  EXPECT_EQ((FitLoss{FitLossKind::huber, 2.0}.cost(5.0)), 2.0 * (5.0 - 1.0));
}

TEST(FitSplit, WholeBlocksAreHeldOut) {
  const std::vector<dvec3> points = fit_points(500);
  const FitSplit split{5.0, 0.3, 7};
  const FitBlocks blocks = split_by_place(points, split);
  size_t held_out = 0;
  for (size_t b = 0; b < blocks.count(); ++b) held_out += blocks.held_out[b];
  EXPECT_EQ(held_out, static_cast<size_t>(std::round(0.3 * static_cast<double>(blocks.count()))));
  std::map<uint32_t, std::pair<int64_t, int64_t>> squares;
  for (size_t i = 0; i < points.size(); ++i) {
    const std::pair<int64_t, int64_t> square(std::floor(points[i].x / 5.0), std::floor(points[i].y / 5.0));
    const auto [at, is_new] = squares.try_emplace(blocks.of[i], square);
    EXPECT_EQ(at->second, square);
  }
  // The order of the positions, and positions in other squares, change nothing.
  std::vector<dvec3> reversed(points.rbegin(), points.rend());
  const FitBlocks again = split_by_place(reversed, split);
  for (size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(again.held_out[again.of[points.size() - 1 - i]], blocks.held_out[blocks.of[i]]);
  const FitBlocks other = split_by_place(points, {5.0, 0.3, 8});
  EXPECT_NE(std::vector<bool>(other.held_out), std::vector<bool>(blocks.held_out));
  EXPECT_FALSE(split_by_place(std::vector<dvec3>{{0, 0, 0}}, split).held_out[0]);
}

TEST(FitMaterials, KeepTheirDependenceOnFrequency) {
  scene::Scene scene = fit_scene(false);
  const double hz = 5e9;
  for (scene::Material& material : scene.materials)
    if (material.name == "wall") material.radio->layers[0].medium = *scene::itu_medium("concrete");
  const FitParameter of_wall[] = {parameter("wall", FitProperty::permittivity, 2.0, 9.0),
                                  parameter("wall", FitProperty::conductivity, 1e-3, 1.0)};
  const FitMaterials materials(scene, hz, of_wall);
  const uint32_t wall = materials.materials(0)[0];
  EXPECT_NEAR(materials.start()[0], 5.24, 1e-12);
  EXPECT_NEAR(materials.start()[1], 0.0462 * std::pow(5.0, 0.7822), 1e-12);
  const scene::RadioMedium medium = materials.material(wall, std::vector{6.5, 0.2}).layers[0].medium;
  const Complex at = scene::relative_permittivity(medium, hz, "wall"),
                above = scene::relative_permittivity(medium, 2.0 * hz, "wall");
  EXPECT_NEAR(at.real(), 6.5, 1e-12);
  EXPECT_NEAR(-at.imag() * 2.0 * pi * hz * vacuum_permittivity, 0.2, 1e-12);
  EXPECT_NEAR(above.imag() / at.imag(), std::pow(2.0, 0.7822 - 1.0), 1e-12);
}

TEST(FitMaterials, RefuseWhatCannotBeFitted) {
  const scene::Scene scene = fit_scene(true);
  const auto refused = [&](FitParameter one) {
    return [&scene, one] { FitMaterials(scene, fit_carrier_hz, std::span(&one, 1)); };
  };
  EXPECT_THAT(refused(parameter("gruond", FitProperty::permittivity, 2, 9)),
              ThrowsMessage<UserError>(HasSubstr(
                  "material: expected one of the scene's, found 'gruond' (did you mean 'ground'?)")));
  EXPECT_THAT(refused(parameter("ground", FitProperty::thickness, 0.1, 9)),
              ThrowsMessage<UserError>(HasSubstr(
                  "thickness: expected a material with a thickness, found the half-space 'ground'")));
  EXPECT_THAT(refused(parameter("ground", FitProperty::permittivity, 6, 9)),
              ThrowsMessage<UserError>(
                  HasSubstr("permittivity: bounds: expected bounds around the start 5, found [6, 9]")));
  EXPECT_THAT(refused(parameter("ground", FitProperty::scattering, 0, 0.9)),
              ThrowsMessage<UserError>(HasSubstr("scattering: start: expected a number above 0")));
  FitParameter layer = parameter("first pane", FitProperty::permittivity, 2, 9);
  layer.layer = 2;
  EXPECT_THAT(refused(layer), ThrowsMessage<UserError>(
                                  HasSubstr("layer: expected 0 to 0, a layer of 'first pane', found 2")));
  FitParameter both = parameter("ground", FitProperty::permittivity, 2, 9);
  both.materials.push_back("wall");
  EXPECT_THAT(
      refused(both),
      ThrowsMessage<UserError>(HasSubstr("start: expected a value, since the materials start from 5 and 4")));
  both.range.start = 4.5;
  const FitMaterials shared(scene, fit_carrier_hz, std::span(&both, 1));
  EXPECT_EQ(shared.materials(0).size(), 2u);
  EXPECT_EQ(shared.surfaces(std::vector{6.0}).surface(shared.materials(0)[1]).front[0].eta.real(), 6.0);
}

}  // namespace
}  // namespace greatx::sim
