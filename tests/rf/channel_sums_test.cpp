// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "rf/channel/row_sums.h"
#include "rf/channel/statistics.h"
#include "tests/rf/channel_paths.h"

namespace greatx::rf {
namespace {

using testing::antenna;
using testing::random_paths;

template <typename Value>
bool same_bits(const std::vector<Value>& a, const std::vector<Value>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)) == 0;
}

struct Sums {
  std::vector<Complex> amplitudes;
  std::vector<double> phasors, sums;
};

Sums random_sums(size_t rows, size_t stride, size_t terms, uint32_t stream) {
  RandomStream random(5, stream);
  Sums sums{std::vector<Complex>(rows * stride), std::vector<double>(terms * 2 * sum_lanes),
            std::vector<double>(rows * 2 * sum_lanes)};
  for (Complex& value : sums.amplitudes) value = {random.uniform(-1, 1), random.uniform(-1, 1)};
  for (double& value : sums.phasors) value = random.uniform(-1, 1);
  for (double& value : sums.sums) value = random.uniform(-1, 1);
  return sums;
}

TEST(RowSums, EveryProcessorGivesTheSameBits) {
  for (const auto& [rows, terms] : {std::pair<size_t, size_t>{1, 1}, {2, 20}, {7, 3}, {64, 128}, {3, 0}}) {
    const size_t stride = terms + 2;
    Sums plain = random_sums(rows, stride, terms, static_cast<uint32_t>(rows));
    Sums generic = plain, wide = plain;
    for (size_t row = 0; row < rows; ++row)
      for (size_t term = 0; term < terms; ++term)
        for (size_t lane = 0; lane < sum_lanes; ++lane) {
          const Complex a = plain.amplitudes[row * stride + term];
          const double *p = plain.phasors.data() + term * 2 * sum_lanes, *q = p + sum_lanes;
          double* sum = plain.sums.data() + row * 2 * sum_lanes;
          sum[lane] += a.real() * p[lane] - a.imag() * q[lane];
          sum[sum_lanes + lane] += a.real() * q[lane] + a.imag() * p[lane];
        }
    add_rows_generic(generic.amplitudes.data(), stride, rows, generic.phasors.data(), terms,
                     generic.sums.data());
    EXPECT_TRUE(same_bits(generic.sums, plain.sums)) << rows << " " << terms;
    if (const AddRows avx2 = add_rows_avx2()) {
      avx2(wide.amplitudes.data(), stride, rows, wide.phasors.data(), terms, wide.sums.data());
      EXPECT_TRUE(same_bits(wide.sums, plain.sums)) << rows << " " << terms;
    }
  }
}

TEST(SetProducts, EveryProcessorGivesTheSameBits) {
  for (const size_t blocks : {size_t{0}, size_t{1}, size_t{7}}) {
    const size_t stride = 3 * 2 * sum_lanes;
    RandomStream random(6, static_cast<uint32_t>(blocks));
    std::vector<Complex> firsts(blocks), places(sum_lanes);
    for (Complex& value : firsts) value = {random.uniform(-1, 1), random.uniform(-1, 1)};
    for (Complex& value : places) value = {random.uniform(-1, 1), random.uniform(-1, 1)};
    std::vector<double> plain(blocks * stride + 1, 7.0), generic = plain, wide = plain;
    for (size_t block = 0; block < blocks; ++block)
      for (size_t lane = 0; lane < sum_lanes; ++lane) {
        const Complex a = firsts[block], p = places[lane];
        plain[block * stride + lane] = a.real() * p.real() - a.imag() * p.imag();
        plain[block * stride + sum_lanes + lane] = a.real() * p.imag() + a.imag() * p.real();
      }
    set_products_generic(firsts.data(), blocks, places.data(), generic.data(), stride);
    EXPECT_TRUE(same_bits(generic, plain)) << blocks;
    if (const SetProducts avx2 = set_products_avx2()) {
      avx2(firsts.data(), blocks, places.data(), wide.data(), stride);
      EXPECT_TRUE(same_bits(wide, plain)) << blocks;
    }
  }
}

/// 5,000 subcarriers of 1 GHz: the phasors of most groups follow from those of others.
TEST(Response, PhasorsAreExactAllAlongAWideBand) {
  std::vector<Path> paths = random_paths(1, 2e-6, 11);
  const ChannelGrid grid{28e9, 2e5, 5000, 1, 0.0};
  const auto found = frequency_response_fp64(paths, antenna(), antenna(), grid);
  const double amplitude = std::abs(found[0]);
  const std::complex<long double> first(found[0].real(), found[0].imag());
  double worst = 0.0;
  for (size_t k = 0; k < found.size(); ++k) {
    const long double turns =
        -static_cast<long double>(k) * 2e5L * static_cast<long double>(paths[0].delay_s);
    const long double angle = 2.0L * std::numbers::pi_v<long double> * (turns - std::floor(turns));
    const auto expected = first * std::complex<long double>(std::cos(angle), std::sin(angle));
    worst = std::max(worst, static_cast<double>(std::abs(
                                std::complex<long double>(found[k].real(), found[k].imag()) - expected)));
  }
  EXPECT_LT(worst / amplitude, 1e-14);
  EXPECT_GT(worst, 0.0);
}

