// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "sim/plan/antennas.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/temporary_folder.h"

namespace greatx::sim {
namespace {

constexpr const char* scenario_text = R"(greatx: 1
name: antennas
ticks: 1
nodes:
  - name: a
    trajectory: {type: static, position_m: [0, 0, 0]}
    sensors:
      - {name: panel, type: antenna, pattern: tr38901, polarization: slant,
         rows: 4, columns: 8, row_spacing_wl: 2, column_spacing_wl: 0.5}
      - {name: free, type: antenna, pattern_file: p.csv, slant_deg: 30, polarization_model: 1,
         elements_wl: [[0, 0, 0], [0.5, 0, 0.25]]}
)";

class ChannelAntennas : public testing::Test {
 protected:
  ChannelAntennas() {
    std::ofstream csv(folder_.path() / "p.csv");
    csv << "theta_deg,phi_deg,f_theta_re,f_theta_im,f_phi_re,f_phi_im\n";
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j)
        csv << fmt::format("{},{},{},0,0,{}\n", 90 * i, 90 * j, i == 1 ? 1.25 : 0.5, i == 1 ? 0.1 * j : 0.0);
    csv.close();
    scenario_ = parse_scenario(scenario_text, "s.yaml", folder_.path());
  }
  test::TemporaryFolder folder_;
  Scenario scenario_;
};

TEST_F(ChannelAntennas, GreatMcdPanelAtTwoCarriers) {
  for (const double carrier_hz : {3.5e9, 28e9}) {
    const rf::AntennaArray panel = antenna_array(scenario_, "a/panel", carrier_hz);
    const double wavelength = speed_of_light / carrier_hz;
    EXPECT_EQ(panel.port_count(), 64u);
    EXPECT_NEAR(panel.aperture() / wavelength, std::hypot(6.0, 3.5), 1e-14);
    EXPECT_NEAR(glm::distance(panel.element_position(63), dvec3(0, 1.75, 3.0) * wavelength), 0.0, 1e-15);
  }
}

TEST_F(ChannelAntennas, MetadataSaysHowToRecomputeThePanel) {
  const nlohmann::json json = describe_array(antenna_array(scenario_, "a/panel", 3e9));
  EXPECT_EQ(json["pattern"], "tr38901");
  EXPECT_EQ(json["polarization"], "slant");
  EXPECT_EQ(json["polarization_model"], 2);
  EXPECT_EQ(json["slants_deg"], nlohmann::json({45.0, -45.0}));
  EXPECT_EQ(json["plane"], "yz");
  EXPECT_EQ(json["rows"], 4);
  EXPECT_EQ(json["columns"], 8);
  EXPECT_EQ(json["ports"], 64);
  EXPECT_FALSE(json.contains("pattern_table"));
  EXPECT_FALSE(json.contains("elements_m"));
}

TEST_F(ChannelAntennas, MetadataHoldsAnImportedTableOnce) {
  const std::vector<rf::AntennaArray> arrays(3, antenna_array(scenario_, "a/free", 3e9));
  const nlohmann::json json = describe_array(arrays[0]);
  const std::string hash = json["pattern_table"];
  EXPECT_EQ(hash.size(), 64u);
  EXPECT_EQ(json["pattern_file"], "p.csv");
  EXPECT_EQ(json["elements_m"].size(), 2u);
  EXPECT_FALSE(json.contains("rows"));
  EXPECT_NEAR(json["slants_deg"][0].get<double>(), 30.0, 1e-13);
  const nlohmann::json tables = describe_pattern_tables({arrays, arrays});
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(tables[hash]["zeniths"], 3);
  EXPECT_EQ(tables[hash]["azimuths"], 4);
  EXPECT_EQ(tables[hash]["f_theta_re"], "0.5 0.5 0.5 0.5 1.25 1.25 1.25 1.25 0.5 0.5 0.5 0.5");
  EXPECT_FALSE(tables[hash].contains("f_theta_im"));  // zero throughout
  EXPECT_TRUE(tables[hash].contains("f_phi_im"));
  EXPECT_TRUE(describe_pattern_tables({}).empty());
}

}  // namespace
}  // namespace greatx::sim
