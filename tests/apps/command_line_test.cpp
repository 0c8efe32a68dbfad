// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests which command lines are refused and how, and how a run ends that a user or a limit stops.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

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
using testing::StartsWith;

void expect_refused(const std::string& arguments, const std::string& what) {
  const Outcome outcome = greatx(arguments);
  EXPECT_EQ(outcome.code, 1) << arguments;
  EXPECT_THAT(outcome.err, StartsWith("greatx: error: " + what + "\n")) << arguments;
  EXPECT_EQ(outcome.out, "") << arguments;
}

TEST(CommandLine, UnknownCommandsAreNamed) {
  expect_refused("generat", "no command 'generat', did you mean 'generate'?");
  expect_refused("generat city -o /nonexistent/x", "no command 'generat', did you mean 'generate'?");
  expect_refused("scene citi", "no command 'scene citi', did you mean 'city'?");
  EXPECT_THAT(greatx("simulate").err,
              StartsWith("greatx: error: no command 'simulate'; there are generate, campaign,"));
  EXPECT_THAT(greatx("").err, StartsWith("greatx: error: expected a command (generate, campaign,"));
  EXPECT_THAT(greatx("scene").err, StartsWith("greatx: error: expected a command (city, "));
  EXPECT_EQ(greatx("scene --help").code, 0);
}

TEST(CommandLine, UnknownNamesComeWithTheNearest) {
  expect_refused("generate --tikcs 3", "greatx generate has no option '--tikcs' (did you mean '--ticks'?)");
  expect_refused("campaign run --cel x",
                 "greatx campaign run has no option '--cel' (did you mean '--cell'?)");
  expect_refused("--verison", "greatx has no option '--verison' (did you mean '--version'?)");
  expect_refused("generate city canyon", "greatx generate takes no 'canyon' beside 'city'");
  expect_refused("info here", "greatx info takes no argument, found 'here'");
  expect_refused("explain --tracer tre",
                 "--tracer: expected one of auto, driver, tree, found 'tre' (did you mean 'tree'?)");
  expect_refused("paths --color 1", "--color: expected one of gain, kind, found '1'");
  expect_refused("explain city --set nodes[uva].model=x",
                 "--set: nodes[uva].model: expected a number or one of the names bs, uav, drone, found "
                 "'uva' (did you mean 'uav'?)");
  EXPECT_THAT(greatx("explain citty").err, HasSubstr("(did you mean 'city'?)\n"));
  EXPECT_THAT(greatx("campaign plan great_mcd_mni").err, HasSubstr("(did you mean 'great_mcd_mini'?)\n"));
  EXPECT_THAT(greatx("paths city --channel cis").err, HasSubstr("(did you mean 'csi'?)\n"));
  EXPECT_THAT(greatx("paths city --transmitter bs/pannel").err, HasSubstr("(did you mean 'bs/panel'?)\n"));
  EXPECT_THAT(greatx("explain city --set channels[csi].tx=bs/pannel").err,
              HasSubstr("(did you mean 'bs/panel'?)\n"));
  EXPECT_THAT(greatx("explain room --set effects.difraction=off").err,
              HasSubstr("'difraction' is no effect (did you mean 'diffraction'?)"));
}

TEST(CommandLine, ValuesThatAreMissingAreNamed) {
  expect_refused("generate city -o", "--output: expected a value, found none");
  expect_refused("generate --seed 1 --seed 2", "--seed: expected 1 value, found 2");
  expect_refused("map -o x --min 1", "--min: expected 2 values, found 1");
  expect_refused("paths --json --brief", "--json: expected no --brief beside it");
  expect_refused("inspect x --frames 3", "--frames: expected --animation with it, found none");
  expect_refused("selftest --only abc", "--only: expected a number, found 'abc'");
  expect_refused("verify", "greatx verify: expected DIR (folder of the data set), found none");
  EXPECT_THAT(greatx("verify").err, testing::EndsWith("\n`greatx verify --help` tells what there is.\n"));
}

