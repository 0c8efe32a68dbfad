// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs channels with targets: the radar equation through H, Doppler ellipses, legs over surfaces,
// reciprocity, and what a channel senses.
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/kept_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;
using ::testing::Each;
using ::testing::HasSubstr;
using Complex = std::complex<double>;

/// Returns a table of one cross-section for all directions.
std::string constant_table(double dbsm) {
  std::string text = "theta_deg,phi_deg,rcs_dbsm\n";
  for (const int theta : {0, 90, 180})
    for (const int phi : {0, 90, 180, 270}) text += fmt::format("{},{},{}\n", theta, phi, dbsm);
  return text;
}

class ChannelTargets : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_.path() / "one.csv") << constant_table(0.0);
    std::ofstream(folder_.path() / "ten.csv") << constant_table(10.0);
  }
  KeptRun run(const std::string& yaml, int64_t first_tick = 0) const {
    return keep_run(make_experiment(parse_scenario(yaml, "test.yaml", folder_.path())), 0, first_tick);
  }

  test::TemporaryFolder folder_;
};

const std::string still = "{type: static, position_m: [40, 30, 12]}";
std::string line(const dvec3& from, const dvec3& velocity) {
  const dvec3 to = from + velocity;
  return fmt::format(
      "{{type: waypoints, interpolation: linear, points: [{{t_s: 0, position_m: [{}, {}, {}]}}, "
      "{{t_s: 1, position_m: [{}, {}, {}]}}]}}",
      from.x, from.y, from.z, to.x, to.y, to.z);
}

/// Returns two masts and a drone. The centre of the drone's box is not its origin, which mounts make up for.
std::string open_sky(const std::string& trajectory, const std::string& channel,
                     const std::string& more = "") {
  return "greatx: 1\nname: test\nseed: 5\nticks: 3\ntick_rate_hz: 10\n"
         "nodes:\n"
         "  - name: bs\n    trajectory: {type: static, position_m: [0, 0, 10]}\n"
         "    sensors: [{name: a, type: antenna}, {name: row, type: antenna, columns: 4, polarization: vh}]\n"
         "  - name: far\n    trajectory: {type: static, position_m: [90, -20, 4]}\n"
         "    sensors: [{name: a, type: antenna}, {name: pair, type: antenna, columns: 2, polarization: "
         "slant}]\n"
         "  - name: drone\n    trajectory: " +
         trajectory +
         "\n    model: {generate: {kind: quadrotor, variant: large}}\n"
         "    sensors: [{name: a, type: antenna, mount: {position_m: [0, 0, -0.5]}}]\n"
         "channels:\n  - {name: csi, rate_hz: 10, subcarriers: 4, bandwidth_hz: 1e6, " +
         channel + "}\n" + more;
}

dvec3 target_vertex(const KeptRun& run, size_t packet) {
  const auto vertex = run.array<double>(packet, "csi", "vertex");
  const auto interaction = run.array<uint8_t>(packet, "csi", "interaction");
  const size_t depth = interaction.size() / run.array<double>(packet, "csi", "delay").size();
  for (size_t i = 0; i < interaction.size(); ++i)
    if (interaction[i] == 5) return {vertex[3 * i], vertex[3 * i + 1], vertex[3 * i + 2]};
  ADD_FAILURE() << "no echo, depth " << depth;
  return {};
}

