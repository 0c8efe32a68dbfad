// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests --seed, --ticks and --sequences. The scenario of the data set states them, and a shorter run is the
// beginning of the longer one.
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using greatx::apps::test::greatx;
using greatx::apps::test::Outcome;
using greatx::apps::test::read_file;
using testing::HasSubstr;

constexpr const char* override_scenario = R"(# A drone and a bus, both drawn.
greatx: 1
name: drawn
# How long.
duration_s: 0.6   # six ticks
tick_rate_hz: 10
scene: {generate: {kind: canyon, seed: 3, size_m: 60}}
environment: {clouds: 0}
nodes:
  - name: uav
    trajectory: {type: bezier, box: {min_m: [-20, -5, 2], max_m: [20, 5, 20]}, offset_m: [3, 3, 3]}
    sensors:
      - {name: camera, type: camera, rate_hz: 10, width: 32, height: 24, fov_deg: 90}
      - {name: antenna, type: antenna}
  - name: bus
    trajectory: {type: corridor, center_line_m: [[-20, 0, 1], [20, 0, 1]], width_m: 2}
    sensors: [{name: antenna, type: antenna}]
channels:
  - {name: csi, tx: bus/antenna, rx: [uav/antenna], rate_hz: 10, subcarriers: 16, max_depth: 1}
)";

class Override : public testing::Test {
 protected:
  void SetUp() override { std::ofstream(folder_ / "drawn.yaml") << override_scenario; }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void generate(const std::string& from, const std::string& to, const std::string& more = "") const {
    const Outcome made = greatx(fmt::format("generate {} -o {} -q {}", path(from), path(to), more));
    ASSERT_EQ(made.code, 0) << made.err;
  }
  std::string file(const std::string& name) const { return read_file(folder_ / name); }
  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(Override, TheScenarioOfTheDataSetMakesItAgain) {
  generate("drawn.yaml", "a", "--seed 9 --ticks 4 --sequences 2");
  const std::string text = file("a/scenario.yaml");
  for (const char* line : {"seed: 9\n", "ticks: 4   # six ticks\n", "sequences: 2\n", "trajectory_ticks: 6\n",
                           "# A drone and a bus, both drawn.\n", "# How long.\n"})
    EXPECT_THAT(text, HasSubstr(line));
  generate("a/scenario.yaml", "b");
  EXPECT_FALSE(file("a/manifest.json").empty());
  EXPECT_EQ(file("a/manifest.json"), file("b/manifest.json"));
  EXPECT_EQ(file("b/scenario.yaml"), text);
  // Options that repeat the scenario's values change nothing.
  generate("drawn.yaml", "plain");
  generate("drawn.yaml", "said", "--seed 1 --ticks 6 --sequences 1");
  EXPECT_EQ(file("plain/scenario.yaml"), override_scenario);
  EXPECT_EQ(file("plain/manifest.json"), file("said/manifest.json"));
}

TEST_F(Override, AShorterRunIsTheBeginningOfTheLonger) {
  generate("drawn.yaml", "short", "--ticks 3");
  generate("drawn.yaml", "whole");
  generate("drawn.yaml", "long", "--ticks 9");
  const auto rows = [&](const std::string& data, const std::string& array, size_t ticks) {
    const std::string npy = file(data + "/sequence_0000/" + array + ".npy");
    const size_t head =
        10 + static_cast<unsigned char>(npy.at(8)) + 256 * static_cast<unsigned char>(npy.at(9));
    return [=](size_t of) { return npy.substr(head, (npy.size() - head) / of * ticks); };
  };
  for (const char* array : {"poses/position", "poses/orientation", "poses/velocity", "csi/cfr"}) {
    EXPECT_EQ(rows("short", array, 3)(3), rows("whole", array, 3)(6)) << array;
    EXPECT_EQ(rows("whole", array, 6)(6), rows("long", array, 6)(9)) << array;
  }
  for (int tick = 0; tick < 6; ++tick) {
    const std::string picture = fmt::format("/sequence_0000/uav/camera/rgb/{:06}.png", tick);
    EXPECT_EQ(file("whole" + picture), file("long" + picture)) << tick;
    if (tick < 3) {
      EXPECT_EQ(file("whole" + picture), file("short" + picture)) << tick;
      EXPECT_FALSE(file("short" + picture).empty());
    }
  }
}

}  // namespace
