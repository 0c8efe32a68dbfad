// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"
#include "rf/radar/signal/fft.h"

namespace greatx::rf {
namespace {

/// The sizes cover the radices of the template and other factors.
class RadarFft : public ::testing::TestWithParam<uint32_t> {};

TEST_P(RadarFft, IsTheSumThatItStandsForInEachLane) {
  const uint32_t size = GetParam();
  RandomStream random(1, 2, size);
  std::vector<std::complex<float>> signals[Fft::lanes], spectra[Fft::lanes];
  const std::complex<float>* in[Fft::lanes];
  std::complex<float>* out[Fft::lanes];
  for (uint32_t lane = 0; lane < Fft::lanes; ++lane) {
    for (uint32_t n = 0; n < size; ++n)
      signals[lane].emplace_back(static_cast<float>(random.uniform() - 0.5),
                                 static_cast<float>(random.uniform() - 0.5));
    spectra[lane].resize(size);
    in[lane] = signals[lane].data(), out[lane] = spectra[lane].data();
  }
  for (const auto& [direction, others] : {std::pair{Fft::Direction::forward, Fft::Others::factors},
                                          {Fft::Direction::backward, Fft::Others::factors},
                                          {Fft::Direction::forward, Fft::Others::chirp},
                                          {Fft::Direction::backward, Fft::Others::chirp}}) {
    const double sign = direction == Fft::Direction::forward ? -1.0 : 1.0;
    std::vector<Fft::Value> values(size), turned(size);
    Fft::gather(in, size, values.data());
    Fft(size, direction, others).transform(values.data(), turned.data());
    Fft::scatter(turned.data(), size, out);
    for (uint32_t lane = 0; lane < Fft::lanes; ++lane)
      for (uint32_t k = 0; k < size; ++k) {
        std::complex<double> sum(0.0);
        for (uint32_t n = 0; n < size; ++n)
          sum += std::complex<double>(signals[lane][n]) *
                 std::polar(1.0, sign * 2.0 * std::numbers::pi * double(uint64_t{k} * n % size) / size);
        // The rounding error is a few times 2^-24 sqrt(size/6) for each radix.
        ASSERT_LT(std::abs(sum - std::complex<double>(spectra[lane][k])), 1e-6 * std::sqrt(size))
            << "lane " << lane << ", " << k << " of " << size;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, RadarFft,
                         ::testing::Values(1, 2, 3, 5, 12, 15, 49, 56, 97, 128, 250, 384, 511),
                         ::testing::PrintToStringParamName());

}  // namespace
}  // namespace greatx::rf