TEST_F(ChannelTargets, TheRadarEquationHoldsThroughH) {
  for (const double carrier_hz : {1e9, 3.5e9, 28e9, 77e9}) {
    const KeptRun one = run(open_sky(
        still,
        fmt::format("tx: bs/a, rx: bs/a, carrier_hz: {}, targets: [{{nodes: drone, table: one.csv}}]",
                    carrier_hz),
        "effects: {gas: off}\n"));
    const dvec3 place = target_vertex(one, 0);
    const double r = glm::distance(place, dvec3(0, 0, 10)), lambda = speed_of_light / carrier_hz;
    const double expected = lambda * lambda / (std::pow(4.0 * pi, 3) * std::pow(r, 4));
    const auto h = one.array<std::complex<float>>(0, "csi", "cfr");
    EXPECT_NEAR(10.0 * std::log10(std::norm(Complex(h[2])) / expected), 0.0, 1e-4) << carrier_hz;
    EXPECT_EQ(one.array<int32_t>(0, "csi", "path_count")[0], 1);  // and no line of sight to itself
    EXPECT_EQ(one.array<uint8_t>(0, "csi", "line_of_sight")[0], 0);
    EXPECT_NEAR(one.array<double>(0, "csi", "delay")[0], 2.0 * r / speed_of_light, 1e-18);
    EXPECT_THAT(one.instances.at(one.array<uint32_t>(0, "csi", "object")[0] - 1).name,
                ::testing::StartsWith("drone"));
    EXPECT_NEAR(one.array<double>(0, "csi", "path_gain")[0] / expected, 1.0, 1e-9);
  }
}

TEST_F(ChannelTargets, TheCrossSectionOfTheTableCounts) {
  const auto gain = [&](const std::string& table) {
    const KeptRun kept =
        run(open_sky(still, "tx: bs/a, rx: far/a, targets: [{nodes: drone, table: " + table + "}]"));
    const auto amplitude = kept.array<std::complex<float>>(0, "csi", "amplitude");
    return std::norm(Complex(amplitude[1]));  // the echo; the line of sight comes first
  };
  EXPECT_NEAR(gain("ten.csv") / gain("one.csv"), 10.0, 1e-5);
}

/// A target on an ellipse about both ends shifts no frequency; across it, by 2 v cos(beta/2)/lambda.
TEST_F(ChannelTargets, DopplerShiftsFollowTheEllipse) {
  const dvec3 tx(0, 0, 10), rx(90, -20, 4), from(40, 30, 12);
  const dvec3 place = target_vertex(
      run(open_sky(still, "tx: bs/a, rx: far/a, targets: [{nodes: drone, table: one.csv}]")), 0);
  const dvec3 out = glm::normalize(tx - place), home = glm::normalize(rx - place);
  const dvec3 across = glm::normalize(out + home);
  const dvec3 along = glm::normalize(glm::cross(across, glm::cross(out, home)));
  const double half_angle = 0.5 * std::acos(glm::dot(out, home)), lambda = speed_of_light / 28e9;
  const auto doppler = [&](const dvec3& velocity) {
    // The drone turns with its velocity and with it the centre of its box; the attitude is fixed here.
    const dvec3 to = from + velocity;
    const std::string trajectory = fmt::format(
        "{{type: waypoints, interpolation: linear, points: [{{t_s: 0, position_m: [{}, {}, {}], "
        "rotation_deg: "
        "[0, 0, 0]}}, {{t_s: 1, position_m: [{}, {}, {}], rotation_deg: [0, 0, 0]}}]}}",
        from.x, from.y, from.z, to.x, to.y, to.z);
    const KeptRun kept = run(open_sky(
        trajectory, "tx: bs/a, rx: far/a, carrier_hz: 28e9, targets: [{nodes: drone, table: one.csv}]"));
    EXPECT_LT(glm::distance(target_vertex(kept, 0), place), 1e-9);
    return kept.array<double>(0, "csi", "doppler")[1];
  };
  EXPECT_NEAR(doppler(20.0 * along), 0.0, 1e-6);
  EXPECT_NEAR(doppler(20.0 * across), 40.0 * std::cos(half_angle) / lambda, 1e-6);
  EXPECT_NEAR(doppler(-7.0 * out), -7.0 * (1.0 + glm::dot(out, home)) / lambda, 1e-6);
}

