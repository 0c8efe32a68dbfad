// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Arrays over a wide band: each element has its own delay (ArrayPose::beam_squint).
#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "rf/channel/taps.h"
#include "tests/rf/channel_paths.h"

namespace greatx::rf {
namespace {

using testing::antenna;
using testing::plain_path;
using testing::random_paths;
using testing::Wide;
using testing::wide_phasor;

ArrayPose with_squint(ArrayPose end, bool on = true) {
  end.beam_squint = on;
  return end;
}

/// An array with two polarizations whose elements stand at no regular places.
ArrayPose scattered_array() {
  ArrayPose end = antenna(Pattern::isotropic, Polarization::vh);
  end.array.positions_m = {{0.1, -0.3, 0.2}, {0.0, 0.0, 0.0}, {-0.4, 0.25, 0.05}};
  end.orientation = glm::angleAxis(0.7, glm::normalize(dvec3(1, 2, 3)));
  return end;
}
ArrayPose row_of_four() {
  ArrayPose end = antenna();
  end.array.columns = 4;
  end.array.column_spacing_m = 0.15;
  return end;
}

dvec3 place(const ArrayPose& end, uint32_t port) {
  return end.orientation * end.array.element_position(port);
}

/// The largest difference of two responses relative to the largest value.
double largest_difference(const std::vector<Complex>& a, const std::vector<Complex>& b) {
  double difference = 0.0, peak = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    peak = std::max(peak, std::abs(b[i]));
  }
  return difference / peak;
}

/// Sums the paths directly: every pair of elements has its own delay, and each frequency its own wavelength.
Wide direct_sum(const std::vector<Path>& paths, const ArrayPose& tx, const ArrayPose& rx, uint32_t u,
                uint32_t s, const ChannelGrid& grid, uint32_t k) {
  const double frequency_hz = grid.carrier_hz + grid.subcarrier_number(k) * grid.subcarrier_spacing_hz;
  Wide sum = 0.0L;
  for (const Path& path : paths) {
    // At a single element the response has no phase of an array: it serves as the amplitude.
    const Path one[] = {path};
    ArrayPose from = tx, to = rx;
    from.array.positions_m = to.array.positions_m = {dvec3(0.0)};
    from.array.rows = from.array.columns = to.array.rows = to.array.columns = 1;
    const ImpulseResponse impulse = impulse_response(one, from, to, grid.carrier_hz);
    const uint32_t pols = tx.array.polarization_count();
    const Complex amplitude =
        Complex(impulse.amplitude[(u % rx.array.polarization_count()) * pols + s % pols]);
    const double lead_s =
        (glm::dot(path.arrival, place(rx, u)) + glm::dot(path.departure, place(tx, s))) / speed_of_light;
    sum += Wide(amplitude.real(), amplitude.imag()) / wide_phasor(grid.carrier_hz, path.delay_s) *
           wide_phasor(frequency_hz, path.delay_s - lead_s);
  }
  return sum;
}

TEST(BeamSquint, IsTheSumOverTheDelaysOfAllPairsOfElements) {
  // 300 paths are more than a chunk; 77 subcarriers are no whole number of blocks.
  const auto paths = random_paths(300, 2e-6, 51);
  const ArrayPose tx = row_of_four(), rx = scattered_array();
  const ChannelGrid grid{3.5e9, 5e6, 77, 1, 1e-3};
  const auto found = frequency_response_fp64(paths, with_squint(tx), with_squint(rx), grid);
  ASSERT_EQ(found.size(), 6u * 4 * 77);
  double peak = 0.0;
  for (const Complex& value : found) peak = std::max(peak, std::abs(value));
  for (uint32_t u = 0; u < 6; ++u)
    for (uint32_t s = 0; s < 4; ++s)
      for (uint32_t k = 0; k < 77; k += 19) {
        const Wide expected = direct_sum(paths, tx, rx, u, s, grid, k);
        const Complex value = found[(u * 4 + s) * 77 + k];
        // The amplitudes of the direct sum are rounded to complex64.
        EXPECT_LT(std::abs(Wide(value.real(), value.imag()) - expected) / peak, 1e-6L) << u << s << k;
      }
}

TEST(BeamSquint, OnePathTurnsWithTheFrequencyToARounding) {
  const Path path = plain_path(1e-6);
  const ArrayPose tx = row_of_four(), rx = antenna();
  const ChannelGrid grid{28e9, 1e6, 1025, 1, 1e-3};
  const auto squinting = frequency_response_fp64({&path, 1}, with_squint(tx), with_squint(rx), grid);
  const auto narrow = frequency_response_fp64({&path, 1}, tx, rx, grid);
  for (uint32_t s = 0; s < 4; ++s)
    for (uint32_t k = 0; k < 1025; ++k) {
      const double lead_s = glm::dot(path.departure, place(tx, s)) / speed_of_light;
      const Complex turn = unit_phasor(turns_of(grid.subcarrier_number(k) * 1e6, lead_s));
      const Complex expected = narrow[s * 1025 + k] * turn;
      EXPECT_LT(std::abs(squinting[s * 1025 + k] - expected), 4e-15 * std::abs(expected)) << s << " " << k;
    }
}

TEST(BeamSquint, StaysBelowItsBoundAndVanishesAtTheCarrier) {
  const auto paths = random_paths(1, 1e-6, 52);
  const ArrayPose tx = row_of_four(), rx = scattered_array();
  const ChannelGrid grid{3.5e9, 1e6, 101, 1, 1e-3};
  const auto squinting = frequency_response_fp64(paths, with_squint(tx), with_squint(rx), grid);
  const auto narrow = frequency_response_fp64(paths, tx, rx, grid);
  const double reach_m = tx.array.reach() + rx.array.reach();
  double most = 0.0;
  for (size_t i = 0; i < narrow.size(); ++i) {
    const double f = grid.subcarrier_number(static_cast<uint32_t>(i % 101)) * 1e6;
    const double error = std::abs(squinting[i] - narrow[i]) / std::abs(narrow[i]);
    const double bound = 2.0 * std::sin(pi * std::abs(f) * reach_m / speed_of_light);
    EXPECT_LE(error, bound + 1e-14) << i;
    if (bound > 0.0) most = std::max(most, error / bound);
  }
  EXPECT_GT(most, 0.1);  // the bound is not far from what happens
}

TEST(BeamSquint, OneElementAtTheOriginChangesNoBit) {
  const auto paths = random_paths(200, 3e-6, 53);
  const ArrayPose tx = antenna(Pattern::isotropic, Polarization::vh), rx = antenna();
  const ChannelGrid grid{28e9, 120e3, 100, 2, 1e-3};
  const auto squinting = frequency_response_fp64(paths, with_squint(tx), with_squint(rx), grid);
  EXPECT_EQ(squinting, frequency_response_fp64(paths, tx, rx, grid));
}

TEST(BeamSquint, AnyOrderOfPathsGivesTheSameBits) {
  auto paths = random_paths(500, 3e-6, 54);
  const ChannelGrid grid{28e9, 120e3, 40, 2, 1e-3};
  const auto first =
      frequency_response(paths, with_squint(row_of_four()), with_squint(scattered_array()), grid);
  testing::shuffle(paths, 2);
  const auto second =
      frequency_response(paths, with_squint(row_of_four()), with_squint(scattered_array()), grid);
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof first[0]), 0);
}

