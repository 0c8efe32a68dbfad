// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests that the rows of `greatx bench --radio` exist and add up. The test does not judge how long they take.
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps::test {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* street = R"(greatx: 1
name: street
seed: 9
ticks: 3
tick_rate_hz: 10
scene:
  generate: {kind: canyon, seed: 9, size_m: 100}
environment: {clouds: 0}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [6.3, -21.7, 9.4]}
    sensors:
      - {name: panel, type: antenna, polarization: slant, columns: 2, column_spacing_wl: 0.5}
  - name: car
    trajectory:
      type: waypoints
      points:
        - {t_s: 0, position_m: [2.4, -30, 0]}
        - {t_s: 10, position_m: [2.4, 20, 0]}
    sensors:
      - {name: front, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90, )"
                               R"(mount: {position_m: [1.2, 0, 1.4]}}
      - {name: antenna, type: antenna, mount: {position_m: [0, 0, 1.6]}}
channels:
  - {name: csi, tx: bs/panel, rx: [car/antenna], rate_hz: 10, carrier_hz: 3.5e9, )"
                               R"(bandwidth_hz: 20e6, subcarriers: 16,
     max_depth: 1, scattering_patch_m: 40}
)";

class RadioBench : public ::testing::Test {
 protected:
  void SetUp() override { std::ofstream(folder_ / "street.yaml") << street; }
  Outcome bench(const std::string& more, const std::string& cache) const {
    return greatx(fmt::format("bench --radio {}/street.yaml --many 7 --warm-up 1 {}", folder_.string(), more),
                  "GREATX_CACHE=" + cache);
  }
  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(RadioBench, HasEveryRow) {
  const Outcome outcome = bench("--json --map-cells 10", (folder_ / "cache").string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["scenario"], "street");
  EXPECT_FALSE(json["device"].get<std::string>().empty());
  EXPECT_FALSE(json["driver"].get<std::string>().empty());
  EXPECT_GT(json["facets"], 0);

  EXPECT_EQ(json["first_cir"]["from_cache"], true) << "measured again when the search was not cached";
  EXPECT_GT(json["search"]["candidates"], 1);
  EXPECT_EQ(json["search"]["overflow"], 0);
  EXPECT_EQ(json["many"]["receivers"], 7);
  EXPECT_GT(json["many"]["paths"], 0);
  EXPECT_GT(json["many"]["peak_rss_target_bytes"], 0);
  EXPECT_EQ(json["response"]["paths"], 20);
  EXPECT_GT(json["response"]["ports"], 0);
  EXPECT_EQ(json["gradient"]["paths"], 20);
  EXPECT_GT(json["gradient"]["parameters"], 0);
  EXPECT_LT(json["gradient"]["error"], 1e-7);
  EXPECT_EQ(json["written_tick"]["tick_ms"]["count"], 2);
  EXPECT_EQ(json["map"]["cells"], 100);
  EXPECT_GT(json["map"]["paths"], 0);
  EXPECT_EQ(json["many_responses"]["receivers"], 7);
  for (const char* row : {"first_cir", "search", "many", "response", "gradient", "many_responses", "map"})
    for (const char* key : {"ms", "target", "ratio", "cpu_s", "peak_rss_bytes"})
      EXPECT_TRUE(json[row].contains(key)) << row << ' ' << key;

  ASSERT_EQ(json["ticks"].size(), 4u);
  for (const char* name :
       {"reflection_transmission", "diffraction", "scattering", "diffraction_scattering"}) {
    const nlohmann::json& row = json["ticks"][name];
    for (const char* key : {"tick_ms", "geometry_ms", "crossings_ms", "fields_ms", "response_ms"})
      EXPECT_EQ(row[key]["count"], 2) << name << ' ' << key << ": 3 ticks, one to warm up";
    for (const char* key : {"target", "ratio", "cpu_s", "peak_rss_bytes", "path_overflow"})
      EXPECT_TRUE(row.contains(key)) << name << ' ' << key;
    EXPECT_GT(row["paths"], 0.0) << name;
    EXPECT_GE(row["geometric_paths"].get<double>(), 0.99 * row["paths"].get<double>()) << name;
  }
  const auto paths = [&](const char* name) { return json["ticks"][name]["paths"].get<double>(); };
  EXPECT_GT(paths("diffraction"), paths("reflection_transmission"));
  EXPECT_GT(paths("scattering"), paths("reflection_transmission"));
  EXPECT_NEAR(paths("diffraction_scattering") - paths("reflection_transmission"),
              paths("diffraction") + paths("scattering") - 2.0 * paths("reflection_transmission"), 1e-6)
      << "diffraction and scattering take nothing from each other";
}

TEST_F(RadioBench, HoldsBudgetsOfScatteringsAgainstAllPatches) {
  const std::string text = greatx::apps::test::read_file(folder_ / "street.yaml");
  const size_t at = text.find("scattering_patch_m: 40");
  std::ofstream(folder_ / "fine.yaml") << text.substr(0, at) << "scattering_patch_m: 10"
                                       << text.substr(at + std::string("scattering_patch_m: 40").size());
  const Outcome outcome = greatx(fmt::format("bench --recall --scattering {}/fine.yaml --count 4 --depth 2 "
                                             "--budgets 100,1000000 --json",
                                             folder_.string()),
                                 "GREATX_CACHE=off");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto rows = nlohmann::json::parse(outcome.out)[0]["budgets"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["budget"], 0);
  EXPECT_GT(rows[0]["chains"].get<double>(), 2.0 * rows[1]["chains"].get<double>());
  EXPECT_GT(rows[1]["power_db"]["most"].get<double>(), 0.0);
  for (const char* error : {"power_db", "bins_db", "direction_deg", "spread_deg"})
    EXPECT_EQ(rows[2][error]["most"], 0.0) << error << ": a budget for all patches draws none";
}

TEST_F(RadioBench, PrintsATable) {
  const Outcome outcome = bench("--row-seconds 0.01", "off");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part : {"street, radio alone", "first CIR, search not cached", "candidates", "7 receivers",
                           "tick, reflection_transmission", "tick, diffraction_scattering", "crossings",
                           "response", "target", "ratio"})
    EXPECT_THAT(outcome.out, HasSubstr(part));
}

