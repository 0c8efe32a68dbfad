// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs channels with panels of phase-shifting elements: gain, both directions, following, legs, errors.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "rf/targets/surface_target.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;
using ::testing::HasSubstr;
using Complex = std::complex<double>;

constexpr double ris_carrier_hz = 28e9, ris_lambda_m = speed_of_light / ris_carrier_hz;

/// Returns a panel in the open, 8 m above the origin and looking along +x; its model is a drone's, since only
/// the centre of its box counts.
std::string around_a_panel(const std::string& surface, const std::string& ends = "tx: bs/a, rx: ue/a",
                           const std::string& ue = "{type: static, position_m: [9, -14, 8]}",
                           const std::string& more = "") {
  return "greatx: 1\nname: test\nseed: 5\nticks: 3\ntick_rate_hz: 10\n"
         "nodes:\n"
         "  - name: bs\n    trajectory: {type: static, position_m: [20, 11, 8]}\n"
         "    sensors: [{name: a, type: antenna}, {name: row, type: antenna, columns: 3, polarization: vh}]\n"
         "  - name: ue\n    trajectory: " +
         ue +
         "\n    sensors: [{name: a, type: antenna}, {name: pair, type: antenna, columns: 2, polarization: "
         "slant}]\n"
         "  - name: ris\n    trajectory: {type: static, position_m: [0, 0, 8]}\n"
         "    model: {generate: {kind: quadrotor, variant: small}}\n"
         "channels:\n  - {name: csi, " +
         ends +
         ", rate_hz: 10, carrier_hz: 28e9, subcarriers: 1, bandwidth_hz: 1e6, max_depth: 0, targets: "
         "[{nodes: "
         "ris, surface: " +
         surface + "}], legs: {max_depth: 0}}\neffects: {gas: off}\n" + more;
}

std::vector<Complex> echoes(const KeptRun& run, size_t packet = 0) {
  const auto amplitude = run.array<std::complex<float>>(packet, "csi", "amplitude");
  const auto interaction = run.array<uint8_t>(packet, "csi", "interaction");
  const size_t paths = run.array<double>(packet, "csi", "delay").size(), pairs = amplitude.size() / paths,
               depth = interaction.size() / paths;
  std::vector<Complex> found;
  for (size_t p = 0; p < paths; ++p)
    if (interaction[p * depth] == 5)
      for (size_t pair = 0; pair < pairs; ++pair) found.emplace_back(amplitude[p * pairs + pair]);
  return found;
}
dvec3 panel_place(const KeptRun& run, size_t packet = 0) {
  const auto vertex = run.array<double>(packet, "csi", "vertex");
  for (size_t i = 0; i + 2 < vertex.size(); i += 3)
    if (!std::isnan(vertex[i])) return {vertex[i], vertex[i + 1], vertex[i + 2]};
  ADD_FAILURE() << "no echo";
  return {};
}
/// Returns |a| of a panel of n x n elements that is focused on both ends, with the elements one by one.
double focused(const dvec3& place, const dvec3& bs, const dvec3& ue, uint32_t n) {
  double sum = 0.0;
  for (uint32_t row = 0; row < n; ++row)
    for (uint32_t column = 0; column < n; ++column) {
      const dvec3 element =
          place + 0.5 * ris_lambda_m * dvec3(0.0, column - 0.5 * (n - 1.0), row - 0.5 * (n - 1.0));
      const double in = glm::distance(bs, element), out = glm::distance(ue, element);
      sum += std::sqrt((bs.x - place.x) / in * (ue.x - place.x) / out) / (in * out);
    }
  return ris_lambda_m / (4.0 * pi) * 0.25 * ris_lambda_m * sum;
}

const dvec3 bs_place(20, 11, 8), ue_place(9, -14, 8);