/// The shift is the rate of the length that the next ticks show.
TEST_F(ChannelTargets, DopplerIsTheRateOfTheDelay) {
  const KeptRun kept = run(open_sky(line({40, 30, 12}, {3, -8, 1}),
                                    "tx: bs/a, rx: bs/a, carrier_hz: 28e9, targets: [{nodes: drone, tr38901: "
                                    "uav_large}]"));
  const auto delay = [&](size_t packet) { return kept.array<double>(packet, "csi", "delay")[0]; };
  const double rate = (delay(2) - delay(0)) / 0.2;
  EXPECT_NEAR(kept.array<double>(1, "csi", "doppler")[0], -28e9 * rate, 0.5);  // curvature over 0.2 s
}

std::string room(const std::string& channel, const std::string& more = "") {
  return "greatx: 1\nname: test\nseed: 5\nticks: 2\ntick_rate_hz: 10\n"
         "scene: {generate: {kind: room}}\n"
         "nodes:\n"
         "  - name: bs\n    trajectory: {type: static, position_m: [1, 1, 1.5]}\n"
         "    sensors: [{name: a, type: antenna}, {name: row, type: antenna, columns: 4}]\n"
         "  - name: user\n    trajectory: {type: static, position_m: [3, 1.2, 1]}\n"
         "    sensors: [{name: a, type: antenna, polarization: vh}]\n"
         "  - name: drone\n    trajectory: {type: static, position_m: [2.2, 2.3, 1.2], rotation_deg: [20, 0, "
         "0]}\n"
         "    model: {generate: {kind: quadrotor, variant: small}}\n"
         "channels:\n  - {name: csi, rate_hz: 10, subcarriers: 4, bandwidth_hz: 1e6, max_transmissions: 0, " +
         channel + "}\n" + more;
}

TEST_F(ChannelTargets, LegsReflectAndMeetInThePoint) {
  const KeptRun direct =
      run(room("tx: bs/a, rx: user/a, max_depth: 0, targets: [{nodes: drone, tr38901: "
               "uav_small}], legs: {max_depth: 0}"));
  EXPECT_EQ(direct.counter("csi.target_echoes"), 2u);  // one a tick: line of sight both ways
  const KeptRun once =
      run(room("tx: bs/a, rx: user/a, max_depth: 0, targets: [{nodes: drone, tr38901: "
               "uav_small}], legs: {max_depth: 1, max_transmissions: 0}"));
  // Each leg has the line of sight and six reflections.
  EXPECT_EQ(once.counter("csi.target_echoes"), 2u * 49u);
  const auto interaction = once.array<uint8_t>(0, "csi", "interaction");
  EXPECT_EQ(once.array(0, "csi", "interaction").shape[1], 3);
  const auto vertex = once.array<double>(0, "csi", "vertex");
  const auto delay = once.array<double>(0, "csi", "delay");
  const dvec3 place = target_vertex(direct, 0);
  for (size_t path = 0; path < delay.size(); ++path) {
    dvec3 at(1, 1, 1.5);
    double length = 0.0;
    for (size_t i = 0; i < 3 && interaction[3 * path + i] != 0; ++i) {
      const dvec3 next(vertex[3 * (3 * path + i)], vertex[3 * (3 * path + i) + 1],
                       vertex[3 * (3 * path + i) + 2]);
      if (interaction[3 * path + i] == 5) {
        EXPECT_LT(glm::distance(next, place), 1e-9);
        EXPECT_EQ(once.array<uint32_t>(0, "csi", "facet")[3 * path + i], 0u);
      }
      length += glm::distance(at, next);
      at = next;
    }
    length += glm::distance(at, dvec3(3, 1.2, 1));
    EXPECT_NEAR(delay[path] * speed_of_light, length, 1e-9);
  }
}