/// A data set may take gigabytes, so that no command chooses a folder for it.
TEST(CommandLine, TheFolderOfADataSetIsGiven) {
  expect_refused("generate room --ticks 7",
                 "-o: expected the folder of the data set, found none; for example: greatx generate room -o "
                 "out/room\nThe scenario has 7 ticks in 1 sequence; `greatx check room` measures how many "
                 "gigabytes and hours they take.");
  for (const char* command : {"run", "slurm", "status", "merge", "stats", "verify"})
    EXPECT_THAT(greatx(fmt::format("campaign {} great_mcd_mini", command)).err,
                StartsWith(fmt::format("greatx: error: greatx campaign {}: expected --output (", command)));
}

TEST(CommandLine, HelpGroupsTheCommands) {
  const std::string help = greatx("--help").out;
  for (const char* modality :
       {"channel state information", "RGB", "depth", "LiDAR", "radar", "events", "poses"})
    EXPECT_THAT(help, HasSubstr(modality));
  size_t last = 0;
  for (const char* line : {"\nMake:\n  generate ", "\nLook:\n  inspect ", "\nCheck and measure:\n  check ",
                           "\nRadio:\n  paths ", "\nMachine:\n  info "}) {
    EXPECT_GT(help.find(line), last) << line << help;
    last = help.find(line);
  }
}

/// What is given in place of a data set or a scenario is said, and how to use it.
TEST(CommandLine, AFileOfAnotherKindIsRecognised) {
  const greatx::test::TemporaryFolder temporary;
  const fs::path folder = temporary.path();
  std::ofstream(folder / "house.blend") << "BLENDER-v304RENDH";
  std::ofstream(folder / "run.yaml") << "greatx: 1\n";
  std::ofstream(folder / "empty.yaml");
  const auto says = [&](const std::string& arguments, const std::string& words) {
    const Outcome outcome = greatx(fmt::format(fmt::runtime(arguments), folder.string()));
    EXPECT_EQ(outcome.code, 1) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(words)) << arguments;
  };
  says("scene info {}/house.blend", "expected glTF 2.0 (.glb, .gltf), found a Blender file; Blender exports");
  says("scene check {}/house.blend", "found a Blender file; Blender exports");
  says("scene import {}/house.blend -o x.glb", "expected a Mitsuba scene (.xml), found a Blender file");
  says("generate {}/house.blend -o x", "expected a scenario (.yaml), found a Blender file");
  says("scene info {}/run.yaml", "found a scenario of greatx; `greatx generate run.yaml -o DIR` runs it");
  says("generate {}/empty.yaml -o x", "expected a scenario: a map with 'greatx: 1', 'name'");
  says("generate {} -o x", "expected a scenario (.yaml), found a folder");
  says("generate great_mcd_mini -o x", "expected a scenario, found a campaign");
  says("campaign run {}/run.yaml -o x", "expected a campaign, found a scenario; `greatx generate ");
  says("verify {}/run.yaml", "expected the folder of a data set, found a file");
  says("inspect {}/nothing", "expected a data set, found no such folder");
  says("inspect {}", "expected a data set, found no dataset.json");
}

/// Help is read in a terminal: no line is long, and every number has a range that people can read.
TEST(CommandLine, HelpOfEveryCommandIsReadable) {
  for (const char* command : {"",
                              "generate",
                              "campaign",
                              "campaign plan",
                              "campaign run",
                              "campaign slurm",
                              "campaign merge",
                              "campaign stats",
                              "scene",
                              "scene city",
                              "scene import",
                              "scene build",
                              "scene check",
                              "scene info",
                              "inspect",
                              "view",
                              "check",
                              "verify",
                              "explain",
                              "calibrate",
                              "tradeoff",
                              "bench",
                              "paths",
                              "map",
                              "rcs",
                              "info",
                              "selftest",
                              "cache"}) {
    const Outcome help = greatx(std::string(command) + " --help");
    ASSERT_EQ(help.code, 0) << command;
    EXPECT_THAT(help.out, HasSubstr(fmt::format("Usage: greatx {}", command))) << command;
    EXPECT_THAT(help.out, testing::Not(testing::ContainsRegex("e\\+[0-9]|[0-9]{8}|UINT|FLOAT| TEXT|->|\\{")))
        << command;
    std::istringstream lines(help.out);
    for (std::string line; std::getline(lines, line);)
      EXPECT_LE(line.size(), 100u) << command << ": " << line;
  }
}