TEST(ChannelSurfaces, AFocusHasTheGainOfAllElements) {
  for (const uint32_t n : {8u, 40u}) {
    const KeptRun run = keep_run(
        around_a_panel(fmt::format("{{rows: {0}, columns: {0}, steer: {{from: bs/a, to: ue/a}}}}", n)));
    const std::vector<Complex> a = echoes(run);
    ASSERT_EQ(a.size(), 1u);
    EXPECT_NEAR(std::abs(a[0]) / focused(panel_place(run), bs_place, ue_place, n), 1.0, 2e-4) << n;
  }
  // Twice as many elements along each side: four times the amplitude.
  const auto gain = [](const char* surface) {
    return std::abs(echoes(keep_run(around_a_panel(surface)))[0]);
  };
  const double small = gain("{rows: 8, columns: 8, steer: {from: bs/a, to: ue/a}}");
  EXPECT_NEAR(gain("{rows: 16, columns: 16, steer: {from: bs/a, to: ue/a}}") / small, 4.0, 0.002);
  EXPECT_NEAR(gain("{rows: 8, columns: 8, amplitude: 0.25, steer: {from: bs/a, to: ue/a}}") / small, 0.25,
              1e-6);
  EXPECT_LT(gain("{rows: 8, columns: 8, bits: 1, steer: {from: bs/a, to: ue/a}}"), 0.8 * small);
}

TEST(ChannelSurfaces, DirectionsAreThoseOfThePanelsFrame) {
  const KeptRun followed = keep_run(around_a_panel("{rows: 4, columns: 4, steer: {from: bs/a, to: ue/a}}"));
  const dvec3 place = panel_place(followed);
  const auto degrees_of = [&](const dvec3& end) {
    const dvec3 d = end - place;
    return fmt::format("[{:.12g}, {:.12g}]", degrees(std::atan2(d.y, d.x)),
                       degrees(std::atan2(d.z, std::hypot(d.x, d.y))));
  };
  const KeptRun given = keep_run(around_a_panel(fmt::format(
      "{{rows: 4, columns: 4, steer: {{from: {}, to: {}}}}}", degrees_of(bs_place), degrees_of(ue_place))));
  // The waves bend by k r^2/2 (1/23 m + 1/17 m) = 0.004 rad at the corners, r = 1.1 cm.
  EXPECT_LT(std::abs(echoes(given)[0] - echoes(followed)[0]), 4e-3 * std::abs(echoes(given)[0]));
  const KeptRun elsewhere =
      keep_run(around_a_panel("{rows: 4, columns: 4, steer: {from: [0, 0], to: [0, 0]}}"));
  EXPECT_LT(std::abs(echoes(elsewhere)[0]), 0.5 * std::abs(echoes(given)[0]));
  // The same phases by hand, from the lowest row on.
  const rf::SurfaceLayout layout{4, 4, 0.5 * ris_lambda_m, 0.5 * ris_lambda_m, ris_lambda_m};
  const auto aim = [&](const dvec3& end) {
    return rf::SurfaceAim{glm::normalize(end - place), glm::distance(end, place)};
  };
  std::string phases;
  for (const double phase : rf::steered_phases(layout, aim(bs_place), aim(ue_place)))
    phases += fmt::format("{}{:.12g}", phases.empty() ? "" : ", ", degrees(phase));
  const KeptRun listed = keep_run(around_a_panel("{rows: 4, columns: 4, phases_deg: [" + phases + "]}"));
  EXPECT_LT(std::abs(echoes(listed)[0] - echoes(followed)[0]), 1e-6 * std::abs(echoes(listed)[0]));
}

