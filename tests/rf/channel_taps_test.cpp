// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "core/error.h"
#include "rf/channel/statistics.h"
#include "rf/channel/taps.h"
#include "tests/rf/channel_paths.h"

namespace greatx::rf {
namespace {

using testing::antenna;
using testing::plain_path;
using testing::random_paths;
using testing::Wide;
using testing::wide_phasor;
using testing::wide_pi;

/// Returns sinc(tap - bandwidth * delay). The product is exact, and the sine is that of the whole argument.
long double wide_sinc(double tap, double bandwidth_hz, double delay_s) {
  const ExactProduct samples = exact_product(bandwidth_hz, delay_s);
  const long double x = (static_cast<long double>(tap) - samples.value) - samples.error;
  return x == 0.0L ? 1.0L : std::sin(wide_pi * x) / (wide_pi * x);
}

TEST(TapsHardCase, N41_FractionalDelaysAgainstTheDirectSum) {
  const auto paths = random_paths(150, 3e-6, 41);
  const ArrayPose tx = antenna(Pattern::isotropic, Polarization::vh), rx = antenna();
  const TapGrid grid{28e9, 123.456e6, -20, 421, 3, 0.5e-3};
  const auto found = channel_taps_fp64(paths, tx, rx, grid);
  const ImpulseResponse impulse = impulse_response(paths, tx, rx, grid.carrier_hz);
  ASSERT_EQ(found.size(), 2u * 3 * 421);
  double peak = 0.0;
  for (const Complex& value : found) peak = std::max(peak, std::abs(value));
  const double scale = speed_of_light / grid.carrier_hz / (4 * pi);
  for (size_t s = 0; s < 2; ++s)
    for (uint32_t m = 0; m < 3; ++m)
      for (uint32_t l = 0; l < grid.taps; ++l) {
        Wide sum = 0.0L;
        for (const Path& path : paths) {
          const Complex amplitude = scale * path.transfer[s];  // V to V, H to V
          sum += Wide(amplitude.real(), amplitude.imag()) * wide_phasor(grid.carrier_hz, path.delay_s) *
                 std::polar(1.0L, 2 * wide_pi * path.doppler_hz * m * 0.5e-3L) *
                 wide_sinc(static_cast<double>(l) - 20.0, grid.bandwidth_hz, path.delay_s);
        }
        const Complex value = found[(s * 3 + m) * grid.taps + l];
        EXPECT_LT(std::abs(Wide(value.real(), value.imag()) - sum) / peak, 1e-12L) << s << m << " " << l;
      }
  std::vector<std::complex<float>> rounded(found.size());
  channel_taps_into(paths, tx, rx, grid, rounded);
  for (size_t i = 0; i < found.size(); ++i)
    EXPECT_LE(std::abs(Complex(rounded[i]) - found[i]), 0x1p-23 * std::abs(found[i]));
}

TEST(TapsHardCase, N43_AnyOrderOfPathsGivesTheSameBits) {
  auto paths = random_paths(3000, 3e-6, 43);
  for (size_t i = 200; i < 300; ++i) paths[i].delay_s = paths[i + 100].delay_s;
  const TapGrid grid{28e9, 100e6, 0, 50};
  std::vector<std::complex<float>> first(grid.taps), second(grid.taps);
  channel_taps_into(paths, antenna(), antenna(), grid, first);
  const auto covered = tap_coverage(paths, path_powers(paths, antenna(), antenna(), 28e9), grid);
  testing::shuffle(paths, 1);
  channel_taps_into(paths, antenna(), antenna(), grid, second);
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof first[0]), 0);
  const auto again = tap_coverage(paths, path_powers(paths, antenna(), antenna(), 28e9), grid);
  EXPECT_EQ(covered.power_outside, again.power_outside);
  EXPECT_EQ(covered.paths_outside, again.paths_outside);
}

TEST(Taps, AWholeNumberOfSamplesIsOneTap) {
  const double bandwidth = 0x1p27;  // B tau is exact
  const Path path = plain_path(37.0 / bandwidth, 2.0);
  const TapGrid grid{3.5e9, bandwidth, 30, 16};
  const auto taps = channel_taps_fp64(std::span(&path, 1), antenna(), antenna(), grid);
  const ImpulseResponse impulse = impulse_response(std::span(&path, 1), antenna(), antenna(), 3.5e9);
  for (size_t l = 0; l < taps.size(); ++l)
    if (l == 7)
      EXPECT_EQ(std::complex<float>(taps[l]), impulse.amplitude[0]);
    else
      EXPECT_EQ(taps[l], Complex(0.0)) << l;
  EXPECT_EQ(tap_coverage({&path, 1}, std::vector{1.0}, grid).power_outside, 0.0);
}

