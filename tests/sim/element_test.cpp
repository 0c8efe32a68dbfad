// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests arrays in their near field: each pair of elements against closed forms, and the error of a plane
// wave.
#include <cmath>
#include <complex>
#include <limits>
#include <sched.h>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/parallel.h"
#include "core/units.h"
#include "sim/plan/array_plan.h"
#include "tests/sim/radio_run.h"

namespace greatx::sim {
namespace {

using sim::testing::expect_same_bytes;
using sim::testing::radio_material;
using sim::testing::RadioRun;
using sim::testing::run;
using test::TinyScene;

constexpr int subcarriers = 16;
constexpr double element_carrier_hz = 28e9, bandwidth_hz = 100e6;

/// Returns a scenario with a 4 x 8 panel at the origin that looks along +x, and one antenna on the x axis at
/// each distance.
std::string element_scenario(const std::vector<double>& distances_m, const std::string& effects,
                             const std::string& panel = "rows: 4, columns: 8",
                             const std::string& channel = "") {
  std::string text =
      "greatx: 1\nname: test\nticks: 1\ntick_rate_hz: 10\nnodes:\n"
      "  - name: bs\n    trajectory: {type: static, position_m: [0, 0, 0]}\n"
      "    sensors: [{name: panel, type: antenna, " +
      panel + "}]\n";
  std::string receivers;
  for (size_t i = 0; i < distances_m.size(); ++i) {
    text += fmt::format(
        "  - name: ue{}\n    trajectory: {{type: static, position_m: [{}, 0, 0]}}\n"
        "    sensors: [{{name: antenna, type: antenna}}]\n",
        i, distances_m[i]);
    receivers += fmt::format("{}ue{}/antenna", i == 0 ? "" : ", ", i);
  }
  return text + fmt::format(
                    "channels:\n  - {{name: csi, tx: bs/panel, rx: [{}], rate_hz: 10, subcarriers: {}, "
                    "bandwidth_hz: {}, carrier_hz: {}, max_depth: 1{}}}\n{}",
                    receivers, subcarriers, bandwidth_hz, element_carrier_hz, channel, effects);
}

scene::Scene nothing() {
  // One triangle far below. Another test covers a scene without triangles.
  TinyScene tiny;
  tiny.object("far", 0, tiny.material_as(radio_material("concrete")))
      .triangle({0, 0, -9e3}, {1, 0, -9e3}, {0, 1, -9e3});
  return tiny.build();
}

/// Returns sum |a - b|^2 / sum |a|^2 over receiver `r`, in dB.
double nmse_db(const std::vector<std::complex<float>>& a, const std::vector<std::complex<float>>& b, size_t r,
               size_t receivers) {
  const size_t count = a.size() / receivers;
  double error = 0.0, power = 0.0;
  for (size_t i = r * count; i < (r + 1) * count; ++i) {
    error += std::norm(std::complex<double>(a[i]) - std::complex<double>(b[i]));
    power += std::norm(std::complex<double>(a[i]));
  }
  return 10.0 * std::log10(error / power);
}

constexpr const char* forced = "effects: {line_of_sight: on, reflection: off, gas: off, every_element: on}\n";
constexpr const char* plane =
    "effects: {line_of_sight: on, reflection: off, gas: off, every_element: off, wave_curvature: off}\n";
constexpr const char* curved =
    "effects: {line_of_sight: on, reflection: off, gas: off, every_element: off}\n";

/// The simulator, `greatx paths --cfr` and Python use the same rule.
TEST(EveryElement, OneRuleSaysWhichLinksAreSolvedElementByElement) {
  const auto within = [](const std::string& effects, const std::string& channel, const char* from) {
    const Scenario parsed =
        parse_scenario(element_scenario({5.0}, effects, "rows: 4, columns: 8", channel), "test.yaml", ".");
    const ChannelConfig& config = parsed.channels[0];
    rf::AntennaArray panel, single;
    panel.rows = 4, panel.columns = 8;
    panel.row_spacing_m = panel.column_spacing_m = 0.5 * speed_of_light / config.carrier_hz;
    return every_element_within_m(parsed, config, from == std::string("panel") ? panel : single, single);
  };
  EXPECT_NEAR(within("", "", "panel"), 0.3105, 1e-4);
  EXPECT_NEAR(within("effects: {every_element: auto}\n", "", "panel"), 0.3105, 1e-4);
  EXPECT_EQ(within("effects: {every_element: on}\n", "", "panel"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(within("effects: {every_element: off}\n", "", "panel"), 0.0);
  for (const char* effects : {"", "effects: {every_element: on}\n"}) {
    EXPECT_EQ(within(effects, ", candidates: rays", "panel"), 0.0) << effects;
    EXPECT_EQ(within(effects, "", "one antenna"), 0.0) << effects;
  }
}

TEST(EveryElement, IsFriisBetweenEveryTwoElements) {
  const RadioRun r = run(element_scenario({5.0}, forced), nothing());
  const auto h = r.values<std::complex<float>>(0, "cfr");
  EXPECT_EQ(r.values<uint8_t>(0, "every_element"), std::vector<uint8_t>{1});
  EXPECT_EQ(r.counter("every_element_paths"), 32u);
  const double wavelength = speed_of_light / element_carrier_hz;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 8; ++column) {
      const double y = (column - 3.5) * 0.5 * wavelength, z = (row - 1.5) * 0.5 * wavelength;
      const double distance = std::hypot(5.0, y, z);
      for (int k = 0; k < subcarriers; ++k) {
        const double f = element_carrier_hz + (k - subcarriers / 2) * bandwidth_hz / subcarriers;
        const std::complex<double> expected = std::polar(
            wavelength / (4.0 * pi * distance), -2.0 * pi * std::fmod(f * (distance / speed_of_light), 1.0));
        const std::complex<double> found(h[static_cast<size_t>((row * 8 + column) * subcarriers + k)]);
        EXPECT_LT(std::abs(found - expected) / std::abs(expected), 2e-7) << row << ' ' << column << ' ' << k;
      }
    }
}

TEST(EveryElement, PairsOfElementsArePlannedBeforeTheyAreMade) {
  const std::string far = "effects: {line_of_sight: on, reflection: off}\n";
  try {
    run(element_scenario({1.0, 2.0}, far, "rows: 800, columns: 700"), nothing());
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(),
                ::testing::AllOf(::testing::HasSubstr("channel 'csi': bs/panel and ue1/antenna"),
                                 ::testing::HasSubstr("every_element: off"),
                                 ::testing::HasSubstr("at most 1048576 pairs of elements"),
                                 ::testing::HasSubstr("found 1120000")));
  }
}

TEST(EveryElement, APlaneWaveCostsWhatTheDistanceSays) {
  const std::vector<double> distances{5.0, 10.0, 20.0, 50.0, 100.0};
  const RadioRun exact = run(element_scenario(distances, forced, "rows: 1, columns: 32"), nothing());
  const RadioRun wave = run(element_scenario(distances, plane, "rows: 1, columns: 32"), nothing());
  EXPECT_EQ(wave.values<uint8_t>(0, "every_element"), std::vector<uint8_t>(5, 0));
  const auto h = exact.values<std::complex<float>>(0, "cfr"), p = wave.values<std::complex<float>>(0, "cfr");
  const double wavelength = speed_of_light / element_carrier_hz;
  for (size_t r = 0; r < distances.size(); ++r) {
    // A plane wave lacks the phase k y^2/(2 d). The amplitudes agree to (y/d)^2.
    double expected = 0.0;
    for (int i = 0; i < 32; ++i) {
      const double y = (i - 15.5) * 0.5 * wavelength;
      const double phase = 2.0 * pi / wavelength * (std::hypot(distances[r], y) - distances[r]);
      expected += std::norm(std::polar(1.0, -phase) - 1.0) / 32.0;
    }
    EXPECT_NEAR(nmse_db(h, p, r, distances.size()), 10.0 * std::log10(expected), 0.02) << distances[r];
  }
  // Reference values for a line of 32 elements at 28 GHz.
  EXPECT_NEAR(nmse_db(h, p, 0, distances.size()), -14.4, 0.1);
  EXPECT_NEAR(nmse_db(h, p, 4, distances.size()), -40.3, 0.1);
}

TEST(EveryElement, ACurvedWaveLacksAmplitudesAlone) {
  const std::vector<double> distances{5.0, 10.0, 20.0, 50.0, 100.0};
  const RadioRun exact = run(element_scenario(distances, forced, "rows: 1, columns: 32"), nothing());
  const RadioRun wave = run(element_scenario(distances, curved, "rows: 1, columns: 32"), nothing());
  EXPECT_TRUE(wave.plan.wave_curvature.on);
  const auto h = exact.values<std::complex<float>>(0, "cfr"), w = wave.values<std::complex<float>>(0, "cfr");
  const double wavelength = speed_of_light / element_carrier_hz;
  for (size_t r = 0; r < distances.size(); ++r) {
    // The distance of an element is sqrt(d^2 + y^2), and its amplitude d over that.
    double expected = 0.0;
    for (int i = 0; i < 32; ++i) {
      const double y = (i - 15.5) * 0.5 * wavelength;
      const double ratio = distances[r] / std::hypot(distances[r], y);
      expected += (1.0 - ratio) * (1.0 - ratio) / 32.0;
    }
    EXPECT_NEAR(nmse_db(h, w, r, distances.size()), 10.0 * std::log10(expected), 0.5) << distances[r];
  }
}

TEST(EveryElement, IsChosenWithinTheFarFieldDistanceAlone) {
  // D = sqrt(3.5^2 + 1.5^2) lambda: 2 D^2 / lambda = 29 lambda = 0.3105 m.
  const RadioRun r =
      run(element_scenario({0.3, 0.32}, "effects: {line_of_sight: on, reflection: off}\n"), nothing());
  EXPECT_TRUE(r.plan.every_element.on);
  EXPECT_THAT(r.plan.every_element.bound, ::testing::HasSubstr("0.31 m"));
  EXPECT_EQ(r.values<uint8_t>(0, "every_element"), (std::vector<uint8_t>{1, 0}));
  EXPECT_EQ(r.counter("every_element_links"), 1u);
  const RadioRun far =
      run(element_scenario({0.32, 9.0}, "effects: {line_of_sight: on, reflection: off}\n"), nothing());
  EXPECT_FALSE(far.plan.every_element.on) << "no link comes near enough";
  EXPECT_EQ(far.statistics.counters.count("csi.every_element_links"), 0u) << "nothing of it is built";
}

TEST(EveryElement, AnEdgeMayHideSomeElementsAndNotOthers) {
  // A half plane z < 0 before the panel hides the rows below the axis from a receiver on the axis.
  TinyScene tiny;
  tiny.object("screen", 0, tiny.material_as(radio_material("metal")))
      .quad({2, -50, -50}, {2, 50, -50}, {2, 50, -1e-4}, {2, -50, -1e-4});
  const RadioRun r = run(element_scenario({4.0}, forced), tiny.build());
  const auto h = r.values<std::complex<float>>(0, "cfr");
  for (size_t element = 0; element < 32; ++element) {
    const bool below = element < 16;
    EXPECT_EQ(h[element * subcarriers] == std::complex<float>(0.0f), below) << element;
  }
  EXPECT_EQ(r.counter("every_element_paths"), 16u);
}

TEST(EveryElement, PortsKeepTheirPlacesAtBothEnds) {
  // For two distant cross-polarized panels the sum over elements and the plane wave agree port by port.
  const std::string panel = "rows: 2, columns: 3, polarization: slant, pattern: tr38901";
  std::string yaml[2];
  for (int i = 0; i < 2; ++i) {
    yaml[i] = element_scenario({400.0}, i == 0 ? forced : plane, panel);
    const std::string single = "{name: antenna, type: antenna}";
    yaml[i].replace(
        yaml[i].find(single), single.size(),
        "{name: antenna, type: antenna, rows: 3, columns: 1, polarization: vh, mount: {rotation_deg: "
        "[170, 5, 20]}}");
  }
  const RadioRun exact = run(yaml[0], nothing()), wave = run(yaml[1], nothing());
  EXPECT_EQ(exact.array(0, "cfr").shape, (std::vector<int64_t>{1, 6, 1, 12, 1, subcarriers}));
  EXPECT_LT(
      nmse_db(exact.values<std::complex<float>>(0, "cfr"), wave.values<std::complex<float>>(0, "cfr"), 0, 1),
      -80.0);
}

TEST(EveryElement, HardCaseN63ThreadsChangeNoByte) {
  const std::string yaml = element_scenario({0.2, 5.0}, forced);
  const RadioRun all = run(yaml, nothing());
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  cpu_set_t one;
  CPU_ZERO(&one);
  for (int core = 0; core < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++core)
    if (CPU_ISSET(core, &before)) CPU_SET(core, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const RadioRun alone = run(yaml, nothing());
  ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
  expect_same_bytes(all, alone, "one core");
}

TEST(EveryElement, AResumeInTheNearFieldGivesTheSameBytes) {
  // The receiver comes into the near field at tick 3. There the search runs from the single elements for the
  // first time.
  std::string yaml = element_scenario({0.25}, "effects: {line_of_sight: on, reflection: on}\n");
  const std::string still = "trajectory: {type: static, position_m: [0.25, 0, 0]}";
  yaml.replace(
      yaml.find(still), still.size(),
      "trajectory: {type: waypoints, points: [{t_s: 0, position_m: [0.5, 0, 0]}, {t_s: 0.5, position_m: "
      "[0.1, 0, 0]}]}");
  yaml.replace(yaml.find("ticks: 1\n"), 9, "ticks: 6\n");
  TinyScene tiny;
  tiny.object("wall", 0, tiny.material_as(radio_material("concrete"))).box({-1, 0.4, -1}, {1, 0.6, 1});
  const scene::Scene scene = tiny.build();
  const RadioRun whole = run(yaml, scene);
  std::vector<int> near;
  for (size_t packet = 0; packet < whole.packets.size(); ++packet)
    near.push_back(whole.values<uint8_t>(packet, "every_element")[0]);
  EXPECT_THAT(near, ::testing::ElementsAre(0, 0, 0, 1, 1, 1));
  for (const int64_t first : {2, 4}) {
    RadioRun rest = run(yaml, scene, first), same = whole;
    same.packets.erase(same.packets.begin(), same.packets.begin() + first);
    expect_same_bytes(same, rest, fmt::format("from tick {}", first));
  }
}

TEST(EveryElement, MoreElementsThanATickHasTimestampsFor) {
  // 17 x 16 elements make as many crossings to record in one tick.
  const RadioRun r = run(element_scenario({0.5}, forced, "rows: 17, columns: 16"), nothing());
  EXPECT_EQ(r.counter("every_element_paths"), 272u);
}

TEST(EveryElement, AnElementOffTheOriginHasItsOwnDistance) {
  // One element lies 0.4 m before the mount. A path from the mount would be 0.4 m too long.
  const double offset_wl = 0.4 * element_carrier_hz / speed_of_light;
  const RadioRun r =
      run(element_scenario({2.0}, forced, fmt::format("elements_wl: [[{}, 0, 0]]", offset_wl)), nothing());
  const auto h = r.values<std::complex<float>>(0, "cfr");
  const double expected = speed_of_light / element_carrier_hz / (4.0 * pi * 1.6);
  EXPECT_NEAR(std::abs(h[0]), expected, 1e-5 * expected);
}

TEST(SeveralTransmitters, EachLinkIsThatOfAChannelOfItsOwn) {
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(radio_material("medium_dry_ground")))
      .quad({-40, -40, 0}, {40, -40, 0}, {40, 40, 0}, {-40, 40, 0});
  const scene::Scene scene = tiny.build();
  const auto yaml = [](const std::string& tx, const std::string& rx) {
    std::string text =
        "greatx: 1\nname: test\nticks: 2\ntick_rate_hz: 10\nnodes:\n"
        "  - name: a\n    trajectory: {type: static, position_m: [0, 0, 10]}\n"
        "    sensors: [{name: x, type: antenna, rows: 2, polarization: slant}]\n"
        "  - name: b\n    trajectory: {type: static, position_m: [20, 5, 8]}\n"
        "    sensors: [{name: x, type: antenna, rows: 2, polarization: vh}]\n"
        "  - name: c\n    trajectory: {type: static, position_m: [9, -7, 2]}\n"
        "    sensors: [{name: x, type: antenna, polarization: vh}]\n"
        "  - name: d\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [3, 3, 1]}, {t_s: 1, "
        "position_m: [8, 3, 1]}]}\n"
        "    sensors: [{name: x, type: antenna, polarization: slant}]\n";
    return text + "channels:\n  - {name: csi, tx: [" + tx + "], rx: [" + rx +
           "], rate_hz: 10, subcarriers: 8, bandwidth_hz: 1e6, carrier_hz: 3.5e9, max_depth: 1}\n";
  };
  const RadioRun both = run(yaml("a/x, b/x", "c/x, d/x"), scene);
  ASSERT_EQ(both.array(0, "cfr").shape, (std::vector<int64_t>{2, 2, 2, 4, 1, 8}));
  ASSERT_EQ(both.array(0, "path_gain").shape, (std::vector<int64_t>{2, 2}));
  const char *tx[] = {"a/x", "b/x"}, *rx[] = {"c/x", "d/x"};
  for (size_t packet = 0; packet < 2; ++packet) {
    const auto h = both.values<std::complex<float>>(packet, "cfr");
    const auto gain = both.values<double>(packet, "path_gain");
    const auto path_rx = both.values<int32_t>(packet, "rx"), path_tx = both.values<int32_t>(packet, "tx");
    const auto delay = both.values<double>(packet, "delay");
    for (size_t r = 0; r < 2; ++r)
      for (size_t t = 0; t < 2; ++t) {
        const RadioRun one = run(yaml(tx[t], rx[r]), scene);
        const auto own = one.values<std::complex<float>>(packet, "cfr");
        for (size_t u = 0; u < 2; ++u)
          for (size_t i = 0; i < 4 * 8; ++i) EXPECT_EQ(h[((r * 2 + u) * 2 + t) * 32 + i], own[u * 32 + i]);
        EXPECT_EQ(gain[r * 2 + t], one.values<double>(packet, "path_gain")[0]);
        std::vector<double> delays;
        for (size_t i = 0; i < delay.size(); ++i)
          if (path_rx[i] == static_cast<int32_t>(r) && path_tx[i] == static_cast<int32_t>(t))
            delays.push_back(delay[i]);
        EXPECT_EQ(delays, one.values<double>(packet, "delay"));
      }
  }
}

}  // namespace
}  // namespace greatx::sim