TEST(ChannelSurfaces, PhasesFollowAMovingEnd) {
  const std::string walk =
      "{type: waypoints, interpolation: linear, points: [{t_s: 0, position_m: [9, -14, 8], rotation_deg: [0, "
      "0, "
      "0]}, {t_s: 1, position_m: [13, 20, 6], rotation_deg: [0, 0, 0]}]}";
  const KeptRun run = keep_run(
      around_a_panel("{rows: 32, columns: 32, steer: {from: bs/a, to: ue/a}}", "tx: bs/a, rx: ue/a", walk));
  const KeptRun fixed = keep_run(around_a_panel(
      "{rows: 32, columns: 32, steer: {from: [28.8, 0], to: [-57.3, 0]}}", "tx: bs/a, rx: ue/a", walk));
  for (size_t packet = 0; packet < 3; ++packet) {
    const dvec3 at = ue_place + 0.1 * static_cast<double>(packet) * dvec3(4, 34, -2);
    const double expected = focused(panel_place(run, packet), bs_place, at, 32);
    // A vertical antenna out of the panel's horizontal plane loses a little to the other polarization.
    EXPECT_NEAR(std::abs(echoes(run, packet)[0]) / expected, 1.0, 0.02) << packet;
    if (packet > 0) {
      EXPECT_LT(std::abs(echoes(fixed, packet)[0]), 0.3 * expected);
    }
  }
}

TEST(ChannelSurfaces, BothDirectionsOfALinkAgree) {
  const std::string steered = "{rows: 12, columns: 7, bits: 2, steer: {from: bs/row, to: ue/pair}}";
  const KeptRun down = keep_run(around_a_panel(steered, "tx: bs/row, rx: ue/pair")),
                up = keep_run(around_a_panel(steered, "tx: ue/pair, rx: bs/row"));
  const std::vector<Complex> there = echoes(down), back = echoes(up);  // [rx_ant, tx_ant]
  ASSERT_EQ(there.size(), 24u);
  ASSERT_EQ(back.size(), 24u);
  double largest = 0.0;
  for (const Complex& value : there) largest = std::max(largest, std::abs(value));
  for (size_t u = 0; u < 4; ++u)
    for (size_t s = 0; s < 6; ++s)
      EXPECT_LT(std::abs(there[u * 6 + s] - back[s * 4 + u]), 1e-5 * largest) << u << ' ' << s;
}

TEST(ChannelSurfaces, LegsReflectLikeThoseOfTargets) {
  // A room: each leg has the line of sight and six reflections; those from behind the panel bring nothing.
  const auto room = [](const char* legs) {
    return keep_run(
        std::string(
            "greatx: 1\nname: test\nseed: 5\nticks: 1\ntick_rate_hz: 10\nscene: {generate: {kind: room}}\n"
            "nodes:\n  - name: bs\n    trajectory: {type: static, position_m: [1, 1, 1.5]}\n"
            "    sensors: [{name: a, type: antenna}]\n"
            "  - name: ue\n    trajectory: {type: static, position_m: [3, 1.2, 1]}\n"
            "    sensors: [{name: a, type: antenna}]\n"
            "  - name: ris\n    trajectory: {type: static, position_m: [2.2, 2.3, 1.2], rotation_deg: "
            "[-90, 0, 0]}\n    model: {generate: {kind: quadrotor, variant: small}}\n"
            "channels:\n  - {name: csi, tx: bs/a, rx: ue/a, rate_hz: 10, carrier_hz: 28e9, subcarriers: "
            "1, bandwidth_hz: 1e6, max_depth: 0, max_transmissions: 0, targets: [{nodes: ris, surface: "
            "{rows: 8, columns: 8, steer: {from: bs/a, to: ue/a}}}], legs: {max_depth: ") +
        legs + ", max_transmissions: 0}}\n");
  };
  const KeptRun direct = room("0"), reflected = room("1");
  EXPECT_EQ(direct.counter("csi.target_echoes"), 1u);
  EXPECT_EQ(reflected.counter("csi.target_echoes"), 49u);
  const double focus = std::abs(echoes(direct)[0]);
  size_t dark = 0, others = 0;
  for (const std::complex<float>& a : reflected.array<std::complex<float>>(0, "csi", "amplitude")) {
    dark += std::abs(a) == 0.0f;
    others += std::abs(a) > 0.0f && std::abs(a) < 0.99 * focus;
  }
  EXPECT_GE(dark, 13u);  // the wall behind the panel, on either leg
  EXPECT_GT(others, 20u);
}

