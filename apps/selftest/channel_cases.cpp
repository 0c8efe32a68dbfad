// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Phase, delay and Doppler shift, against closed forms with a mantissa of 64 bits.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstring>
#include <numbers>

#include "apps/selftest/catalogue.h"
#include "core/phase.h"
#include "core/units.h"
#include "rf/channel/taps.h"
#include "rf/field/field.h"
#include "rf/surface/fresnel.h"

namespace greatx::apps::selftest {

namespace {

using rf::Complex;
using rf::Path;
using Wide = std::complex<long double>;

constexpr const char* rounded = "host, complex64";

/// Returns e^{-j 2 pi turns} of frequency times delay; whole turns are taken off first.
Wide exact_phasor(long double frequency_hz, long double delay_s) {
  // The product of two doubles has 106 bits; its high part and its rest are reduced one by one.
  const rf::ExactProduct product =
      rf::exact_product(static_cast<double>(frequency_hz), static_cast<double>(delay_s));
  const long double turns = (static_cast<long double>(product.value) - std::nearbyint(product.value)) +
                            static_cast<long double>(product.error);
  return std::polar(1.0L, -2.0L * std::numbers::pi_v<long double> * turns);
}
Wide wide(Complex value) { return {value.real(), value.imag()}; }
Wide wide(std::complex<float> value) { return {value.real(), value.imag()}; }

/// Returns a path of free space along x.
Path straight(double delay_s) {
  Path path;
  path.delay_s = delay_s;
  path.length_m = delay_s * speed_of_light;
  path.departure = {1, 0, 0};
  path.arrival = {-1, 0, 0};
  path.transfer[0] = path.transfer[3] = 1.0;
  return path;
}

void n36_long_paths(const Lab& lab, Rows& rows) {
  struct Link {
    double carrier_hz, distance_m;
    const char* name;
  };
  Stage stage = lab.stage();
  stage.object("nothing");
  const scene::Scene scene = stage.build();
  for (const Link& link : {Link{28e9, 1000.0, "28 GHz, 1 km"}, Link{140e9, 1000.0, "140 GHz, 1 km"},
                           Link{140e9, 10'000.0, "140 GHz, 10 km"}}) {
    Links links(lab, scene, {.carrier_hz = link.carrier_hz});
    RandomStream random(36, 1);
    std::vector<dvec3> receivers;
    for (int i = 0; i < 64; ++i) receivers.push_back({link.distance_m * random.uniform(0.9, 1.0), 0, 0});
    std::vector<dvec3> handed;
    for (const dvec3& receiver : receivers) handed.push_back(lab.given(receiver));
    const auto paths = links.solve(dvec3(0.0), handed);
    const rf::ChannelGrid grid{link.carrier_hz, 30e3, 1, 1, 1e-3};
    double phase_32 = 0.0, phase_64 = 0.0, gain = 0.0;
    for (size_t r = 0; r < receivers.size(); ++r) {
      const long double turns = static_cast<long double>(link.carrier_hz) * receivers[r].x /
                                static_cast<long double>(speed_of_light);
      const Wide expected =
          std::polar(1.0L, -2.0L * std::numbers::pi_v<long double> * (turns - std::nearbyint(turns)));
      const Complex fp64 = rf::frequency_response_fp64(paths[r], antenna(), antenna(), grid)[0];
      const std::complex<float> fp32 = rf::frequency_response(paths[r], antenna(), antenna(), grid)[0];
      const double friis = speed_of_light / link.carrier_hz / (4 * pi * receivers[r].x);
      phase_64 =
          std::max(phase_64, static_cast<double>(std::abs(std::arg(wide(fp64) * std::conj(expected)))));
      phase_32 =
          std::max(phase_32, static_cast<double>(std::abs(std::arg(wide(fp32) * std::conj(expected)))));
      gain = std::max(gain, std::abs(2.0 * decibels(std::abs(fp32) / friis)));
    }
    const std::string name = link.name;
    rows.add("largest error of phase, rad: " + name, host, 0.0, phase_64, 1e-3);
    rows.add("largest error of phase, rad: " + name, rounded, 0.0, phase_32, 1e-3);
    // 0.01 dB is what is asked for; the fault of 0.1 % of the distance makes 0.0087 dB, the rounding 1e-6 dB.
    rows.add("largest error of gain, dB: " + name, rounded, 0.0, gain, 1e-3);
  }
}

void n38_two_ray(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  stage.quad({-30000, -30000, 0}, {30000, -30000, 0}, {30000, 30000, 0}, {-30000, 30000, 0});
  const scene::Scene scene = stage.build();
  const double carrier = 28e9, h_t = 25.0, h_r = 1.5;
  const Complex eta(5.24, -0.123 / (2 * pi * carrier * vacuum_permittivity));
  Links links(lab, scene, {.carrier_hz = carrier});
  const rf::ChannelGrid grid{carrier, 30e3, 1, 1, 1e-3};
  double worst = 0.0, worst_rounded = 0.0;
  for (const double run : {10.0, 77.75, 500.0, 3000.0, 20'000.0}) {
    const std::vector<Path> paths = links.solve({0, 0, h_t}, {run, 0, lab.given(h_r)});
    const double d1 = std::hypot(run, h_t - h_r), d2 = std::hypot(run, h_t + h_r);
    const double excess = 4.0 * h_t * h_r / (d1 + d2);  // d2 - d1 without a subtraction
    const Complex r = rf::half_space(eta, (h_t + h_r) / d2).r_tm;
    const Wide sum = 1.0L / static_cast<long double>(d1) +
                     wide(r) * exact_phasor(carrier, excess / speed_of_light) / static_cast<long double>(d2);
    const Wide expected = static_cast<long double>(speed_of_light / carrier / (4 * pi)) *
                          exact_phasor(carrier, d1 / speed_of_light) * sum;
    const Complex fp64 = rf::frequency_response_fp64(paths, antenna(), antenna(), grid)[0];
    const std::complex<float> fp32 = rf::frequency_response(paths, antenna(), antenna(), grid)[0];
    worst = std::max(worst, static_cast<double>(std::abs(wide(fp64) - expected) / std::abs(expected)));
    worst_rounded =
        std::max(worst_rounded, static_cast<double>(std::abs(wide(fp32) - wide(fp64))) / std::abs(fp64));
  }
  rows.add("largest relative error of H, 10 m to 20 km", host, 0.0, worst, 1e-6);
  rows.add("largest relative rounding of H", rounded, 0.0, worst_rounded, 1.2e-7);
}

void n40_wide_band(const Lab& lab, Rows& rows) {
  const rf::ChannelGrid grid{28e9, 400e6 / 4096, 4096, 1, 1e-3};
  double worst = 0.0, worst_rounded = 0.0;
  for (const double delay : {33e-6, 32.987654321e-6}) {
    const Path path = straight(lab.given(delay));
    const auto fp64 = rf::frequency_response_fp64(std::span(&path, 1), antenna(), antenna(), grid);
    const auto fp32 = rf::frequency_response(std::span(&path, 1), antenna(), antenna(), grid);
    const double scale = speed_of_light / grid.carrier_hz / (4 * pi);
    for (uint32_t k = 0; k < grid.subcarriers; ++k) {
      const double offset = grid.subcarrier_number(k) * grid.subcarrier_spacing_hz;  // exact: a power of two
      const Wide expected = static_cast<long double>(scale) * exact_phasor(grid.carrier_hz, delay) *
                            exact_phasor(offset, delay);
      worst = std::max(worst, static_cast<double>(std::abs(wide(fp64[k]) - expected)) / scale);
      worst_rounded =
          std::max(worst_rounded, static_cast<double>(std::abs(wide(fp32[k]) - expected)) / scale);
    }
  }
  rows.add("largest relative error of H, 400 MHz and 33 us", host, 0.0, worst, 1e-12);
  rows.add("largest relative error of H, 400 MHz and 33 us", rounded, 0.0, worst_rounded, 1.2e-7);
}

void n41_fractional_delays(const Lab& lab, Rows& rows) {
  const rf::TapGrid grid{3.5e9, 20e6, 0, 64, 1, 1e-3};
  double worst = 0.0;
  for (const double samples : {7.0, 12.25, 30.0 + 0x1p-20}) {
    const double delay = samples / grid.bandwidth_hz;
    const Path path = straight(lab.given(delay));
    const auto taps = rf::channel_taps_fp64(std::span(&path, 1), antenna(), antenna(), grid);
    const Wide amplitude = static_cast<long double>(speed_of_light / grid.carrier_hz / (4 * pi)) *
                           exact_phasor(grid.carrier_hz, delay);
    for (uint32_t l = 0; l < grid.taps; ++l) {
      const long double x =
          std::numbers::pi_v<long double> *
          (static_cast<long double>(l) - static_cast<long double>(grid.bandwidth_hz) * delay);
      const Wide expected = amplitude * (x == 0.0L ? 1.0L : std::sin(x) / x);
      worst = std::max(worst, static_cast<double>(std::abs(wide(taps[l]) - expected) / std::abs(amplitude)));
    }
  }
  rows.add("largest error of a tap, of the path's amplitude", host, 0.0, worst, 1e-12);
}

void n42_doppler(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  stage.object("nothing");
  const scene::Scene scene = stage.build();
  const rf::FacetWorld world(scene);
  const rf::RadioSurfaces surfaces(scene, 28e9);
  rf::FieldModel model;
  model.world = &world;
  model.surfaces = &surfaces;
  rf::GeometricPath line;
  line.vertices = {dvec3(0.0), dvec3(3000.0, 4000.0, 0.0)};
  line.length_m = 5000.0;
  for (const double speed : {1e-5, 1.4, 7500.0}) {
    const dvec3 velocity = lab.given(speed) * dvec3(0.6, 0.8, 0.0);
    const double got = rf::path_field(line, model, velocity, dvec3(0.0)).doppler_hz;
    rows.add("relative error of the Doppler shift at " + std::to_string(speed) + " m/s", host, 0.0,
             got / (speed * 28e9 / speed_of_light) - 1.0, 1e-12);
  }
}

void n43_any_order(const Lab& lab, Rows& rows) {
  RandomStream random(43, 1);
  std::vector<Path> paths(2000);
  for (Path& path : paths) {
    path = straight(random.uniform(0.0, 1e-6));
    path.departure = random_direction(random);
    path.arrival = random_direction(random);
    for (Complex& value : path.transfer) value = {random.uniform(-1, 1), random.uniform(-1, 1)};
  }
  const rf::ChannelGrid grid{3.5e9, 30e3, 64, 1, 1e-3};
  const auto sum = rf::frequency_response_fp64(paths, antenna(), antenna(), grid);
  double differ = 0.0;
  for (int round = 0; round < 4; ++round) {
    for (size_t i = paths.size() - 1; i > 0; --i)
      std::swap(paths[i], paths[random.below(static_cast<uint32_t>(i + 1))]);
    if (lab.given(1.0) != 1.0) paths[0].transfer[0] *= lab.given(1.0);
    const auto other = rf::frequency_response_fp64(paths, antenna(), antenna(), grid);
    differ += std::memcmp(sum.data(), other.data(), sum.size() * sizeof(sum[0])) != 0;
  }
  rows.add("orders of 2000 paths that give other bits", host, 0.0, differ, 0.0);
}

constexpr Case list_of_channel_cases[] = {
    {36, "phase of long paths (36, 37, 39)", n36_long_paths},
    {38, "two rays over ground", n38_two_ray},
    {40, "wide band and long delay", n40_wide_band},
    {41, "fractional delays", n41_fractional_delays},
    {42, "Doppler shift of slow and fast ends", n42_doppler},
    {43, "order of the paths", n43_any_order},
};

}  // namespace

std::span<const Case> channel_cases() { return list_of_channel_cases; }

}  // namespace greatx::apps::selftest
