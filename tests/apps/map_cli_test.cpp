// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests `greatx map` from the command line, with two masts above flat ground.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <map>
#include <numbers>
#include <sched.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/apps/flat_ground.h"
#include "tests/apps/program.h"

namespace {

namespace fs = std::filesystem;
using greatx::apps::test::greatx;
using greatx::apps::test::ground_gltf;
using greatx::apps::test::Outcome;
using greatx::apps::test::read_file;
using nlohmann::json;
using testing::HasSubstr;

// The ground ends at other distances in the east than in the west, which finite reflectors would show.
constexpr const char* scenario = R"(greatx: 1
name: flat
ticks: 11
tick_rate_hz: 10
scene: {objects: [{name: ground, file: ground.gltf, scale: 2000, position_m: [-500, -500, 0]}]}
nodes:
  - name: west
    trajectory: {type: static, position_m: [-60, 0, 20]}
    sensors: [{name: panel, type: antenna}]
  - name: east
    trajectory: {type: static, position_m: [60, 0, 20]}
    sensors: [{name: panel, type: antenna}]
  - name: ue
    trajectory: {type: static, position_m: [0, 0, 1.5]}
    sensors: [{name: antenna, type: antenna}]
channels:
  - {name: csi, tx: [west/panel, east/panel], rx: [ue/antenna], rate_hz: 10, subcarriers: 16, )"
                                 R"(bandwidth_hz: 20e6, max_depth: 1}
effects: {gas: off, finite_reflectors: off}
)";

/// The map has 1408 cells, more than are solved at once.
constexpr const char* area = "--min -110 -80 --max 110 80 --cell 5 --side 220";

class MapCli : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "ground.gltf") << ground_gltf;
    std::ofstream(folder_ / "flat.yaml") << scenario;
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  Outcome map(const std::string& output, const std::string& arguments, const std::string& before = "") const {
    return greatx(fmt::format("map {} -o {} {}", path("flat.yaml"), path(output), arguments),
                  "GREATX_CACHE=off " + before);
  }
  /// Returns the content of every file of a folder by its name.
  std::map<std::string, std::string> files(const std::string& name) const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_ / name))
      all[entry.path().filename().string()] = read_file(entry.path());
    return all;
  }
  /// Returns the numbers of a .npy file, whose header takes 256 bytes.
  template <typename T = double>
  std::vector<T> numbers(const std::string& file) const {
    const std::string bytes = read_file(folder_ / file);
    EXPECT_GE(bytes.size(), 256u) << file;
    std::vector<T> values(bytes.size() < 256 ? 0 : (bytes.size() - 256) / sizeof(T));
    std::memcpy(values.data(), bytes.data() + 256, values.size() * sizeof(T));
    return values;
  }
  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(MapCli, WritesArraysPicturesAndWhatTheyAre) {
  const Outcome outcome =
      map("out", fmt::format("{} --power 30,33 --noise-figure 5 --each-transmitter", area));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1408 cells: 0 inside solids"));
  const json description = json::parse(read_file(path("out/map.json")));
  const json& request = description["request"];
  EXPECT_EQ(request["grid"]["rows"], 32);
  EXPECT_EQ(request["grid"]["columns"], 44);
  EXPECT_EQ(request["grid"]["row_0"], "south");
  EXPECT_EQ(request["transmitters"][1]["power_dbm"], 33.0);
  EXPECT_NEAR(request["noise"]["power_dbm"].get<double>(),
              10.0 * std::log10(1.380649e-23 * 290.0 * 20e6) + 30.0 + 5.0, 1e-9);
  ASSERT_GE(description["arrays"].size(), 15u);
  for (const json& array : description["arrays"]) {
    size_t count = 1;
    for (const json& side : array["shape"]) count *= side.get<size_t>();
    const size_t size = array["dtype"].get<std::string>().back() - '0';
    EXPECT_EQ(fs::file_size(folder_ / "out" / array["file"].get<std::string>()), 256 + count * size) << array;
  }
  for (const json& picture : description["pictures"])
    EXPECT_THAT(read_file(folder_ / "out" / picture["file"].get<std::string>()), HasSubstr("IHDR"));
  EXPECT_FALSE(fs::exists(path("out/links.part")));
  EXPECT_TRUE(fs::exists(path("out/sinr_tx1.png")));

  // The map is symmetric about its middle. One mast is 3 dB stronger.
  const auto gain = numbers("out/path_gain.npy"), rss = numbers("out/rss.npy");
  const auto best = numbers<int32_t>("out/best_server.npy");
  ASSERT_EQ(gain.size(), 2u * 1408u);
  for (size_t row = 0; row < 32; ++row)
    for (size_t column = 0; column < 44; ++column) {
      const size_t cell = row * 44 + column, mirrored = row * 44 + 43 - column;
      EXPECT_NEAR(gain[cell] / gain[1408 + mirrored], 1.0, 1e-9);
      EXPECT_NEAR(rss[1408 + cell], 10.0 * std::log10(gain[1408 + cell]) + 33.0, 1e-9);
      EXPECT_EQ(best[cell], rss[cell] > rss[1408 + cell] ? 0 : 1);
    }
  EXPECT_THAT(numbers<uint8_t>("out/line_of_sight.npy"), testing::Each(1));
  EXPECT_THAT(numbers("out/z.npy"), testing::Each(1.5));
}

