// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests `greatx paths` from the command line in a scene with closed forms: one mast above flat ground.
#include <cmath>
#include <complex>
#include <cstring>
#include <numbers>
#include <sched.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/apps/flat_ground.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using greatx::apps::test::greatx;
using greatx::apps::test::ground_gltf;
using greatx::apps::test::Outcome;
using greatx::apps::test::read_file;
using nlohmann::json;
using testing::HasSubstr;

constexpr double speed_of_light = 299792458.0;

constexpr const char* paths_scenario = R"(greatx: 1
name: flat
ticks: 11
tick_rate_hz: 10
scene: {objects: [{name: ground, file: ground.gltf, scale: 2000, position_m: [-500, -500, 0]}]}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [0, 0, 20]}
    sensors: [{name: panel, type: antenna, polarization: vh}]
  - name: uav
    trajectory: {type: waypoints, interpolation: linear, points: [)"
                                 R"({t_s: 0, position_m: [100, 0, 10]}, {t_s: 1, position_m: [110, 0, 10]}]}
    sensors: [{name: antenna, type: antenna}]
channels:
  - {name: csi, tx: bs/panel, rx: [uav/antenna], rate_hz: 10, subcarriers: 16, )"
                                 R"(bandwidth_hz: 20e6, max_depth: 2}
  - {name: high, tx: bs/panel, rx: [uav/antenna], rate_hz: 10, subcarriers: 16, )"
                                 R"(bandwidth_hz: 20e6, carrier_hz: 7e9}
  - {name: down, tx: uav/antenna, rx: [bs/panel], rate_hz: 10, subcarriers: 16, bandwidth_hz: 20e6}
effects: {gas: off}
)";

class PathsCli : public testing::Test {
 protected:
  void SetUp() override {
    write("ground.gltf", ground_gltf);
    write("flat.yaml", paths_scenario);
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Outcome paths(const std::string& arguments, const std::string& before = "") const {
    return greatx(fmt::format("paths {} {}", path("flat.yaml"), arguments), "GREATX_CACHE=off " + before);
  }
  json all(const std::string& arguments, const std::string& before = "") const {
    const Outcome outcome = paths("--json " + arguments, before);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out);
  }
  /// Returns the complex64 values of a .npy file of greatx, whose header takes 256 bytes.
  std::vector<std::complex<float>> responses(const std::string& file) const {
    const std::string bytes = read_file(file);
    std::vector<std::complex<float>> values((bytes.size() - 256) / 8);
    std::memcpy(values.data(), bytes.data() + 256, values.size() * 8);
    return values;
  }
  /// Writes a grid of receivers above the ground, more than are solved at once. Returns the file's path.
  std::string grid() const {
    std::string text = "x,y,z\n";
    for (int i = 0; i < 30; ++i)
      for (int j = 0; j < 10; ++j)
        text += fmt::format("{},{},{}\n", 10 * i - 150, 20 * j - 95, 1.5 + 0.01 * j);
    write("grid.csv", text);
    return path("grid.csv");
  }
  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(PathsCli, TwoRaysAboveFlatGround) {
  const json result = all("--tick 5");
  EXPECT_EQ(result["channel"], "csi");
  EXPECT_EQ(result["time_s"], 0.5);
  ASSERT_EQ(result["receivers"].size(), 1u);
  const json& link = result["receivers"][0];
  EXPECT_EQ(link["name"], "uav/antenna");
  EXPECT_TRUE(link["line_of_sight"]);
  ASSERT_EQ(link["paths"].size(), 2u);
  const json &sight = link["paths"][0], &echo = link["paths"][1];
  // The path goes from (0, 0, 20) to (105, 0, 10).
  EXPECT_NEAR(sight["length_m"], std::hypot(105.0, 10.0), 1e-9);
  EXPECT_NEAR(echo["length_m"], std::hypot(105.0, 30.0), 1e-9);
  EXPECT_NEAR(echo["delay_s"], std::hypot(105.0, 30.0) / speed_of_light, 1e-18);
  EXPECT_EQ(echo["chain"], "R");
  EXPECT_EQ(echo["interactions"][0]["objects"][0], "ground/ground");
  EXPECT_EQ(echo["interactions"][0]["materials"][0], "itu_medium_dry_ground");
  EXPECT_NEAR(echo["vertices_m"][1][0], 70.0, 1e-9);
  EXPECT_NEAR(echo["vertices_m"][1][2], 0.0, 1e-9);
  // The receiver moves away at 10 m/s along x.
  EXPECT_NEAR(sight["doppler_hz"], -10.0 * 105.0 / std::hypot(105.0, 10.0) * 3.5e9 / speed_of_light, 1e-6);
  EXPECT_NEAR(sight["gain_db"],
              20.0 * std::log10(speed_of_light / 3.5e9 / (4.0 * std::numbers::pi * std::hypot(105.0, 10.0))),
              1e-9);
  EXPECT_NEAR(echo["departure"]["zenith_rad"], 0.5 * std::numbers::pi + std::atan2(30.0, 105.0), 1e-12);
  EXPECT_TRUE(result["effects"]["reflection"]["on"]);
  EXPECT_EQ(result["totals"]["paths_by_kind"]["reflection"], 1);
  EXPECT_EQ(result["counters"]["paths"], 2);
  EXPECT_FALSE(result["guarantee"].get<std::string>().empty());
}

TEST_F(PathsCli, TheTableSaysTheSame) {
  const Outcome outcome = paths("--tick 5 --channel high");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("uav/antenna at (105.000, 0.000, 10.000) m, 105.475 m from the transmitter: 2 "
                        "paths, with line of sight"));
  EXPECT_THAT(outcome.out, HasSubstr("R ground/ground (itu_medium_dry_ground)"));
  EXPECT_THAT(outcome.out, HasSubstr("1 receiver, 2 paths (line of sight 1, reflection 1)"));
  EXPECT_THAT(outcome.out, HasSubstr("effects on: "));
}

