// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/dispersion.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/phase.h"
#include "core/units.h"
#include "rf/geometry/geometry.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::exhaustive_candidates;
using testing::HandScene;
using testing::solve_paths;

ChannelGrid two_gigahertz(double carrier_hz, uint32_t subcarriers = 201) {
  return {carrier_hz, 2e9 / (subcarriers - 1), subcarriers, 1, 1e-3};
}

double frequency_of(const ChannelGrid& grid, uint32_t k) {
  return grid.carrier_hz + grid.subcarrier_number(k) * grid.subcarrier_spacing_hz;
}

/// Holds a scene with its field model at the carrier of the grid.
struct SampledModel {
  FacetWorld world;
  RadioSurfaces surfaces;
  FieldModel field;
  SampledModel(const HandScene& hand, const ChannelGrid& grid)
      : world(hand.scene), surfaces(hand.scene, grid.carrier_hz), field{&world, &surfaces} {}
};

/// Holds the coefficients of a slab of ITU concrete, directly from eq. 43 and 44.
struct Slab {
  Complex reflected_te, reflected_tm, through_te, through_tm;
};
Slab concrete_slab(double frequency_hz, double thickness_m, double cosine) {
  const Complex j(0.0, 1.0);
  const double ghz = frequency_hz / 1e9;
  const Complex eta(5.24, -0.0462 * std::pow(ghz, 0.7822) / (2.0 * pi * frequency_hz * vacuum_permittivity));
  const Complex a = std::sqrt(eta - 1.0 + cosine * cosine);
  const Complex q = 2.0 * pi * thickness_m * frequency_hz / speed_of_light * a;
  const Complex once = std::exp(-j * q), twice = std::exp(-2.0 * j * q);
  const Complex te = (cosine - a) / (cosine + a), tm = (eta * cosine - a) / (eta * cosine + a);
  const Complex echoes_te = 1.0 - te * te * twice, echoes_tm = 1.0 - tm * tm * twice;
  return {te * (1.0 - twice) / echoes_te, tm * (1.0 - twice) / echoes_tm, (1.0 - te * te) * once / echoes_te,
          (1.0 - tm * tm) * once / echoes_tm};
}

TEST(Dispersion, SlabOverTwoGigahertz) {
  // Checks transmission through a wall of 10 cm at 60 degrees from its normal, and reflection by the wall,
  // against eq. 43 and 44 at every subcarrier. The phase of the wall counts once: behind the wall, the wave
  // differs from the free wave by the factor T e^{jkd cos}.
  constexpr double thickness_m = 0.1;
  for (const double carrier : {5e9, 28e9}) {
    const ChannelGrid grid = two_gigahertz(carrier);
    HandScene hand;
    hand.itu_material("concrete", thickness_m);
    hand.ground(100.0);
    const SampledModel model(hand, grid);
    const dvec3 tx(0, 0, 3), behind(6.0 * std::sqrt(3.0), 0, -3), before(6.0 * std::sqrt(3.0), 0, 3);
    const std::vector<Path> paths{
        path_field({{{InteractionType::transmission, 0}}, {tx, 0.5 * (tx + behind), behind}, 12.0},
                   model.field, {}, {}),
        path_field(
            {{{InteractionType::reflection, 0}}, {tx, dvec3(3.0 * std::sqrt(3.0), 0, 0), before}, 12.0},
            model.field, {}, {})};
    const Dispersion dispersion(hand.scene, model.field, {}, grid);
    const double cosine = 0.5, delay = 12.0 / speed_of_light;
    for (const Polarization polarization : {Polarization::v, Polarization::h}) {
      ArrayPose end;
      end.array.polarization = polarization;
      double flat_error = 0.0;
      for (const bool through : {true, false}) {
        const std::span<const Path> path(&paths[through ? 0 : 1], 1);
        const auto found =
            frequency_response_fp64(path, dispersion.spectra(path, *model.field.world), end, end, grid);
        const auto flat = frequency_response_fp64(path, end, end, grid);
        for (uint32_t k = 0; k < grid.subcarriers; ++k) {
          const double f = frequency_of(grid, k);
          const Slab slab = concrete_slab(f, thickness_m, cosine);
          const Complex sheet = unit_phasor(f / speed_of_light * thickness_m * cosine);
          // V is TM on a horizontal wall. H is TE, and phi-hat changes its sign because the arrival points
          // back.
          const bool v = polarization == Polarization::v;
          const Complex wall = through ? (v ? slab.through_tm : -slab.through_te) * sheet
                                       : (v ? slab.reflected_tm : -slab.reflected_te);
          const Complex expected =
              speed_of_light / carrier / (4 * pi) / 12.0 * wall * unit_phasor(-turns_of(f, delay));
          EXPECT_LT(std::abs(found[k] - expected) / std::abs(expected), 1e-9) << f;
          flat_error = std::max(flat_error, std::abs(flat[k] - expected) / std::abs(expected));
        }
      }
      EXPECT_GT(flat_error, 0.1);  // error without the option
    }
  }
}

std::vector<Path> room_paths(const HandScene& hand, const FieldModel& field) {
  std::vector<Path> paths;
  for (const GeometricPath& path :
       solve_paths(*field.world, {1.1, 2.2, 0.7}, {5.3, 3.1, 2.2},
                   exhaustive_candidates(static_cast<uint32_t>(hand.scene.facets.size()), 2)))
    paths.push_back(path_field(path, field, dvec3(1, 2, 3), dvec3(-3, 0, 1)));
  return paths;
}