TEST(ResponseInto, WritesABatchOfLinksInPlace) {
  ArrayPose tx = antenna(Pattern::isotropic, Polarization::slant);
  tx.array.columns = 3;
  tx.array.column_spacing_m = 0.04;
  const ArrayPose rx = antenna();
  const ChannelGrid grid{3.5e9, 30e3, 21, 2, 1e-3};
  const size_t size = response_size(tx, rx, grid);
  ASSERT_EQ(size, 6u * 2 * 21);
  const size_t counts[] = {0, 1, 5, 128, 129, 300};
  std::vector<std::complex<float>> expected;
  std::vector<std::vector<Path>> links;
  for (const size_t count : counts) {
    links.push_back(random_paths(count, 2e-6, static_cast<uint32_t>(count)));
    const auto response = frequency_response(links.back(), tx, rx, grid);
    expected.insert(expected.end(), response.begin(), response.end());
  }
  for (const uint32_t threads : {1u, 2u}) {
    std::vector<std::complex<float>> batch(links.size() * size, 7.0f);
    parallel_for(links.size(), threads, [&](size_t i) {
      frequency_response_into(links[i], {}, tx, rx, grid, std::span(batch).subspan(i * size, size));
    });
    EXPECT_TRUE(same_bits(batch, expected));
  }
}

TEST(ResponseInto, ThreadsOfALinkChangeNoBit) {
  for (const bool squint : {false, true}) {
    ArrayPose tx = antenna(Pattern::isotropic, Polarization::slant), rx = antenna();
    tx.array.columns = 16;
    tx.array.column_spacing_m = 0.04;
    tx.beam_squint = rx.beam_squint = squint;
    const ChannelGrid grid{3.5e9, 30e3, 130, 1, 0.0};
    const auto paths = random_paths(300, 2e-6, 8);  // three chunks of the sum
    const auto expected = frequency_response(paths, tx, rx, grid);
    ASSERT_GT(paths.size() * 32 * 130, size_t{1} << 20) << "fewer products are not shared";
    for (const uint32_t threads : {2u, 3u, 7u}) {
      std::vector<std::complex<float>> found(expected.size());
      frequency_response_into(paths, {}, tx, rx, grid, found, PathSelection::all, threads);
      EXPECT_TRUE(same_bits(found, expected)) << squint << " " << threads;
    }
  }
}

TEST(ResponseInto, ASpectrumThatDoesNotChangeIsTheTransfer) {
  const auto paths = random_paths(50, 2e-6, 3);  // 200 terms: two chunks of the sum
  const ChannelGrid grid{3.5e9, 30e3, 13, 1, 1e-3};
  std::vector<TransferSpectrum> spectra;
  for (const Path& path : paths) spectra.emplace_back(grid.subcarriers, std::to_array(path.transfer));
  const auto expected = frequency_response_fp64(paths, antenna(), antenna(), grid);
  const auto found = frequency_response_fp64(paths, spectra, antenna(), antenna(), grid);
  for (size_t k = 0; k < found.size(); ++k) EXPECT_LT(std::abs(found[k] - expected[k]), 1e-14);
  std::vector<std::complex<float>> into(found.size());
  frequency_response_into(paths, spectra, antenna(), antenna(), grid, into);
  EXPECT_TRUE(same_bits(into, std::vector<std::complex<float>>(found.begin(), found.end())));
}

TEST(ResponseInto, LineOfSightAndTheRestAreTheWhole) {
  auto paths = random_paths(40, 2e-6, 6);
  for (Path& path : paths) path.interactions.push_back({});
  paths[17].interactions.clear();
  const ArrayPose tx = antenna(Pattern::isotropic, Polarization::vh), rx = antenna(Pattern::half_wave_dipole);
  const ChannelGrid grid{28e9, 120e3, 33, 2, 1e-3};
  std::vector<std::complex<float>> parts[3];
  const PathSelection selections[] = {PathSelection::all, PathSelection::line_of_sight,
                                      PathSelection::others};
  for (size_t i = 0; i < 3; ++i) {
    parts[i].resize(response_size(tx, rx, grid));
    frequency_response_into(paths, {}, tx, rx, grid, parts[i], selections[i]);
  }
  EXPECT_TRUE(same_bits(parts[0], frequency_response(paths, tx, rx, grid)));
  EXPECT_TRUE(same_bits(parts[1], frequency_response(std::span(paths).subspan(17, 1), tx, rx, grid)));
  double amplitudes = 0.0;
  for (const double power : path_powers(paths, tx, rx, grid.carrier_hz)) amplitudes += std::sqrt(2.0 * power);
  for (size_t k = 0; k < parts[0].size(); ++k)
    EXPECT_LE(std::abs(Complex(parts[1][k]) + Complex(parts[2][k]) - Complex(parts[0][k])),
              0x1p-23 * amplitudes);
  // Without a selected path, the result is zero.
  paths.erase(paths.begin() + 17);
  frequency_response_into(paths, {}, tx, rx, grid, parts[1], PathSelection::line_of_sight);
  for (const auto& value : parts[1]) EXPECT_EQ(value, std::complex<float>(0.0f));
}

TEST(ResponseInto, RefusesOtherRoom) {
  const auto paths = random_paths(2, 1e-6, 4);
  const ChannelGrid grid{3.5e9, 30e3, 8, 1, 1e-3};
  std::vector<std::complex<float>> room(7);
  EXPECT_THROW(frequency_response_into(paths, {}, antenna(), antenna(), grid, room), ContractError);
  room.resize(8);
  const std::vector<TransferSpectrum> one(1, TransferSpectrum(8));
  EXPECT_THROW(frequency_response_into(paths, one, antenna(), antenna(), grid, room), ContractError);
}

}  // namespace
}  // namespace greatx::rf