TEST_F(ChannelTargets, BothDirectionsOfALinkAgree) {
  for (const char* model : {"tr38901: vehicle", "tr38901: uav_small", "table: ten.csv"}) {
    const auto link = [&](const std::string& ends) {
      return run(open_sky(still, ends + ", targets: [{nodes: drone, " + model + "}]"));
    };
    const KeptRun there = link("tx: bs/row, rx: far/pair"), back = link("tx: far/pair, rx: bs/row");
    const auto a = there.array<std::complex<float>>(0, "csi", "cfr"),
               b = back.array<std::complex<float>>(0, "csi", "cfr");
    double most = 0.0, error = 0.0;
    for (size_t r = 0; r < 4; ++r)
      for (size_t t = 0; t < 8; ++t)
        for (size_t k = 0; k < 4; ++k) {
          const Complex x(a[(r * 8 + t) * 4 + k]), y(b[(t * 4 + r) * 4 + k]);
          most = std::max(most, std::abs(x));
          error = std::max(error, std::abs(x - y));
        }
    EXPECT_GT(there.counter("csi.target_echoes"), 0u);
    EXPECT_LT(error, 1e-5 * most) << model;
  }
}

TEST_F(ChannelTargets, SwitchedOffTheyChangeNoByte) {
  const std::string targets = ", targets: [{nodes: drone, tr38901: uav_small}]";
  const std::string ends = "tx: bs/a, rx: user/a, max_depth: 3";
  const KeptRun off = run(room(ends + targets, "effects: {target_echoes: off}\n"));
  EXPECT_FALSE(off.plan.target_echoes.on);
  const KeptRun on = run(room(ends + targets));
  EXPECT_TRUE(on.plan.target_echoes.on);
  EXPECT_EQ(off.array<int32_t>(0, "csi", "path_count")[0] + 49, on.array<int32_t>(0, "csi", "path_count")[0]);
  const KeptRun none = run(room(ends));
  EXPECT_FALSE(none.plan.target_echoes.on);
  EXPECT_THAT(none.plan.target_echoes.reason, HasSubstr("no channel has targets"));
}

TEST_F(ChannelTargets, RunsRepeatAndSeedsDiffer) {
  const std::string yaml = open_sky(line({40, 30, 12}, {3, -8, 1}),
                                    "tx: bs/row, rx: [far/pair], targets: [{class: uav, tr38901: vehicle}]");
  const KeptRun first = run(yaml), second = run(yaml);
  test::expect_same_bytes(first, second);
  KeptRun late = run(yaml, 2);
  KeptRun end = first;
  end.packets = {first.packets[2]};
  test::expect_same_bytes(end, late);
  std::string other = yaml;
  other.replace(other.find("seed: 5"), 7, "seed: 6");
  EXPECT_NE(run(other).array(0, "csi", "cfr").bytes, first.array(0, "csi", "cfr").bytes);
}

TEST_F(ChannelTargets, ATargetSendsNothingToItsOwnAntenna) {
  const KeptRun kept =
      run(open_sky(still, "tx: bs/a, rx: [drone/a, far/a], targets: [{nodes: drone, tr38901: uav_small}]"));
  const auto count = kept.array<int32_t>(0, "csi", "path_count");
  EXPECT_EQ(count[0], 1);
  EXPECT_EQ(count[1], 2);
}

/// A path that a target's own surface reflects is left to its echo.
TEST_F(ChannelTargets, EchoesReplaceReflectionsAtTheTarget) {
  const std::string ends = "tx: bs/a, rx: user/a, max_depth: 1";
  const KeptRun with = run(
      room(ends + ", targets: [{nodes: drone, tr38901: uav_small}]", "effects: {moving_reflectors: on}\n"));
  const auto object = with.array<uint32_t>(0, "csi", "object");
  const auto interaction = with.array<uint8_t>(0, "csi", "interaction");
  for (size_t i = 0; i < object.size(); ++i) {
    const bool at_drone = object[i] != 0 && with.instances.at(object[i] - 1).name.starts_with("drone");
    EXPECT_EQ(at_drone, interaction[i] == 5);
  }
  EXPECT_EQ(with.counter("csi.target_echoes"), 2u * 49u);
}