TEST(Dispersion, AtTheCarrierItIsTheCarriersField) {
  HandScene hand;
  hand.itu_material("plasterboard", 0.013);
  hand.room({7, 5, 3});
  const ChannelGrid grid = two_gigahertz(28e9, 64);
  const SampledModel model(hand, grid);
  const Dispersion dispersion(hand.scene, model.field, {}, grid);
  for (const Path& path : room_paths(hand, model.field)) {
    const TransferSpectrum spectrum = dispersion.spectrum(path, *model.field.world);
    ASSERT_EQ(spectrum.size(), 64u);
    EXPECT_EQ(std::memcmp(spectrum[32].data(), path.transfer, sizeof path.transfer), 0);
  }
}

TEST(Dispersion, WhatDoesNotDependOnFrequencyStays) {
  HandScene hand;
  hand.material("lossless ground", 5.0);
  hand.room({7, 5, 3});
  const ChannelGrid grid{3.5e9, 10e6, 37, 2, 1e-3};
  const SampledModel model(hand, grid);
  const std::vector<Path> paths = room_paths(hand, model.field);
  ArrayPose tx, rx;
  tx.array = {.pattern = Pattern::half_wave_dipole,
              .polarization = Polarization::slant,
              .rows = 2,
              .columns = 2,
              .row_spacing_m = 0.04,
              .column_spacing_m = 0.05};
  rx.array = {.polarization = Polarization::vh, .columns = 3, .column_spacing_m = 0.043};
  tx.orientation = orientation_from_yaw_pitch_roll(0.7, 0.2, -0.4);
  const auto spectra = Dispersion(hand.scene, model.field, {}, grid).spectra(paths, *model.field.world);
  const auto flat = frequency_response_fp64(paths, tx, rx, grid);
  const auto found = frequency_response_fp64(paths, spectra, tx, rx, grid);
  ASSERT_EQ(flat.size(), found.size());
  double largest = 0.0, error = 0.0;
  for (size_t i = 0; i < flat.size(); ++i) {
    largest = std::max(largest, std::abs(flat[i]));
    error = std::max(error, std::abs(flat[i] - found[i]));
  }
  EXPECT_LT(error, 1e-14 * largest);
}

TEST(Dispersion, AnyOrderOfPathsGivesTheSameBits) {
  HandScene hand;
  hand.itu_material("glass", 0.006);
  hand.room({7, 5, 3});
  const ChannelGrid grid = two_gigahertz(10e9, 33);
  const SampledModel model(hand, grid);
  std::vector<Path> paths = room_paths(hand, model.field);
  for (int i = 0; i < 40; ++i) paths.push_back(Path(paths[i % 20]));
  auto spectra = Dispersion(hand.scene, model.field, {}, grid).spectra(paths, *model.field.world);
  spectra.back()[7][0] *= 1.5;  // this path differs from others only in its spectrum
  const auto forward = frequency_response_fp64(paths, spectra, {}, {}, grid);
  std::reverse(paths.begin(), paths.end());
  std::reverse(spectra.begin(), spectra.end());
  const auto backward = frequency_response_fp64(paths, spectra, {}, {}, grid);
  EXPECT_EQ(std::memcmp(forward.data(), backward.data(), forward.size() * sizeof forward[0]), 0);
  spectra.pop_back();
  EXPECT_THROW(frequency_response_fp64(paths, spectra, {}, {}, grid), ContractError);
}

TEST(Dispersion, AirChangesOverTheBand) {
  // 1 km at 50 to 52 GHz lies on the slope of the oxygen complex.
  HandScene hand;
  const ChannelGrid grid = two_gigahertz(51e9, 5);
  SampledModel model(hand, grid);
  const Weather weather{.rain_mm_h = 10.0};
  model.field.effects.gas = model.field.effects.rain = true;
  model.field.attenuation = path_attenuation(weather, grid.carrier_hz, {true, true, false});
  const Path path = path_field({{}, {dvec3(0.0), dvec3(1000, 0, 0)}, 1000.0}, model.field, {}, {});
  const TransferSpectrum spectrum =
      Dispersion(hand.scene, model.field, weather, grid).spectrum(path, *model.field.world);
  for (uint32_t k = 0; k < 5; ++k) {
    const PathAttenuation air = path_attenuation(weather, frequency_of(grid, k), {true, true, false});
    EXPECT_NEAR(-20.0 * std::log10(std::abs(spectrum[k][0]) * 1000.0), air.gas + air.rain_v, 1e-10);
    EXPECT_NEAR(-20.0 * std::log10(std::abs(spectrum[k][3]) * 1000.0), air.gas + air.rain_h, 1e-10);
  }
  EXPECT_GT(std::abs(spectrum[0][0]) / std::abs(spectrum[4][0]), 1.05);
}

TEST(Dispersion, ABandThatLeavesAMaterialsRowsIsRefused) {
  HandScene hand;
  hand.itu_material("brick", 0.24);  // rows for 1 to 40 GHz and from 110 GHz on
  hand.ground(10.0);
  const ChannelGrid grid = two_gigahertz(39.5e9, 11);
  const SampledModel model(hand, grid);
  try {
    Dispersion(hand.scene, model.field, {}, grid);
    FAIL() << "40.5 GHz lies in the gap";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("brick"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("40.1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace greatx::rf