TEST_F(RadioBench, SaysWhatEveryRowFindsOnce) {
  // The antenna lies on the road. Without care, every row that solves the channel's link would warn of it.
  std::string text = street;
  const std::string mount = "mount: {position_m: [0, 0, 1.6]}";
  text.replace(text.find(mount), mount.size(), "mount: {position_m: [0, 0, 0]}");
  std::ofstream(folder_ / "street.yaml") << text;
  const Outcome outcome = bench("--row-seconds 0.01", "off");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream lines(outcome.err);
  std::multiset<std::string> said;
  for (std::string line; std::getline(lines, line);) said.insert(line);
  EXPECT_THAT(outcome.err, HasSubstr("car/antenna lies on a surface"));
  for (const std::string& line : said) EXPECT_EQ(said.count(line), 1u) << line;
}

TEST_F(RadioBench, BadScenariosAreToldAsEverywhere) {
  const Outcome absent = greatx("bench --radio " + (folder_ / "absent.yaml").string());
  EXPECT_EQ(absent.code, 1);
  EXPECT_THAT(absent.err, HasSubstr("absent.yaml"));
  std::string text = street;
  text.resize(text.find("channels:"));
  std::ofstream(folder_ / "silent.yaml") << text;
  const Outcome silent = greatx("bench --radio " + (folder_ / "silent.yaml").string());
  EXPECT_EQ(silent.code, 1);
  EXPECT_THAT(silent.err, HasSubstr("channels: expected one at least"));
}

}  // namespace
}  // namespace greatx::apps::test