TEST_F(MapCli, ACellIsAReceiverOfGreatxPaths) {
  ASSERT_EQ(map("out", fmt::format("{} --plane 3 --quantities path_gain,paths --no-pictures", area)).code, 0);
  const size_t cell = 7 * 44 + 12;
  std::ofstream(folder_ / "point.csv") << fmt::format("{},{},3\n", -110 + 12.5 * 5, -80 + 7.5 * 5);
  const Outcome outcome =
      greatx(fmt::format("paths {} --receivers {} --json", path("flat.yaml"), path("point.csv")));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json receiver = json::parse(outcome.out)["receivers"][0];
  double gain = 0.0;
  const double factor = 299792458.0 / 3.5e9 / (4.0 * std::numbers::pi);
  for (const json& one : receiver["paths"]) {
    const json& t = one["transfer_per_m"][0];  // both ends are vertical
    gain += factor * factor * (std::pow(t[0].get<double>(), 2) + std::pow(t[1].get<double>(), 2));
  }
  EXPECT_NEAR(numbers("out/path_gain.npy")[cell] / gain, 1.0, 1e-12);
  EXPECT_EQ(numbers<int32_t>("out/paths.npy")[cell], 2);
}

TEST_F(MapCli, AStoppedMapGoesOnToTheSameBytes) {
  // 35,200 cells leave time to stop the run.
  const std::string large = "--min -110 -80 --max 110 80 --cell 1 --side 220 --quantities path_gain,sinr";
  const pid_t child = fork();
  if (child == 0) {
    const std::string scenario_file = path("flat.yaml"), output = path("parts");
    if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(98);
    execl(GREATX_PROGRAM, GREATX_PROGRAM, "map", scenario_file.c_str(), "-o", output.c_str(), "--min", "-110",
          "-80", "--max", "110", "80", "--cell", "1", "--side", "220", "--quantities", "path_gain,sinr",
          static_cast<char*>(nullptr));
    _exit(99);
  }
  std::error_code missing;
  for (int i = 0; i < 20000; ++i) {
    const auto size = fs::file_size(folder_ / "parts/links.part", missing);
    if (!missing && size > 60000) break;  // at least one block
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status)) << "ended by the signal, not cleanly";
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_TRUE(fs::exists(path("parts/links.part")));
  EXPECT_FALSE(fs::exists(path("parts/map.json")));

  EXPECT_THAT(map("parts", large).err, HasSubstr("--resume finishes it"));
  EXPECT_THAT(map("parts", large + " --power 20 --resume").err,
              HasSubstr("/transmitters/0/power_dbm: asked for 20.0, the folder's has 30.0"));
  // A torn end of the file is dropped.
  { std::ofstream(folder_ / "parts/links.part", std::ios::app | std::ios::binary) << "torn"; }
  const Outcome resumed = map("parts", large + " --resume --json");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  const size_t solved = json::parse(resumed.out)["cells_solved"];
  EXPECT_GT(solved, 0u);
  EXPECT_LT(solved, 35200u);
  ASSERT_EQ(map("whole", large).code, 0);
  const auto whole = files("whole"), parts = files("parts");
  ASSERT_EQ(whole.size(), parts.size());
  for (const auto& [name, bytes] : whole) EXPECT_TRUE(parts.at(name) == bytes) << name;

  EXPECT_THAT(map("parts", large).err, HasSubstr("holds a finished radio map"));
  const Outcome again = map("parts", large + " --resume");
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.out, HasSubstr("already finished"));

  { std::ofstream(folder_ / "parts/map.json") << std::string(100'000, '['); }
  const Outcome deep = map("parts", large + " --resume");
  EXPECT_EQ(deep.code, 1);
  EXPECT_THAT(deep.err, HasSubstr("map.json:1: expected JSON nested at most 64 deep"));
}

TEST_F(MapCli, APrecoderGivesItsOwnArrays) {
  std::string text = scenario;
  for (const char* name : {"west", "east"}) {
    const size_t node = text.find(fmt::format("name: {}", name)), antenna = text.find("type: antenna", node);
    text.replace(antenna, 13, "type: antenna, columns: 4");
  }
  std::ofstream(folder_ / "flat.yaml") << text;
  const std::string coarse = "--min -110 -80 --max 110 80 --cell 20 --side 220";
  ASSERT_EQ(map("best", coarse + " --precoder best_beam --oversampling 1 2").code, 0);
  const json description = json::parse(read_file(path("best/map.json")));
  EXPECT_EQ(description["request"]["precoder"],
            json::parse(R"({"name": "best_beam", "oversampling": [1, 2]})"));
  const auto beams = numbers<int32_t>("best/best_beam.npy");
  const auto best = numbers("best/beam_gain.npy"), mean = numbers("best/path_gain.npy"),
             rss = numbers("best/rss.npy");
  ASSERT_EQ(beams.size(), 2u * 8 * 11);
  ASSERT_EQ(best.size(), beams.size());
  for (size_t i = 0; i < best.size(); ++i) {
    EXPECT_TRUE(beams[i] >= 0 && beams[i] < 8) << beams[i];
    EXPECT_GT(best[i], 3.0 * mean[i]);  // a neighbour among eight beams loses 0.9 dB of 6 at most
    EXPECT_LE(best[i], 4.0 * mean[i] * (1.0 + 1e-12));
    EXPECT_NEAR(rss[i], 30.0 + 10.0 * std::log10(best[i]), 1e-9);
  }
  EXPECT_TRUE(fs::exists(folder_ / "best/best_beam.png"));
  ASSERT_EQ(map("one", coarse + " --precoder beam --beam 3 --oversampling 1 2 --no-pictures").code, 0);
  const auto one = numbers("one/beam_gain.npy");
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_LE(one[i], best[i]);
    if (beams[i] == 3) {
      EXPECT_EQ(one[i], best[i]);
    }
  }
  EXPECT_THAT(map("one", coarse + " --precoder beam --beam 4 --oversampling 1 2 --no-pictures --resume").err,
              HasSubstr("/precoder/beam: asked for 4, the folder's has 3"));
  ASSERT_EQ(map("plain", coarse + " --no-pictures").code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "plain/best_beam.npy"));
  EXPECT_FALSE(json::parse(read_file(path("plain/map.json")))["request"].contains("precoder"));
  EXPECT_EQ(numbers("plain/path_gain.npy"), mean);
  const Outcome asked = map("none", coarse + " --quantities best_beam");
  EXPECT_EQ(asked.code, 1);
  EXPECT_THAT(asked.err, HasSubstr("--quantities: expected --precoder for 'best_beam', found none"));
  const Outcome beyond = map("none", coarse + " --precoder beam --beam 4");
  EXPECT_EQ(beyond.code, 1);
  EXPECT_THAT(beyond.err, HasSubstr("--beam: expected 0 to 3, one of the beams of 'west/panel', found 4"));
}

