// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares greatx with the formulas of the left column of docs/formulas.md, which this file implements on its
// own. Numbers in parentheses are equation numbers of the primer that the page names.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "rf/atmosphere/path_attenuation.h"
#include "rf/channel/received.h"
#include "rf/field/field.h"
#include "rf/geometry/geometry.h"
#include "tests/rf/channel_paths.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::exhaustive_candidates;
using testing::HandScene;
using testing::solve_paths;
using testing::wide_phasor;

constexpr double seed_carrier_hz = 28e9;
constexpr double impedance_ohm = 376.730313668;  // Z_0, as printed in CODATA

struct Pair {
  Complex a{0.0}, b{0.0};
};
struct Basis {
  dvec3 a, b;
};

/// Converts components on (q, r) to components on (a, b) by (30).
Pair w(const Basis& to, const Basis& from, const Pair& e) {
  return {glm::dot(to.a, from.a) * e.a + glm::dot(to.a, from.b) * e.b,
          glm::dot(to.b, from.a) * e.a + glm::dot(to.b, from.b) * e.b};
}

/// Returns the reflection coefficients of (34).
Pair fresnel(Complex eta, double cosine) {
  const Complex root = std::sqrt(eta - (1.0 - cosine * cosine));
  return {(cosine - root) / (cosine + root), (eta * cosine - root) / (eta * cosine + root)};
}

struct SeedPath {
  Pair field;  ///< peak value on theta-hat and phi-hat of the direction of arrival
  Complex voltage;
  Complex response;  ///< contribution to H(f)
};

struct SeedLink {
  double power_w, resistance_ohm, humid_db_per_km;
  Complex eta;
};

/// Computes one path from vertex to vertex for vertically polarized isotropic antennas: F = theta-hat, G = 1.
SeedPath seed_path(const GeometricPath& path, const HandScene& hand, const SeedLink& link) {
  const std::vector<dvec3>& at = path.vertices;
  dvec3 k = glm::normalize(at[1] - at[0]);
  Basis basis{theta_hat(k), phi_hat(k)};
  Pair field{std::sqrt(link.power_w * impedance_ohm / (2 * pi)), 0.0};  // (15)
  double length = glm::length(at[1] - at[0]);
  for (size_t i = 0; i < path.interactions.size(); ++i) {
    const dvec3 next = at[i + 2] - at[i + 1], k_r = glm::normalize(next);
    dvec3 n = hand.scene.facets[path.interactions[i].element].normal;
    if (glm::dot(n, k) > 0.0) n = -n;
    const dvec3 across = glm::normalize(glm::cross(k, n));  // (29)
    const Basis in{across, glm::cross(across, k)};          // (29)
    const Basis out{across, glm::cross(across, k_r)};       // (31)
    const Pair r = fresnel(link.eta, -glm::dot(k, n));      // (34)
    const Pair incident = w(in, basis, field);
    field = {r.a * incident.a, r.b * incident.b};
    basis = out;
    k = k_r;
    length += glm::length(next);
  }
  const Basis arriving{theta_hat(-k), phi_hat(-k)};
  field = w(arriving, basis, field);
  const Complex spreading(wide_phasor(seed_carrier_hz, length / speed_of_light));
  const double humid = std::pow(10.0, -link.humid_db_per_km * length / 1000.0 / 20.0);
  for (Complex* part : {&field.a, &field.b}) *part *= spreading / length * humid;
  const double wavelength = speed_of_light / seed_carrier_hz;
  // (21), C_R = theta-hat.
  const Complex voltage =
      std::sqrt(wavelength * wavelength / (4 * pi) * 4 * link.resistance_ohm / impedance_ohm) * field.a;
  // (24), with (16) and equal impedances.
  return {field, voltage, voltage / std::sqrt(8 * link.resistance_ohm * link.power_w)};
}