TEST(Taps, FoldedTheyAreTheInverseTransformOfTheResponse) {
  // For an odd N the inverse transform is the sum of h[l + q N] over q, here over 400 periods on either side.
  const uint32_t count = 33;
  const double bandwidth = 50e6;
  const auto paths = random_paths(6, 8e-7, 5);
  const ChannelGrid grid{3.5e9, bandwidth / count, count, 1, 1e-3};
  const auto response = frequency_response_fp64(paths, antenna(), antenna(), grid);
  const int32_t periods = 400;
  const TapGrid all{3.5e9, bandwidth, -periods * static_cast<int32_t>(count), (2 * periods + 1) * count};
  const auto taps = channel_taps_fp64(paths, antenna(), antenna(), all);
  double peak = 0.0;
  for (const Complex& value : taps) peak = std::max(peak, std::abs(value));
  for (uint32_t l = 0; l < count; ++l) {
    Complex inverse = 0.0, folded = 0.0;
    for (uint32_t k = 0; k < count; ++k)
      inverse += response[k] * std::polar(1.0 / count, 2 * pi * grid.subcarrier_number(k) * l / count);
    for (size_t i = l; i < taps.size(); i += count) folded += taps[i];
    // The last period of an alternating sum counts half.
    folded -= 0.5 * (taps[l] + taps[taps.size() - count + l]);
    EXPECT_LT(std::abs(inverse - folded) / peak, 1e-6) << l;
  }
}

TEST(Taps, TheirTransformIsTheResponseWithinTheBand) {
  const double bandwidth = 40e6;
  const auto paths = random_paths(5, 1e-6, 6);
  const TapGrid all{3.5e9, bandwidth, -20'000, 40'041};
  const auto taps = channel_taps_fp64(paths, antenna(), antenna(), all);
  const ChannelGrid grid{3.5e9, bandwidth / 10, 9, 1, 1e-3};  // up to 0.4 B
  const auto response = frequency_response_fp64(paths, antenna(), antenna(), grid);
  double size = 0.0;
  for (const double power : path_powers(paths, antenna(), antenna(), 3.5e9)) size += std::sqrt(power);
  for (uint32_t k = 0; k < grid.subcarriers; ++k) {
    Complex sum = 0.0;
    for (size_t i = 0; i < taps.size(); ++i)
      sum += taps[i] *
             std::polar(1.0, -2 * pi * grid.subcarrier_number(k) / 10 * (all.first + static_cast<double>(i)));
    EXPECT_LT(std::abs(sum - response[k]) / size, 1e-4) << k;
  }
}

TEST(Taps, PowerOutsideTheWindowIsReported) {
  const double bandwidth = 0x1p27;
  std::vector<Path> paths{plain_path(10.0 / bandwidth), plain_path(100.0 / bandwidth)};
  const std::vector<double> powers{3.0, 1.0};
  const auto outside = [&](int32_t first, uint32_t taps) {
    return tap_coverage(paths, powers, {3.5e9, bandwidth, first, taps});
  };
  EXPECT_EQ(outside(0, 101).power_outside, 0.0);
  EXPECT_EQ(outside(0, 101).paths_outside, 0u);
  EXPECT_EQ(outside(0, 100).power_outside, 0.25);
  EXPECT_EQ(outside(0, 100).paths_outside, 1u);
  EXPECT_EQ(outside(11, 20).power_outside, 1.0);
  EXPECT_EQ(outside(11, 20).paths_outside, 2u);
  // The delay lies between two samples. The share outside is 1 - sum of (2/((2 l + 1) pi))^2 over 2 L taps
  // around the delay, about 1/(pi^2 L) on either side.
  paths = {plain_path(100.5 / bandwidth)};
  const double share = tap_coverage(paths, std::vector{2.0}, {3.5e9, bandwidth, 51, 100}).power_outside;
  EXPECT_NEAR(share, 2.0 / (pi * pi * 50), 1e-6);
  // The power inside the window, the sum of |h|^2, and the share outside make up the whole.
  const auto taps = channel_taps_fp64(paths, antenna(), antenna(), {3.5e9, bandwidth, 51, 100});
  double inside = 0.0;
  for (const Complex& value : taps) inside += std::norm(value);
  EXPECT_NEAR(inside / path_powers(paths, antenna(), antenna(), 3.5e9)[0] + share, 1.0, 1e-12);
  EXPECT_EQ(tap_coverage({}, {}, {}).power_outside, 0.0);
  EXPECT_EQ(tap_coverage(paths, std::vector{0.0}, {}).power_outside, 0.0);
}

TEST(Taps, RefuseWhatIsNoWindow) {
  std::vector<std::complex<float>> room(3);
  EXPECT_THROW(channel_taps_into({}, antenna(), antenna(), {3.5e9, 0.0, 0, 3}, room), ContractError);
  EXPECT_THROW(channel_taps_into({}, antenna(), antenna(), {3.5e9, 1e6, 0, 0}, {}), ContractError);
  EXPECT_THROW(channel_taps_into({}, antenna(), antenna(), {3.5e9, 1e6, 0, 4}, room), ContractError);
}

}  // namespace
}  // namespace greatx::rf