TEST_F(MapCli, AnyNumberOfThreadsGivesTheSameBytes) {
  cpu_set_t all, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  CPU_ZERO(&one);
  for (int cpu = 0; CPU_COUNT(&one) == 0; ++cpu)
    if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);  // the program inherits the affinity
  const Outcome alone = map("one", area, "LP_NUM_THREADS=1");
  ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
  ASSERT_EQ(alone.code, 0) << alone.err;
  ASSERT_EQ(map("two", area, "LP_NUM_THREADS=2").code, 0);
  const auto first = files("one"), second = files("two");
  ASSERT_EQ(first.size(), second.size());
  for (const auto& [name, bytes] : first) EXPECT_TRUE(second.at(name) == bytes) << name;
}

TEST_F(MapCli, SaysWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"--cell 0", "--cell: expected a length above 0 m, found 0"},
      {"--cell -1", "--cell: expected a length above 0 m, found -1"},
      {"--cell 0.01 --min 0 0 --max 100 100", "10000 x 10000 cells"},
      {"--min 0 0 --max 0 10", "--max: expected more than --min"},
      {"--plane 800",
       "--plane: expected a height within the scene and its transmitters, z 0 to 20 m, found 800"},
      {"--min 5000 5000 --max 5100 5100 --plane 1", "x -500 to 1500 m and y -500 to 1500 m"},
      {"--height 0", "--height: expected more than 0 m, found 0"},
      {"--power nan", "--power: expected a finite number, found 'nan'"},
      {"--power 201", "--power: expected -200 to 200 dBm"},
      {"--power 30,30,30", "--power: expected 1 number, or 2"},
      {"--bandwidth 0", "--bandwidth: expected more than 0 Hz"},
      {"--noise-figure -3", "--noise-figure: expected 0 dB or more"},
      {"--quantities rss,gain", "--quantities: expected some of path_gain"},
      {"--channel none", "--channel: expected csi, found 'none'"},
      {"--rx ue/camera", "--rx: expected an antenna of the scenario"},
      {"--tick 99", "--tick: expected 0 to 10"},
      {"--plane 1 --height 2", "--plane: expected no --height beside it"}};
  for (const auto& [arguments, message] : faults) {
    const Outcome outcome = map("wrong", arguments);
    EXPECT_EQ(outcome.code, 1) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << arguments;
    EXPECT_FALSE(fs::exists(path("wrong"))) << arguments;
  }
  fs::create_directory(folder_ / "full");
  std::ofstream(folder_ / "full/mine.txt") << "mine";
  EXPECT_THAT(map("full", area).err, HasSubstr("mine.txt"));
}

}  // namespace