TEST_F(PathsCli, ReceiversAreSolvedAloneAsAmongOthers) {
  grid();
  for (const char* channel : {"csi", "down"}) {  // a transmitter at rest and a moving one
    const std::string arguments =
        fmt::format("--tick 3 --channel {} --receivers {}", channel, path("grid.csv"));
    const json batch = all(arguments);
    ASSERT_EQ(batch["receivers"].size(), 300u);
    EXPECT_EQ(batch["totals"]["paths"], 600);
    EXPECT_EQ(batch["receivers"][299]["name"], "point 299");
    for (const int index : {0, 255, 256, 299}) {
      const json alone = all(fmt::format("{} --receiver {}", arguments, index));
      ASSERT_EQ(alone["receivers"].size(), 1u);
      EXPECT_EQ(alone["receivers"][0], batch["receivers"][static_cast<size_t>(index)]) << channel << index;
    }
  }
}

TEST_F(PathsCli, AnyNumberOfThreadsGivesTheSameBytes) {
  grid();
  const std::string arguments =
      fmt::format("--json --receivers {} --png {}", path("grid.csv"), path("grid.png"));
  cpu_set_t all, first;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  CPU_ZERO(&first);
  for (int cpu = 0; CPU_COUNT(&first) == 0; ++cpu)
    if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &first);
  ASSERT_EQ(sched_setaffinity(0, sizeof first, &first), 0);  // the program inherits the affinity
  const Outcome one = paths(arguments, "LP_NUM_THREADS=1");
  ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
  const std::string picture = read_file(path("grid.png"));
  const Outcome two = paths(arguments, "LP_NUM_THREADS=2");
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_FALSE(one.out.empty());
  EXPECT_EQ(one.out, two.out);
  EXPECT_EQ(picture, read_file(path("grid.png")));
}

TEST_F(PathsCli, JsonLinesAndCsvHoldOneReceiverALine) {
  grid();
  const Outcome outcome =
      paths(fmt::format("--json-lines --receivers {} --csv-out {}", path("grid.csv"), path("out/g.csv")));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream lines(outcome.out), csv(read_file(path("out/g.csv")));
  size_t receivers = 0;
  std::string row;
  std::getline(csv, row);
  EXPECT_EQ(
      row, "receiver,x_m,y_m,z_m,distance_m,paths,line_of_sight,path_gain_db,first_delay_ns,delay_spread_ns");
  for (std::string line; std::getline(lines, line);) {
    const json object = json::parse(line);
    if (object["kind"] != "receiver") continue;
    ASSERT_TRUE(std::getline(csv, row));
    EXPECT_THAT(row, HasSubstr(fmt::format("{},{},", receivers, object["position_m"][0].get<double>())));
    EXPECT_THAT(row, HasSubstr(fmt::format(",2,1,{},", object["gain_db"].get<double>())));
    ++receivers;
  }
  EXPECT_EQ(receivers, 300u);
  EXPECT_FALSE(std::getline(csv, row));
}

TEST_F(PathsCli, PicturesAndExportsAreWritten) {
  const Outcome outcome = paths(fmt::format(
      "--tick 3 --png {} --glb {} --with-scene --width 640 --height 480 --color kind --validation",
      path("p/a.png"), path("p/a.glb")));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("wrote " + path("p/a.png")));
  const std::string png = read_file(path("p/a.png"));
  ASSERT_GT(png.size(), 1000u);
  // Width and height stand in the header chunk, big-endian.
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\2\200\0\0\1\340", 8));
  EXPECT_EQ(read_file(path("p/a.glb")).substr(0, 4), "glTF");
  // greatx reads the file that it has written.
  const Outcome read = greatx(fmt::format("scene info --optical-only {}", path("p/a.glb")));
  EXPECT_EQ(read.code, 0) << read.err;
}