TEST(CommandLine, NumbersAreReadStrictly) {
  const std::string natural = "expected an integer from 0 to 2^64 - 1, found";
  expect_refused("explain --seed=-1", "--seed: " + natural + " '-1'");
  expect_refused("explain --seed=18446744073709551616", "--seed: " + natural + " '18446744073709551616'");
  expect_refused("explain --seed=0x10", "--seed: " + natural + " '0x10'");
  expect_refused("explain --seed 1e3", "--seed: " + natural + " '1e3'");
  expect_refused("explain --seed ''", "--seed: " + natural + " ''");
  expect_refused("explain --ticks 0", "--ticks: expected an integer from 1 to 10^12, found '0'");
  expect_refused("explain --ticks=-5", "--ticks: expected an integer from 1 to 10^12, found '-5'");
  expect_refused("explain --sequences 4294967297",
                 "--sequences: expected an integer from 1 to 1000000, found '4294967297'");
  expect_refused("paths --within nan", "--within: expected a finite number, found 'nan'");
  expect_refused("paths --within=-1", "--within: expected a number of 0 or more, found '-1'");
  expect_refused("map -o /nonexistent/x --min 0 inf", "--min: expected a finite number, found 'inf'");
  expect_refused("map -o /nonexistent/x --min 0 1e300",
                 "--min: expected a number from -1e8 to 1e8, found '1e300'");
  expect_refused("scene city --size 1e999", "--size: expected a finite number, found '1e999'");
}

/// No option of a number accepts a word or -2^64 + 1, which CLI11 would wrap to 1.
TEST(CommandLine, EveryUnsignedOptionRefusesWhatWraps) {
  size_t options = 0;
  for (const char* command : {"info", "generate x", "inspect x", "verify x", "scene city", "scene import x",
                              "scene info x", "explain", "paths", "map", "bench"}) {
    const std::string help =
        greatx(std::string(command).substr(0, std::string(command).find(" x")) + " --help").out;
    for (size_t at = help.find("\n  --"); at != std::string::npos; at = help.find("\n  --", at + 1)) {
      const size_t name = at + 3, end = help.find_first_of(" \n", name);
      if (help.compare(end, 3, " N ") != 0 && help.compare(end, 3, " N\n") != 0) continue;
      const std::string option = help.substr(name, end - name);
      const Outcome outcome = greatx(fmt::format("{} {}=-18446744073709551615", command, option));
      EXPECT_EQ(outcome.code, 1) << command << ' ' << option;
      EXPECT_THAT(outcome.err, StartsWith("greatx: error: " + option + ": expected an integer")) << command;
      ++options;
    }
  }
  EXPECT_GT(options, 25u);
}

TEST(CommandLine, LeadingZerosAreDecimal) {
  const greatx::test::TemporaryFolder folder;
  const std::string path = folder.path().string();
  for (const char* seed : {"10", "010", "+10"})
    ASSERT_EQ(greatx(fmt::format("scene canyon --size 60 --seed {} -o {}/{}.glb", seed, path, seed)).code, 0);
  EXPECT_EQ(read_file(path + "/010.glb"), read_file(path + "/10.glb"));
  EXPECT_EQ(read_file(path + "/+10.glb"), read_file(path + "/10.glb"));
}

// ------------------------------------------------------------------------------------------- runs that stop

constexpr const char* long_scenario = R"(greatx: 1
name: long
ticks: 5000
tick_rate_hz: 10
scene: {generate: {kind: room}}
nodes:
  - name: uav
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [1, 1, 1]}, )"
                                      R"({t_s: 500, position_m: [2, 2, 2]}]}
    sensors: [{name: camera, type: camera, rate_hz: 10, width: 32, height: 24, fov_deg: 90}]
)";

/// The channel has 8 MiB per tick.
constexpr const char* wide_scenario = R"(greatx: 1
name: wide
ticks: 40
tick_rate_hz: 10
nodes:
  - {name: a, trajectory: {type: static, position_m: [0, 0, 0]}, sensors: [{name: antenna, type: antenna}]}
  - {name: b, trajectory: {type: static, position_m: [9, 0, 0]}, sensors: [{name: antenna, type: antenna}]}
channels:
  - {name: csi, tx: a/antenna, rx: [b/antenna], rate_hz: 10, subcarriers: 16384, )"
                                      R"(subcarrier_spacing_hz: 15e3, max_depth: 0,
     time_samples: 64, outputs: [cfr]}
)";