TEST(BeamSquint, ASpectrumThatDoesNotChangeIsTheTransfer) {
  const auto paths = random_paths(150, 3e-6, 55);
  const ChannelGrid grid{28e9, 120e3, 33, 1, 1e-3};
  std::vector<TransferSpectrum> spectra;
  for (const Path& path : paths) {
    const Complex* t = path.transfer;
    spectra.emplace_back(33, std::array<Complex, 4>{t[0], t[1], t[2], t[3]});
  }
  EXPECT_LT(largest_difference(frequency_response_fp64(paths, spectra, with_squint(row_of_four()),
                                                       with_squint(scattered_array()), grid),
                               frequency_response_fp64(paths, with_squint(row_of_four()),
                                                       with_squint(scattered_array()), grid)),
            1e-13);
}

TEST(BeamSquint, ATapStandsAtTheDelayOfItsPairOfElements) {
  // Elements 3 m apart along the path, sampled at c/3 m: each is one tap later than the next.
  Path path = plain_path(0.0);
  ArrayPose tx = antenna();
  tx.array.positions_m = {{6.0, 0.0, 0.0}, {3.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  const TapGrid grid{3.5e9, speed_of_light / 3.0, 0, 16, 1, 1e-3};
  path.delay_s = 5.0 / grid.bandwidth_hz;
  const auto taps = channel_taps_fp64({&path, 1}, with_squint(tx), with_squint(antenna()), grid);
  const double amplitude = speed_of_light / 3.5e9 / (4 * pi);
  for (uint32_t s = 0; s < 3; ++s)
    for (uint32_t tap = 0; tap < 16; ++tap)
      EXPECT_NEAR(std::abs(taps[s * 16 + tap]) / amplitude, tap == 3 + s ? 1.0 : 0.0, 1e-12) << s << tap;
}

TEST(BeamSquint, ApproachesElementsThatAreSolvedApart) {
  // A line of sight between two arrays: the exact delays are those of the distances of elements. The wave's
  // curvature is left, which falls as the distance grows; without squint the error stays.
  const ArrayPose tx = row_of_four(), rx = row_of_four();
  const auto error_at = [&](double distance_m, bool squint) {
    const dvec3 far = distance_m * glm::normalize(dvec3(0.3, 0.8, 0.2));
    Path path = plain_path(distance_m / speed_of_light);
    path.departure = glm::normalize(far);
    path.arrival = -path.departure;
    const ChannelGrid grid{3.5e9, 4e6, 101, 1, 1e-3};
    const auto found =
        frequency_response_fp64({&path, 1}, with_squint(tx, squint), with_squint(rx, squint), grid);
    const double amplitude = speed_of_light / grid.carrier_hz / (4 * pi);
    double error = 0.0;
    for (uint32_t u = 0; u < 4; ++u)
      for (uint32_t s = 0; s < 4; ++s)
        for (uint32_t k = 0; k < 101; ++k) {
          const double delay_s = glm::distance(place(tx, s), far + place(rx, u)) / speed_of_light;
          const double f = grid.carrier_hz + grid.subcarrier_number(k) * grid.subcarrier_spacing_hz;
          const Complex exact(wide_phasor(f, delay_s));
          error += std::norm(found[(u * 4 + s) * 101 + k] / amplitude - exact);
        }
    return std::sqrt(error / static_cast<double>(found.size()));
  };
  EXPECT_LT(error_at(1e3, true), 0.05);
  EXPECT_LT(error_at(1e5, true), 5e-4);
  EXPECT_GT(error_at(1e5, false), 0.1);
}

}  // namespace
}  // namespace greatx::rf
