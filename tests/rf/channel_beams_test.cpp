// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares beams with the array factor, and with the powers that all beams together must have.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/error.h"
#include "rf/channel/beams.h"
#include "rf/channel/pair_amplitudes.h"
#include "rf/channel/statistics.h"
#include "tests/rf/channel_paths.h"

namespace greatx::rf {
namespace {

using testing::antenna;
using testing::plain_path;
using testing::random_paths;

constexpr double beam_carrier_hz = 28e9;

ArrayPose panel(uint32_t rows, uint32_t columns, Polarization polarization, double spacing_wl = 0.5) {
  ArrayPose end = antenna(Pattern::isotropic, polarization);
  end.array.rows = rows;
  end.array.columns = columns;
  end.array.row_spacing_m = end.array.column_spacing_m = spacing_wl * speed_of_light / beam_carrier_hz;
  return end;
}

std::vector<Complex> all_weights(const DftBeams& beams) {
  std::vector<Complex> weights;
  for (uint64_t beam = 0; beam < beams.count(); ++beam)
    for (const Complex& w : beams.weights(beam)) weights.push_back(w);
  return weights;
}

TEST(Beams, AreTheArrayFactor) {
  // |sin(N x)/sin(x)|^2/N with x half of the phase from element to element, for N elements along +y.
  constexpr uint32_t n = 8;
  const ArrayPose tx = panel(1, n, Polarization::v), rx = antenna();
  const DftBeams beams = dft_beams(tx.array, {1, 4});
  ASSERT_EQ(beams.count(), 32u);
  const double friis = std::pow(wavelength_factor(beam_carrier_hz), 2);
  for (int step = -40; step <= 40; ++step) {
    const double cosine = step / 41.0;
    Path path = plain_path(1e-7);
    path.departure = {std::sqrt(1.0 - cosine * cosine), cosine, 0.0};
    const std::vector<double> gains =
        beam_gains(std::span(&path, 1), tx, rx, beam_carrier_hz, all_weights(beams));
    for (uint32_t beam = 0; beam < 32; ++beam) {
      const double x = pi * (0.5 * cosine + beam / 32.0);
      const double factor =
          std::abs(std::sin(x)) < 1e-12 ? n : std::pow(std::sin(n * x) / std::sin(x), 2) / n;
      EXPECT_NEAR(gains[beam] / friis, factor, 1e-11) << step << ' ' << beam;
    }
  }
}

TEST(Beams, OfABasisCarryAllPower) {
  for (const Polarization polarization : {Polarization::v, Polarization::slant}) {
    const ArrayPose tx = panel(2, 3, polarization, 0.7), rx = panel(1, 2, Polarization::vh);
    const DftBeams beams = dft_beams(tx.array, {1, 1});
    const std::vector<Path> paths = random_paths(7, 1e-6, 5);
    std::vector<double> gains = beam_gains(paths, tx, rx, beam_carrier_hz, all_weights(beams));
    // Of the four phases between the polarizations, 0 and a half turn make a basis, and so do the other two.
    const size_t stride = beams.phases() == 4 ? 2 : 1;
    const double mean = link_statistics(paths, path_powers(paths, tx, rx, beam_carrier_hz)).path_gain;
    for (size_t first = 0; first < stride; ++first) {
      double sum = 0.0;
      for (size_t beam = first; beam < gains.size(); beam += stride) sum += gains[beam];
      EXPECT_NEAR(sum / mean, static_cast<double>(beams.ports()), 1e-12);
    }
    EXPECT_LE(*std::max_element(gains.begin(), gains.end()), mean * static_cast<double>(beams.ports()));
  }
}

TEST(Beams, AreSumsOverPortsPathByPath) {
  const ArrayPose tx = panel(2, 2, Polarization::slant), rx = panel(1, 2, Polarization::vh);
  std::vector<Path> paths = random_paths(5, 1e-6, 6);
  const DftBeams beams = dft_beams(tx.array, {2, 3});
  const std::vector<Complex> weights = all_weights(beams);
  const std::vector<double> gains = beam_gains(paths, tx, rx, beam_carrier_hz, weights);
  PairAmplitudes amplitudes(tx, rx, beam_carrier_hz);
  std::vector<Complex> a(amplitudes.pairs());
  for (size_t beam = 0; beam < beams.count(); ++beam) {
    double power = 0.0;
    for (const Path& path : paths) {
      amplitudes(path, a.data());
      for (size_t u = 0; u < 4; ++u) {
        Complex sum = 0.0;
        for (size_t s = 0; s < 8; ++s) sum += a[u * 8 + s] * weights[beam * 8 + s];
        power += std::norm(sum) / 4.0;
      }
    }
    EXPECT_NEAR(gains[beam], power, 1e-13 * power);
  }
  testing::shuffle(paths, 1);
  EXPECT_EQ(beam_gains(paths, tx, rx, beam_carrier_hz, weights), gains);
}

TEST(Beams, NumbersAndNorms) {
  const DftBeams beams = dft_beams(panel(2, 3, Polarization::slant).array, {2, 4});
  EXPECT_EQ(beams.count(), 4u * 12u * 4u);
  EXPECT_EQ(beams.ports(), 12u);
  // Beam (row_beam 3, column_beam 5, phase 2) of 4 and 12.
  const std::vector<Complex> w = beams.weights((3 * 12 + 5) * 4 + 2);
  for (size_t row = 0; row < 2; ++row)
    for (size_t column = 0; column < 3; ++column)
      for (size_t p = 0; p < 2; ++p) {
        const double turns = 3.0 * static_cast<double>(row) / 4 + 5.0 * static_cast<double>(column) / 12 +
                             0.5 * static_cast<double>(p);
        EXPECT_LT(
            std::abs(w[(row * 3 + column) * 2 + p] - std::polar(1.0, 2.0 * pi * turns) / std::sqrt(12.0)),
            1e-15);
      }
  EXPECT_THROW(beams.weights(beams.count()), ContractError);
  EXPECT_TRUE(beam_gains({}, panel(2, 3, Polarization::slant), antenna(), beam_carrier_hz, w) ==
              std::vector<double>{0.0});
}

}  // namespace
}  // namespace greatx::rf