// ------------------------------------------------------------------------------------------------- sensing

std::string sensing(const std::string& trajectory, const std::string& more, const std::string& effects = "") {
  return "greatx: 1\nname: test\nseed: 5\nticks: 3\ntick_rate_hz: 10\n"
         "scene: {generate: {kind: canyon, seed: 3, size_m: 120}}\n"
         "nodes:\n"
         "  - name: bs\n    trajectory: {type: static, position_m: [0, -30, 12], rotation_deg: [90, 0, 0]}\n"
         "    sensors: [{name: panel, type: antenna, pattern: tr38901, rows: 2, columns: 4}]\n"
         "  - name: drone\n    trajectory: " +
         trajectory +
         "\n    model: {generate: {kind: quadrotor, variant: large}}\n"
         "channels:\n  - {name: csi, rate_hz: 10, carrier_hz: 28e9, tx: bs/panel, rx: bs/panel, subcarriers: "
         "256,"
         " bandwidth_hz: 100e6, time_samples: 64, time_spacing_s: 100.0e-6, max_depth: 1, outputs: [], "
         "power_dbm: "
         "30, targets: [{nodes: drone, tr38901: uav_large}], sensing: {noise_figure_db: 7" +
         more + "}}\n" + effects;
}

const std::string flight = line({1, 20, 14}, {0, -9, 0});

TEST_F(ChannelTargets, ABaseStationSeesADrone) {
  const KeptRun kept = run(sensing(flight, ""));
  for (size_t packet = 0; packet < kept.packets.size(); ++packet) {
    const auto instance = kept.array<uint32_t>(packet, "csi", "detection_instance");
    const auto range = kept.array<float>(packet, "csi", "detection_range"),
               velocity = kept.array<float>(packet, "csi", "detection_velocity"),
               azimuth = kept.array<float>(packet, "csi", "detection_azimuth"),
               power = kept.array<float>(packet, "csi", "detection_power");
    size_t best = instance.size();
    for (size_t i = 0; i < instance.size(); ++i)
      if (instance[i] != 0 && kept.instances.at(instance[i] - 1).name.starts_with("drone") &&
          (best == instance.size() || power[i] > power[best]))
        best = i;
    ASSERT_LT(best, instance.size()) << "tick " << packet;
    EXPECT_EQ(kept.array<uint8_t>(packet, "csi", "target_detected")[0], 1);
    const double range_bin = speed_of_light / 2.0 / 100e6,
                 velocity_bin = speed_of_light / 28e9 / 2.0 / 6.4e-3;
    EXPECT_NEAR(range[best], kept.array<double>(packet, "csi", "target_range")[0], 0.25 * range_bin);
    EXPECT_NEAR(velocity[best], kept.array<double>(packet, "csi", "target_velocity")[0], 0.25 * velocity_bin);
    EXPECT_NEAR(azimuth[best], kept.array<double>(packet, "csi", "target_azimuth")[0], radians(3.0));
    EXPECT_NEAR(kept.array<double>(packet, "csi", "target_velocity")[0], -9.0, 0.3);
  }
  EXPECT_TRUE(kept.plan.consistency.on);
  EXPECT_TRUE(kept.plan.sensing_noise.on);
  EXPECT_FALSE(kept.plan.sensing_quantisation.on);
}

TEST_F(ChannelTargets, SensingIsAsFarFromTheBoxAsTheTargetIsWide) {
  const KeptRun kept = run(sensing(flight, ""));
  const ErrorStatistics& errors = kept.statistics.consistency.at(sensing_figure);
  EXPECT_EQ(errors.count(), 3u);
  EXPECT_LT(errors.max(), 0.02);
}