TEST(SeedFormulas, PathByPath) {
  HandScene hand;
  hand.material("wall", 5.24, 0.2);
  hand.room({7, 5, 3});
  const Weather humid_air{.water_vapour_g_m3 = 20.0};
  const WeatherEffects gas_alone{.gas = true, .rain = false, .fog = false};
  const FacetWorld world(hand.scene);
  const RadioSurfaces surfaces(hand.scene, seed_carrier_hz);
  FieldModel model{&world, &surfaces};
  model.effects.gas = true;
  model.attenuation = path_attenuation(humid_air, seed_carrier_hz, gas_alone);
  const SeedLink link{2.5, 73.1, model.attenuation.gas,
                      Complex(5.24, -0.2 / (2 * pi * seed_carrier_hz * vacuum_permittivity))};
  const dvec3 tx(1.1, 2.2, 0.7), rx(5.3, 3.1, 2.2);
  std::vector<Path> paths;
  std::vector<SeedPath> seeds;
  for (const GeometricPath& path : solve_paths(world, tx, rx, exhaustive_candidates(6, 3))) {
    paths.push_back(path_field(path, model, dvec3(0.0), dvec3(0.0)));
    seeds.push_back(seed_path(path, hand, link));
  }
  ASSERT_EQ(paths.size(), 1u + 6 + 18 + 38);
  const ArrayPose vertical = testing::antenna();
  const Received ours = received(paths, vertical, vertical,
                                 {.carrier_hz = seed_carrier_hz,
                                  .transmit_power_w = link.power_w,
                                  .resistance_ohm = link.resistance_ohm});
  const auto response =
      frequency_response_fp64(paths, vertical, vertical, {seed_carrier_hz, 30e3, 1, 1, 1e-3});
  Complex whole = 0.0;
  double size = 0.0;
  for (size_t i = 0; i < paths.size(); ++i) {
    // Lengths that are summed over segments, and the phases from them, are accurate to 1e-8 rad here.
    const ReceivedPath& path = ours.paths[i];
    const double peak = std::sqrt(2.0);
    const double scale = std::abs(seeds[i].field.a) + std::abs(seeds[i].field.b);
    EXPECT_LT(std::abs(peak * path.field_v_per_m.theta - seeds[i].field.a), 1e-7 * scale) << i;
    EXPECT_LT(std::abs(peak * path.field_v_per_m.phi - seeds[i].field.b), 1e-7 * scale) << i;
    const double volts =
        speed_of_light / seed_carrier_hz * std::sqrt(link.resistance_ohm / (pi * impedance_ohm)) * scale;
    EXPECT_LT(std::abs(peak * path.open_circuit_v - seeds[i].voltage), 1e-7 * volts) << i;
    EXPECT_NEAR(path.power_w, std::norm(seeds[i].voltage) / (8 * link.resistance_ohm),  // (20)
                1e-7 * volts * volts / link.resistance_ohm);
    whole += seeds[i].response;  // (26)
    size += std::abs(seeds[i].response);
  }
  EXPECT_LT(std::abs(whole - response[0]), 1e-7 * size);
  EXPECT_LT(std::abs(whole - ours.amplitude), 1e-7 * size);
}

TEST(SeedFormulas, HumidityCounts) {
  // The factor is not 1: over 10 km at 28 GHz, air with 20 g/m3 attenuates more than dry air.
  const WeatherEffects gas_alone{.gas = true, .rain = false, .fog = false};
  const double dry = path_attenuation({.water_vapour_g_m3 = 0.0}, seed_carrier_hz, gas_alone).gas;
  const double humid = path_attenuation({.water_vapour_g_m3 = 20.0}, seed_carrier_hz, gas_alone).gas;
  EXPECT_GT(humid, 2.0 * dry);
  EXPECT_DOUBLE_EQ(amplitude(humid, 10e3), std::pow(10.0, -humid * 10.0 / 20.0));
}

}  // namespace
}  // namespace greatx::rf