TEST_F(PathsCli, FaultyRequests) {
  const auto fails = [&](const std::string& arguments, const std::string& part) {
    const Outcome outcome = paths(arguments);
    EXPECT_EQ(outcome.code, 1) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(part));
    EXPECT_EQ(outcome.out, "") << arguments;
  };
  write("gap.csv", "x,y,z\n1,2,3\n4,,6\n");
  fails("--receivers " + path("gap.csv"), "gap.csv:3:3: y: expected a finite number, found a gap");
  write("nan.csv", "1,2,nan\n");
  fails("--receivers " + path("nan.csv"), "nan.csv:1:5: z: expected a finite number, found 'nan'");
  write("empty.csv", "# nothing\n");
  fails("--receivers " + path("empty.csv"), "empty.csv: expected one position (x, y, z) or more, found none");
  fails("--receivers " + path("absent.csv"), "absent.csv: expected a readable file");
  fails("--tick 11", "--tick: expected 0 to 10, the last tick of flat, found 11");
  fails("--tick -1", "--tick");
  fails("--sequence 1", "--sequence: expected 0 to 0, found 1");
  fails("--channel low", "--channel: expected one of csi, high, down, found 'low'");
  fails("--receiver 1", "--receiver: expected 0 to 0, or one of uav/antenna, found '1'");
  fails("--with-scene", "--with-scene: expected --glb");
  fails("--png a.png --height 200", "--height: expected 224 or more, found 200");
  fails("--within 30", "--within: expected --png or --glb with it");
  fails("--png a.png --view bs/panel",
        "--view: expected auto or a camera of the scenario (it has none), found 'bs/panel'");
}

TEST_F(PathsCli, AViewMayBeAnEventCameras) {
  std::string text = paths_scenario;
  const std::string antenna_alone = "[{name: antenna, type: antenna}]";
  const std::string eyes =
      "[{name: antenna, type: antenna}, {name: front, type: camera, rate_hz: 10, width: 64, height: 48, "
      "fov_deg: 90}, "
      "{name: dvs, type: event_camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90, distortion: {k1: "
      "-0.05}, "
      "mount: {rotation_deg: [180, 0, 0]}}]";
  text.replace(text.find(antenna_alone), antenna_alone.size(), eyes);
  write("eyes.yaml", text);
  const auto view = [&](const std::string& name) {
    return greatx(
        fmt::format("paths {} -q --png {} --width 320 --view {}", path("eyes.yaml"), path("view.png"), name),
        "GREATX_CACHE=off GREATX_VALIDATION=1");
  };
  const Outcome seen = view("uav/dvs");
  ASSERT_EQ(seen.code, 0) << seen.err;
  // The picture adds a head and a foot to the 240 rows of the camera.
  const std::string png = read_file(path("view.png"));
  ASSERT_GT(png.size(), 1000u);
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\1\100\0\0\1\154", 8)) << "320 x 364";
  const Outcome antenna = view("uav/antenna");
  EXPECT_EQ(antenna.code, 1);
  EXPECT_THAT(antenna.err, HasSubstr("a camera of the scenario (uav/front, uav/dvs), found 'uav/antenna'"));
}

TEST_F(PathsCli, ResponsesAreThoseOfARunAndOfNodesPutThere) {
  ASSERT_EQ(paths("-q --tick 5 --cfr " + path("own.npy")).code, 0);
  const Outcome run =
      greatx(fmt::format("generate {} -o {}", path("flat.yaml"), path("run")), "GREATX_CACHE=off");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto own = responses(path("own.npy")), all = responses(path("run/sequence_0000/csi/cfr.npy"));
  ASSERT_EQ(own.size(), 2u * 16u);
  ASSERT_EQ(all.size(), 11 * own.size());
  EXPECT_EQ(std::memcmp(own.data(), all.data() + 5 * own.size(), own.size() * 8), 0);

  // The second of three points is the receiver's position at tick 5, at rest.
  write("points.csv", "x,y,z\n50,10,3\n105,0,10\n-40,20,8\n");
  ASSERT_EQ(paths("-q --tick 5 --receivers " + path("points.csv") + " --cfr " + path("points.npy")).code, 0);
  const auto points = responses(path("points.npy"));
  ASSERT_EQ(points.size(), 3 * own.size());
  EXPECT_EQ(std::memcmp(points.data() + own.size(), own.data(), own.size() * 8), 0);
  EXPECT_FALSE(fs::exists(path("points.npy.part")));
  EXPECT_EQ(paths("-q --receiver 0 --cfr " + path("one.npy")).code, 1);
}

