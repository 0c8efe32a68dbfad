// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares the optional outputs of a channel with the paths that it writes beside them.
#include <algorithm>
#include <cmath>
#include <complex>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "tests/sim/radio_run.h"

namespace greatx::sim {
namespace {

using sim::testing::radio_material;
using sim::testing::RadioRun;
using sim::testing::run;
using test::TinyScene;
using Complex = std::complex<double>;

constexpr double carrier_hz = 3.5e9, distance_m = 50.0;

scene::Scene street() {
  TinyScene tiny;
  const uint32_t ground = tiny.material_as(radio_material("medium_dry_ground"));
  tiny.object("ground", 0, ground).quad({-90, -90, 0}, {90, -90, 0}, {90, 90, 0}, {-90, 90, 0});
  tiny.object("wall", 0, ground).box({-20, 12, 0}, {70, 20, 30});
  return tiny.build();
}

/// Returns a scenario with a base station and a terminal of the same height, 50 m apart along x.
std::string scenario(const std::string& outputs, int depth = 2, const std::string& more = "") {
  return fmt::format(
      "greatx: 1\nname: test\nticks: 2\ntick_rate_hz: 10\nnodes:\n"
      "  - name: bs\n    trajectory: {{type: static, position_m: [0, 0, 8]}}\n"
      "    sensors: [{{name: panel, type: antenna, columns: 2, polarization: vh}}]\n"
      "  - name: ue\n    trajectory: {{type: waypoints, points: [{{t_s: 0, position_m: [{}, 0, 8]}}, {{t_s: "
      "1, "
      "position_m: [60, 0, 8]}}]}}\n"
      "    sensors: [{{name: antenna, type: antenna, polarization: vh, mount: {{rotation_deg: [180, 0, "
      "0]}}}}]\n"
      "channels:\n  - {{name: csi, tx: bs/panel, rx: ue/antenna, rate_hz: 10, subcarriers: 16, bandwidth_hz: "
      "20e6, carrier_hz: {}, max_depth: {}, time_samples: 2, time_spacing_s: 1e-3{}}}\n{}",
      distance_m, carrier_hz, depth, outputs, more);
}

template <typename T>
std::vector<Complex> doubles(const std::vector<T>& values) {
  return {values.begin(), values.end()};
}

TEST(ChannelOutputs, LineOfSightAndTheRestAddUp) {
  const RadioRun r = run(scenario(", outputs: [cfr, cfr_parts, paths]"), street());
  for (size_t packet = 0; packet < 2; ++packet) {
    const auto h = doubles(r.values<std::complex<float>>(packet, "cfr"));
    const auto sight = doubles(r.values<std::complex<float>>(packet, "cfr_line_of_sight"));
    const auto others = doubles(r.values<std::complex<float>>(packet, "cfr_others"));
    double largest = 0.0, rest = 0.0;
    for (const Complex& value : h) largest = std::max(largest, std::abs(value));
    for (size_t i = 0; i < h.size(); ++i) {
      EXPECT_LT(std::abs(sight[i] + others[i] - h[i]), 1e-6 * largest);
      rest = std::max(rest, std::abs(others[i]));
    }
    EXPECT_GT(rest, 0.01 * largest) << "there are reflections";
  }
}

TEST(ChannelOutputs, WallsSayWhereTheirValuesComeFrom) {
  TinyScene tiny;
  scene::Material street = radio_material("asphalt_concrete"), flat = radio_material("concrete", 0.2);
  street.radio->layers[0].medium.extrapolate = true;
  flat.radio->layers[0].medium = {"explicit permittivity", {{4.0, 0.0, 0.1, 0.0, 0.0, INFINITY}}, false};
  tiny.object("ground", 0, tiny.material_as(street))
      .quad({-90, -90, 0}, {90, -90, 0}, {90, 90, 0}, {-90, 90, 0});
  tiny.object("roof", 0, tiny.material_as(radio_material("metal"))).box({-20, 12, 0}, {70, 20, 30});
  tiny.object("wall", 0, tiny.material_as(flat)).box({-20, 42, 0}, {70, 50, 30});
  std::string yaml = scenario("", 1);
  yaml.replace(yaml.find("carrier_hz: 3500000000"), 22, "carrier_hz: 140e9");
  const RadioRun r = run(yaml, tiny.build());
  const nlohmann::json walls = nlohmann::json::parse(r.spec("csi").metadata_json)["walls"];
  const auto layer = [&](const std::string& name) {
    for (const nlohmann::json& wall : walls)
      if (wall["material"] == name) return wall["layers"].at(0);
    return nlohmann::json();
  };
  const nlohmann::json asphalt = layer("asphalt_concrete"), metal = layer("metal"),
                       plain = layer("concrete wall");
  EXPECT_EQ(asphalt["source"], "ITU-R P.2040-4 Table 3, asphalt_concrete");
  EXPECT_EQ(asphalt["extrapolated"], true);
  EXPECT_EQ(asphalt["range_hz"], nlohmann::json({1e9, 40e9}));
  EXPECT_EQ(metal["extrapolated"], false);
  EXPECT_EQ(metal["range_hz"], nlohmann::json({100e9, 1000e9}));
  EXPECT_EQ(plain["source"], "explicit permittivity");
  EXPECT_EQ(plain["extrapolated"], false);
  EXPECT_FALSE(plain.contains("range_hz"));
}

TEST(ChannelOutputs, WallsHaveTheirWindows) {
  TinyScene tiny;
  scene::Material facade = radio_material("concrete"), blind = radio_material("brick", 0.3);
  scene::RadioMedium air{"explicit permittivity", {{1.0, 0.0, 0.0, 0.0, 0.0, INFINITY}}, false};
  facade.radio->windows = scene::RadioWindows{0.22, {{*scene::itu_medium("glass"), 0.006}, {air, 0.016}}};
  blind.radio->windows = scene::RadioWindows{0.0, facade.radio->windows->layers};
  tiny.object("house", 0, tiny.material_as(facade)).box({-20, 12, 0}, {70, 20, 30});
  tiny.object("barn", 0, tiny.material_as(blind)).box({-20, 42, 0}, {70, 50, 30});
  const RadioRun r = run(scenario("", 1), tiny.build());
  const nlohmann::json walls = nlohmann::json::parse(r.spec("csi").metadata_json)["walls"];
  const auto wall = [&](const std::string& name) {
    for (const nlohmann::json& one : walls)
      if (one["material"] == name) return one;
    return nlohmann::json();
  };
  const nlohmann::json house = wall("concrete"), barn = wall("brick wall");
  EXPECT_EQ(house["layers"].at(0)["thickness_m"], 0.0);
  EXPECT_EQ(house["windows"]["share"], 0.22);
  ASSERT_EQ(house["windows"]["layers"].size(), 2u);
  EXPECT_EQ(house["windows"]["layers"][0]["source"], "ITU-R P.2040-4 Table 3, glass");
  EXPECT_EQ(house["windows"]["layers"][0]["thickness_m"], 0.006);
  EXPECT_EQ(house["windows"]["layers"][1]["relative_permittivity"], nlohmann::json({1.0, 0.0}));
  EXPECT_EQ(barn["layers"].size(), 1u);
  EXPECT_FALSE(barn.contains("windows")) << "none of its area";
}

TEST(ChannelOutputs, TapsAreTheSincsOfThePaths) {
  constexpr double bandwidth_hz = 40e6;
  constexpr int first = -6, count = 40;
  const RadioRun r = run(
      scenario(fmt::format(", taps: {{first: {}, count: {}, bandwidth_hz: {}}}", first, count, bandwidth_hz),
               2, "effects: {beam_squint: off}\n"),
      street());
  const auto delay = r.values<double>(1, "delay"), doppler = r.values<double>(1, "doppler");
  const auto a = doubles(r.values<std::complex<float>>(1, "amplitude"));
  const auto taps = doubles(r.values<std::complex<float>>(1, "taps"));
  constexpr size_t pairs = 2 * 4;
  ASSERT_EQ(r.array(1, "taps").shape, (std::vector<int64_t>{1, 2, 1, 4, 2, count}));
  double largest = 0.0, power = 0.0, inside = 0.0;
  for (const Complex& value : taps) largest = std::max(largest, std::abs(value));
  for (size_t pair = 0; pair < pairs; ++pair)
    for (int m = 0; m < 2; ++m)
      for (int l = 0; l < count; ++l) {
        Complex sum = 0.0;
        for (size_t i = 0; i < delay.size(); ++i) {
          const double x = pi * (first + l - bandwidth_hz * delay[i]);
          sum += a[i * pairs + pair] * std::polar(1.0, 2.0 * pi * doppler[i] * m * 1e-3) *
                 (x == 0.0 ? 1.0 : std::sin(x) / x);
        }
        EXPECT_LT(std::abs(taps[(pair * 2 + static_cast<size_t>(m)) * count + static_cast<size_t>(l)] - sum),
                  1e-6 * largest);
      }
  for (size_t i = 0; i < delay.size(); ++i)
    for (size_t pair = 0; pair < pairs; ++pair) {
      power += std::norm(a[i * pairs + pair]);
      for (int l = 0; l < count; ++l) {
        const double x = pi * (first + l - bandwidth_hz * delay[i]);
        inside += std::norm(a[i * pairs + pair]) * std::pow(x == 0.0 ? 1.0 : std::sin(x) / x, 2);
      }
    }
  EXPECT_NEAR(r.values<double>(1, "taps_power_outside")[0], 1.0 - inside / power, 1e-6);
}

TEST(ChannelOutputs, PowerFieldAndVoltageOfALineOfSight) {
  const RadioRun r =
      run(scenario(", power_dbm: 30, resistance_ohm: 73", 0, "effects: {gas: off}\n"), street());
  const double lambda = speed_of_light / carrier_hz, a = lambda / (4.0 * pi * distance_m);
  // Four of the eight pairs of ports are co-polar, so that the mean power is half of Friis' power.
  EXPECT_NEAR(r.values<double>(0, "received_power")[0], 30.0 + 20.0 * std::log10(a) - 10.0 * std::log10(2.0),
              1e-6);
  const auto field = r.values<std::complex<float>>(0, "field");
  ASSERT_EQ(r.array(0, "field").shape, (std::vector<int64_t>{1, 4, 2}));
  // The field is sqrt(30 P G)/d within 0.003 dB (Rec. ITU-R P.525). Port 0 is vertical, port 1 horizontal.
  const double expected = std::sqrt(30.0) / distance_m;
  EXPECT_NEAR(std::abs(field[0]), expected, 5e-4 * expected);
  EXPECT_NEAR(std::abs(field[3]), expected, 5e-4 * expected);
  EXPECT_LT(std::abs(field[1]) + std::abs(field[2]), 1e-6 * expected);
  const auto voltage = r.values<std::complex<float>>(0, "voltage");
  EXPECT_NEAR(std::abs(voltage[0]), std::sqrt(4.0 * 73.0 * 1.0) * a, 1e-6 * std::abs(voltage[0]));
  EXPECT_EQ(r.values<double>(0, "k_factor")[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(r.values<double>(0, "delay_spread")[0], 0.0);
}

TEST(ChannelOutputs, WhatIsNotAskedForIsNotThereAndChangesNoByte) {
  const std::vector<std::string> always = {"path_count", "path_gain", "delay_spread"};
  const RadioRun all = run(
      scenario(", outputs: [cfr, cfr_parts, coherence, paths], taps: {count: 8}, power_dbm: 10"), street());
  const RadioRun none = run(scenario(", outputs: []"), street());
  const auto names = [](const RadioRun& r) {
    std::vector<std::string> found;
    for (const SensorSpec& spec : r.sensors)
      if (spec.kind == "csi")
        for (const ArraySpec& array : spec.arrays) found.push_back(array.name);
    return found;
  };
  EXPECT_THAT(names(all),
              ::testing::IsSupersetOf({"cfr", "cfr_others", "coherence_time", "taps", "field", "id"}));
  for (const char* name : {"cfr", "cfr_others", "coherence_time", "taps", "field", "received_power", "id"})
    EXPECT_THAT(names(none), ::testing::Not(::testing::Contains(name)));
  for (size_t packet = 0; packet < 2; ++packet)
    for (const std::string& name : names(none))
      EXPECT_TRUE(none.array(packet, name).bytes == all.array(packet, name).bytes) << name;
  EXPECT_THAT(names(none), ::testing::IsSupersetOf(always));
}

TEST(ChannelOutputs, HardCaseN64NoPathGivesEmptyAndStatedValues) {
  const RadioRun r =
      run(scenario(", outputs: [cfr, cfr_parts, coherence, paths], taps: {count: 8}, power_dbm: 10", 0,
                   "effects: {line_of_sight: off}\n"),
          street());
  EXPECT_EQ(r.values<int32_t>(0, "path_count")[0], 0);
  EXPECT_EQ(r.values<double>(0, "path_gain")[0], 0.0);
  EXPECT_EQ(r.values<double>(0, "received_power")[0], -std::numeric_limits<double>::infinity());
  for (const char* name : {"delay_spread", "mean_delay", "coherence_bandwidth", "arrival_zenith_spread"})
    EXPECT_TRUE(std::isnan(r.values<double>(0, name)[0])) << name;
  for (const char* name : {"cfr", "cfr_others", "taps"})
    EXPECT_THAT(r.values<std::complex<float>>(0, name), ::testing::Each(std::complex<float>(0.0f))) << name;
  EXPECT_TRUE(r.values<std::complex<float>>(0, "field").empty());
  EXPECT_EQ(r.values<double>(0, "taps_power_outside")[0], 0.0);
}

}  // namespace
}  // namespace greatx::sim