/// The drone is the strongest cell of the map: at its range and azimuth, and with the power of its echo less
/// the response of the window over range, which is Hann's.
TEST_F(ChannelTargets, TheAzimuthMapShowsTheDroneWithItsPower) {
  std::string yaml = sensing(flight, ", outputs: [range_azimuth], azimuths: 91, azimuth_limit_deg: 45",
                             "effects: {sensing_noise: off}\n");
  yaml.replace(yaml.find("targets: ["), 10, "legs: {max_depth: 0}, targets: [");
  const KeptRun kept = run(yaml);
  for (size_t packet = 0; packet < kept.packets.size(); ++packet) {
    const auto map = kept.array<float>(packet, "csi", "range_azimuth");
    ASSERT_EQ(map.size(), 256u * 91);
    const auto peak = static_cast<size_t>(std::ranges::max_element(map) - map.begin());
    const double range_bin = speed_of_light / 2.0 / 100e6,
                 at = kept.array<double>(packet, "csi", "target_range")[0] / range_bin;
    const double bin = static_cast<double>(peak / 91),
                 azimuth = radians(static_cast<double>(peak % 91) - 45.0);
    EXPECT_NEAR(bin, at, 0.5);
    EXPECT_NEAR(azimuth, kept.array<double>(packet, "csi", "target_azimuth")[0], radians(1.0));
    const double off = at - bin, response = std::sin(pi * off) / (pi * off * (1.0 - off * off));
    EXPECT_NEAR(10.0 * std::log10(map[peak] * 1e3),
                kept.array<double>(packet, "csi", "target_power")[0] + 20.0 * std::log10(response), 0.1);
  }
}

TEST_F(ChannelTargets, WhatAliasesIsSaidWithItsFigures) {
  const KeptRun fast = run(sensing(line({1, 20, 14}, {0, -40, 0}), ""));
  ASSERT_EQ(fast.statistics.warnings.size(), 1u);
  EXPECT_THAT(fast.statistics.warnings[0], HasSubstr("velocities of 53.53 m/s"));
  EXPECT_THAT(fast.statistics.warnings[0], HasSubstr("alias"));
  EXPECT_TRUE(run(sensing(flight, "")).statistics.warnings.empty());
}

TEST_F(ChannelTargets, AReceiverMayBeBlindedByItsLeakage) {
  const auto detected = [&](const std::string& more) {
    return run(sensing(flight, more)).array<uint8_t>(0, "csi", "target_detected")[0];
  };
  EXPECT_EQ(detected(", leakage: {level_db: -60}, adc: {bits: 14, full_scale_dbm: 0}"), 1);
  // The leakage of -30 dBm needs the full scale, and eight bits below it leave nothing of the echo.
  EXPECT_EQ(detected(", leakage: {level_db: -30}, adc: {bits: 4, full_scale_dbm: 12}"), 0);
}

/// A radar beside the panel, with the same band and the same time between its chirps, finds the drone at the
/// same range and velocity as the channel does by its symbols. The target has its surfaces in both.
TEST_F(ChannelTargets, ARadarAtTheSamePlaceAgrees) {
  std::string yaml = sensing(flight, "");
  const auto replace = [&](const std::string& what, const std::string& with) {
    ASSERT_NE(yaml.find(what), std::string::npos) << what;
    yaml.replace(yaml.find(what), what.size(), with);
  };
  replace(
      "rows: 2, columns: 4}]",
      "rows: 2, columns: 4}, {name: radar, type: radar, rate_hz: 10, power_dbm: 30, waveform: {carrier_hz: "
      "28e9, bandwidth_hz: 100e6, samples: 128, chirps: 64, interval_s: 100.0e-6}, transmit: {pattern: "
      "tr38901}, receive: {pattern: tr38901, columns: 4}, receiver: {noise_figure_db: 7}}]");
  replace("tr38901: uav_large", "tubes: {width_m: 0.02, budget: 20000}");
  const KeptRun kept = run(yaml);
  const auto strongest = [&](const std::string& sensor, const std::string& prefix) {
    const auto instance = kept.array<uint32_t>(1, sensor, prefix + "instance");
    const auto power = kept.array<float>(1, sensor, prefix + "power");
    size_t best = instance.size();
    for (size_t i = 0; i < instance.size(); ++i)
      if (instance[i] != 0 && kept.instances.at(instance[i] - 1).name.starts_with("drone") &&
          (best == instance.size() || power[i] > power[best]))
        best = i;
    EXPECT_LT(best, instance.size()) << sensor;
    return best == instance.size()
               ? std::pair(0.0, 0.0)
               : std::pair(double{kept.array<float>(1, sensor, prefix + "range")[best]},
                           double{kept.array<float>(1, sensor, prefix + "velocity")[best]});
  };
  const auto radar = strongest("bs/radar", ""), channel = strongest("csi", "detection_");
  // A quarter of a range bin, and of a velocity bin.
  EXPECT_NEAR(radar.first, channel.first, 0.375);
  EXPECT_NEAR(radar.second, channel.second, 0.21);
}