TEST_F(PathsCli, ThePointsOfACallDecideWhatTheAirDoes) {
  const auto empty = [&](const std::string& name, const std::string& where) {
    write(
        name,
        fmt::format(
            "greatx: 1\nname: empty\nticks: 1\nnodes:\n"
            "  - {{name: bs, trajectory: {{type: static, position_m: [0, 0, 20]}}, sensors: [{{name: a, "
            "type: "
            "antenna}}]}}\n"
            "  - {{name: ue, trajectory: {{type: static, position_m: {}}}, sensors: [{{name: a, type: "
            "antenna}}]}}\n"
            "channels: [{{name: csi, tx: bs/a, rx: [ue/a], rate_hz: 10, subcarriers: 4, bandwidth_hz: 20e6, "
            "carrier_hz: 60e9, max_depth: 0}}]\n",
            where));
    return path(name);
  };
  const std::string near = empty("near.yaml", "[0.1, 0, 20]"), far = empty("far.yaml", "[1000, 0, 20]");
  write("points.csv", "0.1,0,20\n1000,0,20\n");
  const auto json_of = [](const std::string& arguments) {
    const Outcome outcome = greatx("paths --json " + arguments, "GREATX_CACHE=off");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out);
  };
  const json node = json_of(far),
             points = json_of(fmt::format("{} --receivers {}", near, path("points.csv")));
  EXPECT_EQ(json_of(near)["effects"]["gas"]["on"], false);
  EXPECT_EQ(points["effects"]["gas"]["on"], true);
  EXPECT_EQ(points["receivers"][1]["paths"], node["receivers"][0]["paths"]);
  // A single receiver of a list has the same result as in the list.
  const json one = json_of(fmt::format("{} --receivers {} --receiver 0", near, path("points.csv")));
  EXPECT_EQ(one["receivers"][0], points["receivers"][0]);
  const Outcome map = greatx(
      fmt::format("map {} -o {} --plane 20 --min 995 -5 --max 1005 5 --cell 10 --beyond-scene --no-pictures",
                  near, path("map")),
      "GREATX_CACHE=off");
  ASSERT_EQ(map.code, 0) << map.err;
  EXPECT_EQ(json::parse(read_file(path("map/map.json")))["request"]["effects"]["gas"], true);
}

TEST_F(PathsCli, WhatIsNoFileOfTheCacheIsWarnedOf) {
  const fs::path cache = folder_ / "cache";
  const auto run = [&] {
    return greatx("paths --brief " + path("flat.yaml"), "GREATX_CACHE=" + cache.string());
  };
  ASSERT_EQ(run().code, 0);
  ASSERT_EQ(std::distance(fs::directory_iterator(cache), fs::directory_iterator()), 1);
  const fs::path entry = fs::directory_iterator(cache)->path();
  fs::remove(entry);
  fs::create_directories(entry / "inner");
  const Outcome blocked = run();
  EXPECT_EQ(blocked.code, 0) << blocked.err;
  EXPECT_THAT(blocked.err, HasSubstr(entry.filename().string() + ": a folder, not a file; searching again"));
  EXPECT_THAT(blocked.err, HasSubstr("candidates are not kept"));
  fs::remove_all(entry);
  write("cache/" + entry.filename().string(), "nonsense");
  const Outcome damaged = run();
  EXPECT_EQ(damaged.code, 0);
  EXPECT_THAT(damaged.err, HasSubstr("damaged"));
  EXPECT_EQ(run().err, "") << "replaced";
  const Outcome limit =
      greatx("paths " + path("flat.yaml"), "GREATX_CACHE_MIB=some GREATX_CACHE=" + cache.string());
  EXPECT_EQ(limit.code, 1);
  EXPECT_THAT(limit.err, HasSubstr("GREATX_CACHE_MIB: expected a whole number of MiB"));
}

TEST_F(PathsCli, TakesOneOfSeveralTransmitters) {
  std::string text = paths_scenario;
  const std::string one = "name: csi, tx: bs/panel, rx: [uav/antenna]";
  text.replace(text.find(one), one.size(), "name: csi, tx: [bs/panel, uav/antenna], rx: [bs/panel]");
  text.replace(text.find(", polarization: vh"), 18, "");
  write("flat.yaml", text);
  EXPECT_EQ(all("")["transmitter"], "bs/panel");
  const json second = all("--transmitter uav/antenna");
  EXPECT_EQ(second["transmitter"], "uav/antenna");
  EXPECT_EQ(second["receivers"], all("--transmitter 1")["receivers"]);
  EXPECT_NEAR(second["receivers"][0]["distance_m"].get<double>(), std::hypot(100.0, 10.0), 1e-9);
  EXPECT_THAT(paths("--transmitter 2").err,
              HasSubstr("--transmitter: expected 0 to 1, or one of bs/panel, uav/antenna"));
}

}  // namespace