TEST(ChannelSurfaces, TheDataSetSaysWhatThePanelIs) {
  const KeptRun run =
      keep_run(around_a_panel("{rows: 3, columns: 2, row_spacing_wl: 0.4, amplitude: 0.9, bits: 3, "
                              "steer: {from: bs/a, to: [90, 0]}}"));
  const nlohmann::json target = nlohmann::json::parse(run.spec("csi").metadata_json)["targets"][0];
  EXPECT_EQ(target["node"], "ris");
  const nlohmann::json& surface = target["surface"];
  EXPECT_EQ(surface["rows"], 3);
  EXPECT_EQ(surface["columns"], 2);
  EXPECT_NEAR(surface["row_spacing_m"].get<double>(), 0.4 * ris_lambda_m, 1e-15);
  EXPECT_EQ(surface["amplitude"], 0.9);
  EXPECT_EQ(surface["bits"], 3);
  EXPECT_EQ(surface["steer"]["from"], "bs/a");
  EXPECT_NEAR(surface["steer"]["to"][1].get<double>(), 1.0, 1e-15);
  const KeptRun plain = keep_run(around_a_panel("{rows: 1, columns: 2, phases_deg: [10, -20]}"));
  const nlohmann::json listed =
      nlohmann::json::parse(plain.spec("csi").metadata_json)["targets"][0]["surface"];
  EXPECT_NEAR(listed["phases_deg"][1].get<double>(), -20.0, 1e-12);
}

TEST(ChannelSurfaces, FaultsNameTheField) {
  const auto refusal = [](const std::string& surface) -> std::string {
    try {
      parse_scenario(around_a_panel(surface), "s.yaml", ".");
    } catch (const UserError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string place = "channels[0].targets[0].surface.";
  EXPECT_EQ(refusal("{}"), "accepted");
  EXPECT_THAT(refusal("{rows: 0}"), HasSubstr(place + "rows: expected an integer from 1 to 256"));
  EXPECT_THAT(refusal("{row_spacing_wl: 0.6}"),
              HasSubstr(place + "row_spacing_wl: expected a number from 0.05 to "
                                "0.5, found '0.6'"));
  EXPECT_THAT(refusal("{amplitude: 1.5}"), HasSubstr(place + "amplitude: expected a number from 0 to 1"));
  EXPECT_THAT(refusal("{bits: 9}"), HasSubstr(place + "bits"));
  EXPECT_THAT(refusal("{rows: 2, columns: 2, phases_deg: [0, 1, 2]}"),
              HasSubstr(place + "phases_deg: expected 4 phases, one for each of 2 x 2 elements, found 3"));
  EXPECT_THAT(refusal("{phase_deg: 1, steer: {from: [0, 0], to: [0, 0]}}"),
              HasSubstr("expected one of 'phase_deg' and 'steer', found both"));
  EXPECT_THAT(
      refusal("{steer: {from: bs/a}}"),
      HasSubstr(place + "steer.to: expected an antenna as node/sensor, or [azimuth_deg, elevation_deg], "
                        "found nothing"));
  EXPECT_THAT(
      refusal("{steer: {from: bs/b, to: ue/a}}"),
      HasSubstr(place + "steer.from: expected an antenna as node/sensor, or [azimuth_deg, elevation_deg], "
                        "found 'bs/b'"));
  EXPECT_THAT(refusal("{steer: {from: [100, 0], to: ue/a}}"),
              HasSubstr(place + "steer.from[0]: expected a number from -90 to 90, found '100'"));
  EXPECT_THAT(refusal("{}, tr38901: human"),
              HasSubstr("expected one of 'tr38901' and 'surface', found both"));
}

}  // namespace
}  // namespace greatx::sim