TEST_F(ChannelTargets, SensedBytesRepeat) {
  const std::string yaml =
      sensing(flight, ", adc: {bits: 12, full_scale_dbm: -20}, leakage: {level_db: -90}");
  test::expect_same_bytes(run(yaml), run(yaml));
}

// ----------------------------------------------------------------------------------------------- bad input

TEST_F(ChannelTargets, BadInputIsRefusedWithItsPlace) {
  const auto refusal = [&](const std::string& channel) {
    try {
      run(open_sky(still, "tx: bs/a, rx: bs/a, " + channel));
    } catch (const UserError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(
      refusal("targets: [{nodes: far, tr38901: human}]"),
      HasSubstr("channels[0].targets[0].nodes: expected a node with a model, found 'far', which has none"));
  EXPECT_THAT(refusal("targets: [{nodes: dron, tr38901: human}]"), HasSubstr("unknown 'dron'"));
  EXPECT_THAT(refusal("targets: [{class: person, tr38901: human}]"),
              HasSubstr("'person', which no node has"));
  EXPECT_THAT(refusal("targets: [{nodes: drone}]"),
              HasSubstr("expected a table of scattering (or 'tubes', 'tr38901' or 'surface')"));
  EXPECT_THAT(refusal("targets: [{nodes: drone, tr38901: bird}]"), HasSubstr("uav_small, uav_large, human"));
  EXPECT_THAT(refusal("targets: [{nodes: drone, tr38901: human}, {nodes: 'd*', tr38901: human}]"),
              HasSubstr("expected every node once, found a second target 'drone'"));
  EXPECT_THAT(refusal("legs: {max_depth: 1}"), HasSubstr("expected 'targets' beside it"));
  EXPECT_THAT(refusal("sensing: {power_dbm: 30}"), HasSubstr("expected at least 4 time_samples"));
  EXPECT_THAT(refusal("time_samples: 16, sensing: {}"), HasSubstr("power_dbm"));
  EXPECT_THAT(refusal("time_samples: 16, sensing: {power_dbm: 1, cfar: {guard: [0, 0], train: [2, 9]}}"),
              HasSubstr("within the 16 time_samples"));
  EXPECT_THAT(refusal("time_samples: 16, sensing: {power_dbm: 1, outputs: [range_azimuth]}"),
              HasSubstr("range_azimuth: expected elements that measure an azimuth"));
  std::ofstream(folder_.path() / "gap.csv")
      << "theta_deg,phi_deg,rcs_dbsm\n0,0,1\n0,180,1\n90,0,1\n180,0,1\n180,180,1\n";
  EXPECT_THAT(refusal("targets: [{nodes: drone, table: gap.csv}]"),
              HasSubstr("gap.csv:4: theta_deg 90, phi_deg 180: expected a line, found none (a gap)"));
}

}  // namespace
}  // namespace greatx::sim