class Stopped : public testing::Test {
 protected:
  void SetUp() override { std::ofstream(folder_ / "long.yaml") << long_scenario; }
  /// Runs `arguments` in the background, waits for `file` in the folder, sends the signal and waits for the
  /// end.
  int stop(std::vector<std::string> arguments, const std::string& file, int signal) const {
    arguments.insert(arguments.begin(), "greatx");
    const pid_t child = fork();
    if (child == 0) {
      std::vector<char*> raw;
      for (std::string& argument : arguments) raw.push_back(argument.data());
      raw.push_back(nullptr);
      const bool redirected = std::freopen((folder_ / "out").c_str(), "w", stdout) != nullptr &&
                              std::freopen((folder_ / "err").c_str(), "w", stderr) != nullptr;
      if (redirected) execv(GREATX_PROGRAM, raw.data());
      _exit(127);
    }
    for (int i = 0; i < 6000 && !fs::exists(folder_ / file); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(fs::exists(folder_ / file)) << read_file(folder_ / "err");
    kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(Stopped, ARunSaysHowToGoOnAndWhatThereIs) {
  const std::string data = (folder_ / "data").string();
  const std::vector<std::string> arguments{"generate", (folder_ / "long.yaml").string(), "-o", data,
                                           "--json"};
  ASSERT_EQ(stop(arguments, "data/sequence_0000/uav/camera/rgb/000004.png", SIGINT), 130)
      << read_file(folder_ / "err");
  EXPECT_THAT(read_file(folder_ / "err"),
              testing::ContainsRegex("greatx: interrupted: .*data: complete up to tick [0-9]+ of 5000 in "
                                     "sequence 1 of 1; the same command with --resume goes on\n"));
  const auto summary = nlohmann::json::parse(read_file(folder_ / "out"));
  EXPECT_EQ(summary["finished"], false);
  int64_t files = 0;
  uint64_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(data))
    if (entry.is_regular_file()) ++files, bytes += entry.file_size();
  EXPECT_EQ(summary["files"], files);
  EXPECT_EQ(summary["bytes"], bytes);
  EXPECT_GT(bytes, 1000u);
}

/// Either a write or the device's memory meets the shell's limit first.
TEST_F(Stopped, AFileSizeLimitIsAnErrorByName) {
  const std::string glb = (folder_ / "city.glb").string(), data = (folder_ / "data").string();
  if (nlohmann::json::parse(greatx("info --json").out)["devices"][0]["type"] == "cpu") {
    const Outcome run = greatx(fmt::format("generate {} -o {} -q", (folder_ / "long.yaml").string(), data),
                               "ulimit -f 2000;");
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr("keeps its memory in a file"));
    EXPECT_THAT(run.err, HasSubstr("file-size limit (ulimit -f)"));
  }
  std::ofstream(folder_ / "wide.yaml") << wide_scenario;
  const Outcome run = greatx(fmt::format("generate {} -o {} -q", (folder_ / "wide.yaml").string(), data),
                             "ulimit -f 200000;");  // in units of 512 bytes
  EXPECT_EQ(run.code, 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("cfr.npy"));
  EXPECT_THAT(run.err, HasSubstr("cannot be written: File too large"));
  EXPECT_THAT(run.err, HasSubstr("--resume finishes it"));
  const Outcome scene = greatx(fmt::format("scene city -o {}", glb), "ulimit -f 100;");
  EXPECT_EQ(scene.code, 1) << scene.err;
  EXPECT_THAT(scene.err, HasSubstr(glb + ".part: cannot be written: File too large"));
  ASSERT_EQ(greatx(fmt::format("scene city -o {}", glb)).code, 0);
  const std::string png = (folder_ / "city.png").string();
  const Outcome picture = greatx(fmt::format("scene check {} -q --png {}", glb, png), "ulimit -f 20;");
  EXPECT_EQ(picture.code, 1) << picture.err;
  EXPECT_THAT(picture.err, HasSubstr(png + ".part: cannot be written: File too large"));
  EXPECT_FALSE(fs::exists(png + ".part"));
  const Outcome printed = greatx("explain city --json", "ulimit -f 1;");
  EXPECT_EQ(printed.code, 1);
  EXPECT_THAT(printed.err, HasSubstr("standard output: cannot be written"));
}

}  // namespace
