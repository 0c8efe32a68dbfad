// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/channel/frequency_response.h"
#include "rf/field/field.h"
#include "rf/geometry/geometry.h"
#include "tests/rf/channel_paths.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/scenes.h"
#include "tests/rf/turned_field.h"

namespace greatx::rf {
namespace {

using testing::antenna;
using testing::exhaustive_candidates;
using testing::HandScene;
using testing::random_paths;
using testing::solve_paths;
using testing::turned_field;
using testing::Wide;
using testing::wide_phasor;
using testing::wide_pi;

std::vector<Path> solve(const HandScene& hand, const dvec3& tx, const dvec3& rx, uint32_t depth,
                        double f_hz) {
  const FacetWorld world(hand.scene);
  const RadioSurfaces surfaces(hand.scene, f_hz);
  std::vector<Path> paths;
  for (const GeometricPath& path :
       solve_paths(world, tx, rx, exhaustive_candidates(world.facet_count(), depth)))
    paths.push_back(path_field(path, {&world, &surfaces}, dvec3(0.0), dvec3(0.0)));
  return paths;
}

ChannelGrid single(double carrier_hz) { return {carrier_hz, 30e3, 1, 1, 1e-3}; }

TEST(Channel, FreeSpaceIsFriis) {
  HandScene hand;
  const double carrier = 28e9, wavelength = speed_of_light / carrier;
  for (const double distance : {1.0, 123.456, 9876.5}) {
    const auto paths = solve(hand, {0, 0, 10}, {distance, 0, 10}, 1, carrier);
    const ChannelGrid grid{carrier, 120e3, 64, 1, 1e-3};
    const auto dipoles = frequency_response(paths, antenna(Pattern::half_wave_dipole),
                                            antenna(Pattern::half_wave_dipole), grid);
    ASSERT_EQ(dipoles.size(), 64u);
    for (size_t k = 0; k < dipoles.size(); ++k) {
      const double f = carrier + grid.subcarrier_number(static_cast<uint32_t>(k)) * 120e3;
      const Wide expected = static_cast<long double>(1.6409223770 * wavelength / (4 * pi * distance)) *
                            wide_phasor(f, distance / speed_of_light);
      const Wide found(dipoles[k].real(), dipoles[k].imag());
      EXPECT_LT(std::abs(found - expected) / std::abs(expected), 1e-6L);
    }
    const auto crossed =
        frequency_response(paths, antenna(), antenna(Pattern::isotropic, Polarization::h), grid);
    for (const auto& value : crossed) EXPECT_LT(std::abs(value), 1e-15 * wavelength / distance);
  }
}

/// Returns lambda/4 pi e^{-jk d1}(1/d1 + r e^{-jk Delta}/d2) with Delta = 4 h_t h_r/(d1 + d2), which avoids a
/// difference of lengths.
Wide two_ray(double h_t, double h_r, double run, double carrier_hz, Complex r) {
  const double d1 = std::hypot(run, h_t - h_r), d2 = std::hypot(run, h_t + h_r);
  const double excess = 4.0 * h_t * h_r / (d1 + d2);
  const Wide sum = 1.0L / static_cast<long double>(d1) +
                   Wide(r.real(), r.imag()) * wide_phasor(carrier_hz, excess / speed_of_light) /
                       static_cast<long double>(d2);
  return static_cast<long double>(speed_of_light / carrier_hz / (4 * pi)) *
         wide_phasor(carrier_hz, d1 / speed_of_light) * sum;
}

TEST(ChannelHardCase, N38_TwoRayGround) {
  struct Ground {
    const char* name;
    double relative, sigma;
  };
  for (const Ground& kind : {Ground{"conductor", 1.0, 1e30}, Ground{"earth", 15.0, 0.05}}) {
    for (const double carrier : {900e6, 3.5e9, 28e9}) {
      HandScene hand;
      hand.material(kind.name, kind.relative, kind.sigma);
      hand.ground(40'000.0);
      const Complex eta(kind.relative, -kind.sigma / (2 * pi * carrier * vacuum_permittivity));
      const double h_t = 25.0, h_r = 1.5;
      for (const double run : {10.0, 77.7, 500.0, 3000.0, 20'000.0}) {
        const auto paths = solve(hand, {0, 0, h_t}, {run, 0, h_r}, 1, carrier);
        ASSERT_EQ(paths.size(), 2u);
        const FresnelCoefficients fresnel = half_space(eta, (h_t + h_r) / std::hypot(run, h_t + h_r));
        // Isotropic antennas. For V, theta over the ground is TM. For H, phi is TE, with a factor of -1
        // because the arrival points back along the path.
        const auto v = frequency_response_fp64(paths, antenna(), antenna(), single(carrier));
        const auto h = frequency_response_fp64(paths, antenna(Pattern::isotropic, Polarization::h),
                                               antenna(Pattern::isotropic, Polarization::h), single(carrier));
        const Wide expected_v = two_ray(h_t, h_r, run, carrier, fresnel.r_tm);
        const Wide expected_h = -two_ray(h_t, h_r, run, carrier, fresnel.r_te);
        EXPECT_LT(std::abs(Wide(v[0].real(), v[0].imag()) - expected_v) / std::abs(expected_v), 1e-6L)
            << kind.name << " " << carrier << " " << run;
        EXPECT_LT(std::abs(Wide(h[0].real(), h[0].imag()) - expected_h) / std::abs(expected_h), 1e-6L)
            << kind.name << " " << carrier << " " << run;
        const auto rounded = frequency_response(paths, antenna(), antenna(), single(carrier));
        EXPECT_LT(std::abs(std::complex<double>(rounded[0]) - v[0]) / std::abs(v[0]), 1e-7);
      }
    }
  }
}

TEST(ChannelHardCase, N36_N37_N39_PhaseOfLongPathsAtHighFrequency) {
  // 1 km at 28 GHz and 10 km at 140 GHz are 9.3e4 and 4.7e6 turns. Phases in fp32 would have errors of 3 and
  // 180 degrees; a delay stored in fp32 would have an error of 82 degrees.
  RandomStream random(36, 0);
  for (const auto& [carrier, farthest] : {std::pair{28e9, 1000.0}, std::pair{140e9, 10'000.0}})
    for (int i = 0; i < 200; ++i) {
      HandScene hand;
      const double distance = farthest * random.uniform(0.9, 1.0);
      const auto paths = solve(hand, {0, 0, 0}, {distance, 0, 0}, 0, carrier);
      static_assert(std::is_same_v<decltype(Path::delay_s), double>);
      const auto found = frequency_response(paths, antenna(), antenna(), single(carrier))[0];
      // The reference uses the distance in long double, so that the bound includes the error of rounding the
      // delay to fp64.
      const long double turns = static_cast<long double>(carrier) * distance / 299792458.0L;
      const Wide expected = std::polar(1.0L, -2 * wide_pi * (turns - std::nearbyint(turns)));
      const Wide turned = Wide(found.real(), found.imag()) * std::conj(expected);
      EXPECT_LT(std::abs(std::arg(turned)), 1e-3L);
      EXPECT_LT(std::abs(std::arg(turned)), 1e-6L);  // the accuracy that is reached
    }
}

TEST(ChannelHardCase, N40_WideBandAndLongDelay) {
  // Checks e^{-j 2 pi f tau} over 400 MHz and 33 us, 13 200 turns across the band, at every subcarrier.
  auto paths = random_paths(3, 1.0, 40);
  for (Path& path : paths) path.transfer[1] = path.transfer[2] = path.transfer[3] = 0.0;
  for (const double delay : {33e-6, 32.987654321e-6, 1e-9}) {
    Path path = paths[0];
    path.delay_s = delay;
    path.transfer[0] = 1.0;
    const ChannelGrid grid{140e9, 400e6 / 3300, 3300, 1, 1e-3};
    const auto found = frequency_response_fp64(std::span(&path, 1), antenna(), antenna(), grid);
    const long double scale = static_cast<long double>(speed_of_light / 140e9 / (4 * pi));
    for (uint32_t k = 0; k < grid.subcarriers; ++k) {
      const Wide expected = scale * wide_phasor(140e9, delay) *
                            wide_phasor(grid.subcarrier_number(k) * grid.subcarrier_spacing_hz, delay);
      const Wide value(found[k].real(), found[k].imag());
      // The frequency f = k * spacing rounds to 1e-12 turns.
      EXPECT_LT(std::abs(value - expected) / std::abs(expected), 1e-11L) << k;
    }
  }
}

TEST(ChannelHardCase, N41_FractionalDelaysAgainstTheDirectSum) {
  const auto paths = random_paths(150, 4e-6, 41);  // more than one chunk of the sum
  ArrayPose tx = antenna(Pattern::half_wave_dipole, Polarization::slant);
  tx.array.rows = 2;
  tx.array.columns = 3;
  tx.array.row_spacing_m = 0.05;
  tx.array.column_spacing_m = 0.04;
  tx.orientation = orientation_from_yaw_pitch_roll(0.7, 0.2, -0.4);
  ArrayPose rx = antenna(Pattern::isotropic, Polarization::vh);
  rx.array.columns = 2;
  rx.array.column_spacing_m = 0.043;
  rx.orientation = orientation_from_yaw_pitch_roll(-2.0, 0.5, 0.1);
  const ChannelGrid grid{3.5e9, 30e3, 37, 3, 0.5e-3};
  const auto found = frequency_response_fp64(paths, tx, rx, grid);
  const uint32_t tx_ports = tx.array.port_count(), rx_ports = rx.array.port_count();
  ASSERT_EQ(tx_ports, 12u);
  ASSERT_EQ(rx_ports, 4u);
  ASSERT_EQ(found.size(), size_t{rx_ports} * tx_ports * 3 * 37);

  const double wavelength = speed_of_light / grid.carrier_hz;
  long double worst = 0.0L;
  double peak = 0.0;
  for (const Complex& value : found) peak = std::max(peak, std::abs(value));
  for (uint32_t u = 0; u < rx_ports; ++u)
    for (uint32_t s = 0; s < tx_ports; ++s)
      for (uint32_t m = 0; m < 3; ++m)
        for (const uint32_t k : {0u, 7u, 8u, 18u, 36u}) {
          Wide sum = 0.0L;
          for (const Path& path : paths) {
            const Jones c_t =
                turned_field(tx.array.pattern, tx.array.slant(s), tx.orientation, path.departure);
            const Jones c_r = turned_field(rx.array.pattern, rx.array.slant(u), rx.orientation, path.arrival);
            const Complex coefficient =
                std::conj(c_r.theta) * (path.transfer[0] * c_t.theta + path.transfer[1] * c_t.phi) +
                std::conj(c_r.phi) * (path.transfer[2] * c_t.theta + path.transfer[3] * c_t.phi);
            const double array_turns =
                (glm::dot(path.departure, tx.orientation * tx.array.element_position(s)) +
                 glm::dot(path.arrival, rx.orientation * rx.array.element_position(u))) /
                wavelength;
            const long double doppler_turns = static_cast<long double>(path.doppler_hz) * m * 0.5e-3L;
            const double subcarrier = (static_cast<int>(k) - 18) * 30e3;
            sum += Wide(coefficient.real(), coefficient.imag()) *
                   std::polar(1.0L, 2 * wide_pi * (array_turns + doppler_turns)) *
                   wide_phasor(grid.carrier_hz, path.delay_s) * wide_phasor(subcarrier, path.delay_s);
          }
          sum *= static_cast<long double>(wavelength / (4 * pi));
          const Complex value = found[((size_t{u} * tx_ports + s) * 3 + m) * 37 + k];
          worst = std::max(worst, std::abs(Wide(value.real(), value.imag()) - sum));
        }
  EXPECT_LT(worst / peak, 1e-12L);
}

TEST(ChannelHardCase, N43_AnyOrderOfPathsGivesTheSameBits) {
  auto paths = random_paths(100'000, 10e-6, 43);
  for (size_t i = 0; i < 1000; ++i) paths[i] = paths[i + 1000];                     // duplicates
  for (size_t i = 2000; i < 3000; ++i) paths[i].delay_s = paths[i + 1000].delay_s;  // ties in delay
  const ChannelGrid grid{28e9, 120e3, 12, 1, 1e-3};
  const auto first = frequency_response_fp64(paths, antenna(), antenna(), grid);
  RandomStream random(43, 1);
  for (size_t i = paths.size() - 1; i > 0; --i)
    std::swap(paths[i], paths[random.below(static_cast<uint32_t>(i + 1))]);
  const auto second = frequency_response_fp64(paths, antenna(), antenna(), grid);
  ASSERT_EQ(first.size(), second.size());
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(Complex)), 0);
}

TEST(ChannelHardCase, N64_NoPath) {
  const auto response = frequency_response({}, antenna(), antenna(Pattern::isotropic, Polarization::vh),
                                           {3.5e9, 30e3, 5, 2, 1e-3});
  ASSERT_EQ(response.size(), 2u * 2 * 5);
  for (const auto& value : response) EXPECT_EQ(value, std::complex<float>(0.0f));
  EXPECT_TRUE(impulse_response({}, antenna(), antenna(), 3.5e9).amplitude.empty());
}

TEST(Channel, ImpulseResponseIsTheFrequencyResponse) {
  const auto paths = random_paths(9, 2e-6, 1);
  ArrayPose tx = antenna(Pattern::isotropic, Polarization::vh);
  tx.array.columns = 2;
  tx.array.column_spacing_m = 0.04;
  const ChannelGrid grid{3.5e9, 30e3, 16, 1, 1e-3};
  const auto response = frequency_response_fp64(paths, tx, antenna(), grid);
  const ImpulseResponse impulse = impulse_response(paths, tx, antenna(), grid.carrier_hz);
  ASSERT_EQ(impulse.amplitude.size(), 9u * 4);
  for (size_t s = 0; s < 4; ++s)
    for (uint32_t k = 0; k < 16; ++k) {
      Complex sum = 0.0;
      double size = 0.0;
      for (size_t i = 0; i < paths.size(); ++i) {
        EXPECT_EQ(impulse.delay_s[i], paths[i].delay_s);
        EXPECT_EQ(impulse.doppler_hz[i], paths[i].doppler_hz);
        sum += Complex(impulse.amplitude[i * 4 + s]) *
               std::polar(1.0, -2 * pi * grid.subcarrier_number(k) * 30e3 * impulse.delay_s[i]);
        size += std::abs(impulse.amplitude[i * 4 + s]);
      }
      EXPECT_LT(std::abs(sum - response[s * 16 + k]) / size, 1e-7);
    }
}

TEST(Channel, TimeSamplesTurnWithTheDoppler) {
  auto paths = random_paths(1, 1e-6, 2);
  paths[0].doppler_hz = 125.0;
  const auto response = frequency_response_fp64(paths, antenna(), antenna(), {3.5e9, 30e3, 1, 5, 1e-3});
  for (size_t m = 1; m < 5; ++m) EXPECT_NEAR(std::arg(response[m] / response[m - 1]), 2 * pi * 0.125, 1e-12);
}

TEST(Channel, ArrayPhasesFollowThePlaneWave) {
  // The boresight is +x. The wave of a transmitter at +30 degrees of azimuth reaches the left (+y) elements
  // first.
  HandScene hand;
  const double carrier = 3.5e9, wavelength = speed_of_light / carrier, far = 1e6;
  const auto paths = solve(hand, {far * std::cos(pi / 6), far * 0.5, 0}, {0, 0, 0}, 0, carrier);
  ArrayPose rx = antenna();
  rx.array.columns = 4;
  rx.array.column_spacing_m = wavelength / 2;
  const auto response = frequency_response_fp64(paths, antenna(), rx, single(carrier));
  for (size_t u = 1; u < 4; ++u) EXPECT_NEAR(std::arg(response[u] / response[u - 1]), pi / 2, 1e-9);
  // Compares with the plane wave at each element; the transmitter is 1000 km away.
  for (uint32_t u = 0; u < 4; ++u) {
    const dvec3 element = rx.array.element_position(u);
    const double excess = glm::dot(paths[0].arrival, element);
    EXPECT_NEAR(
        std::arg(
            response[u] / response[0] *
            std::polar(1.0, -2 * pi * (excess - glm::dot(paths[0].arrival, rx.array.element_position(0))) /
                                wavelength)),
        0.0, 1e-9);
  }
}

TEST(Channel, RefusesWhatIsNotFinite) {
  auto paths = random_paths(2, 1e-6, 3);
  paths[1].transfer[2] = {0.0, std::nan("")};
  EXPECT_THROW(frequency_response(paths, antenna(), antenna(), single(3.5e9)), ContractError);
}

}  // namespace
}  // namespace greatx::rf
