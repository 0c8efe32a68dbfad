// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs greatx as a user does: exit codes, messages, data sets on disk, interruption, threads.
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
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

constexpr const char* small_scenario = R"(greatx: 1
name: small
seed: 3
ticks: 6
tick_rate_hz: 10
scene: {generate: {kind: city, seed: 3, size_m: 100}}
environment: {clouds: 0}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [3, 4, 30]}
    sensors: [{name: panel, type: antenna, polarization: slant, rows: 2, columns: 2}]
  - name: uav
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-20, -15, 40]}, )"
                                       R"({t_s: 1, position_m: [10, 5, 45]}]}
    model: {generate: {kind: quadrotor}}
    sensors:
      - {name: camera, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90, )"
                                       R"(mount: {rotation_deg: [0, 40, 0]}}
      - {name: lidar, type: lidar, rate_hz: 5, channels: 8, elevation_min_deg: -60, )"
                                       R"(elevation_max_deg: -10, azimuth_steps: 64}
      - {name: antenna, type: antenna}
channels:
  - {name: csi, tx: bs/panel, rx: [uav/antenna], rate_hz: 10, subcarriers: 16, )"
                                       R"(bandwidth_hz: 20e6, max_depth: 2, rays: 20000}
)";

/// Provides a folder with the small scenario.
class Cli : public testing::Test {
 protected:
  void SetUp() override { write("small.yaml", small_scenario); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  /// Writes the small scenario with one piece of text replaced, and returns the file's path.
  std::string changed(const std::string& from, const std::string& to) const {
    std::string text = small_scenario;
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    write("changed.yaml", text);
    return path("changed.yaml");
  }
  Outcome generate(const std::string& output, const std::string& more = "",
                   const std::string& before = "") const {
    return greatx(fmt::format("generate {} -o {} {}", path("small.yaml"), path(output), more), before);
  }
  std::string manifest(const std::string& output) const {
    return read_file(folder_ / output / "manifest.json");
  }
  /// Starts `greatx generate` in the background. Returns the process id.
  pid_t start(const std::string& output, const std::string& more = "") const {
    const pid_t child = fork();
    if (child != 0) return child;
    std::vector<std::string> arguments{"greatx",     "generate", path("small.yaml"), "-o",
                                       path(output), "-q",       "--ticks",          "250"};
    if (!more.empty()) arguments.push_back(more);
    std::vector<char*> raw;
    for (std::string& argument : arguments) raw.push_back(argument.data());
    raw.push_back(nullptr);
    if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(126);
    execv(GREATX_PROGRAM, raw.data());
    _exit(127);
  }
  /// Waits until a few packets are written.
  void await_packets(const std::string& output) const {
    const fs::path frame = folder_ / output / "sequence_0000/uav/camera/rgb/000004.png";
    for (int i = 0; i < 6000 && !fs::exists(frame); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(fs::exists(frame));
  }
  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(Cli, HelpIsThereForEveryCommand) {
  EXPECT_THAT(greatx("--help").out, HasSubstr("generate"));
  for (const char* command :
       {"info", "generate", "inspect", "verify", "scene", "explain", "paths", "map", "bench"}) {
    const Outcome help = greatx(std::string(command) + " --help");
    EXPECT_EQ(help.code, 0) << command;
    EXPECT_THAT(help.out, HasSubstr("--help")) << command;
  }
  EXPECT_EQ(greatx("").code, 1);
  EXPECT_EQ(greatx("simulate").code, 1);
}

TEST_F(Cli, InfoListsTheDevices) {
  const Outcome info = greatx("info --json");
  ASSERT_EQ(info.code, 0) << info.err;
  const auto json = nlohmann::json::parse(info.out);
  EXPECT_FALSE(json["devices"].empty());
  EXPECT_FALSE(json["devices"][0]["capabilities"].empty());
}

TEST_F(Cli, GenerateVerifyInspect) {
  const Outcome made = generate("a", "--json --validation");
  ASSERT_EQ(made.code, 0) << made.err;
  const auto summary = nlohmann::json::parse(made.out);
  EXPECT_EQ(summary["ticks"], 6);
  EXPECT_EQ(summary["submits"], 6);
  EXPECT_EQ(summary["packets"], 6);
  EXPECT_EQ(summary["records"]["uav/lidar"], 3);
  EXPECT_LT(summary["consistency"]["depth_vs_ray"]["max_relative_error"], 1e-4);
  EXPECT_GT(summary["peak_rss_bytes"], 0);

  const Outcome verified = greatx("verify " + path("a"));
  EXPECT_EQ(verified.code, 0) << verified.out;
  const Outcome inspected = greatx("inspect --json " + path("a"));
  EXPECT_EQ(inspected.code, 0) << inspected.err;
  EXPECT_TRUE(nlohmann::json::parse(inspected.out).contains("sensors"));
  EXPECT_TRUE(fs::exists(folder_ / "a/contact_sheet.png"));
  EXPECT_EQ(greatx("verify " + path("a")).code, 0) << "the contact sheet is no foreign file";
  const Outcome animated =
      greatx(fmt::format("inspect {0} --frames 2 --animation {0}/animation.webp", path("a")));
  EXPECT_EQ(animated.code, 0) << animated.err;
  EXPECT_THAT(animated.out, HasSubstr("animation.webp, 2 frames of "));
  EXPECT_EQ(greatx("verify " + path("a")).code, 0) << "nor is the animation";
  EXPECT_THAT(greatx(fmt::format("inspect {} --animation {}", path("a"), path("a.gif"))).err,
              HasSubstr("ends in .webp"));
  EXPECT_EQ(greatx(fmt::format("inspect {} --frames 2", path("a"))).code, 1) << "of what animation?";
  const Outcome paper = greatx(fmt::format(
      "inspect {} --theme light --scale 2 --sensor uav/lidar --picture {}", path("a"), path("paper.png")));
  EXPECT_EQ(paper.code, 0) << paper.err;
  EXPECT_TRUE(fs::exists(folder_ / "paper.png"));
  EXPECT_THAT(greatx(fmt::format("inspect {} --sensor uav/lidra", path("a"))).err,
              HasSubstr("found 'uav/lidra' (did you mean 'uav/lidar'?)"));
  EXPECT_THAT(greatx(fmt::format("inspect {} --link bs:nobody", path("a"))).err,
              HasSubstr("no channel has the link"));
  EXPECT_EQ(greatx(fmt::format("inspect {} --theme grey", path("a"))).code, 1);
  const Outcome page = greatx(fmt::format("inspect {0} --html {0}/report.html --html-ticks 2", path("a")));
  EXPECT_EQ(page.code, 0) << page.err;
  EXPECT_THAT(page.out, HasSubstr("report.html, 2 moments, "));
  EXPECT_THAT(page.err, HasSubstr("note: Sequence 0: 2 of 6 ticks with records are shown"));
  EXPECT_EQ(greatx("verify " + path("a")).code, 0) << "nor is the report";
  EXPECT_THAT(greatx(fmt::format("inspect {0} {0} --picture {1} --html {2}", path("a"), path("both.png"),
                                 path("both.html")))
                  .err,
              HasSubstr("--html shows one data set, found 2"));
  EXPECT_THAT(greatx(fmt::format("inspect {0} --html {0}/dataset.json", path("a"))).err,
              HasSubstr("another file, which is not overwritten"));
  fs::create_directories(folder_ / "campaign/data/rain");
  std::ofstream(folder_ / "campaign/cells.json") << "{}";
  EXPECT_THAT(greatx("inspect " + path("campaign")).err,
              HasSubstr("it is a campaign: name one of its 1 data sets, " + path("campaign/data/rain")));

  fs::resize_file(folder_ / "a/sequence_0000/uav/camera/rgb/000002.png", 100);
  const Outcome damaged = greatx("verify " + path("a"));
  EXPECT_EQ(damaged.code, 1);
  EXPECT_THAT(damaged.out, HasSubstr("000002.png"));
}

TEST_F(Cli, FinishedDataSetsAreNotOverwritten) {
  ASSERT_EQ(generate("a", "-q").code, 0);
  const std::string before = manifest("a");
  const Outcome again = generate("a", "-q");
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.err, HasSubstr(path("a")));
  EXPECT_EQ(generate("a", "-q --resume").code, 0) << "nothing to do";
  EXPECT_EQ(manifest("a"), before);
}

TEST_F(Cli, HardCaseN63AnyNumberOfThreadsGivesTheSameBytes) {
  std::string fair = small_scenario;  // threads share the work for clouds, too
  fair.replace(fair.find("clouds: 0"), 9, "clouds: 0.3");
  write("small.yaml", fair);
  ASSERT_EQ(generate("one", "-q --threads 1", "LP_NUM_THREADS=1").code, 0);
  ASSERT_EQ(generate("two", "-q --threads 2", "LP_NUM_THREADS=2").code, 0);
  ASSERT_EQ(generate("many", "-q --threads 16", "LP_NUM_THREADS=16").code, 0);
  EXPECT_FALSE(manifest("one").empty());
  EXPECT_EQ(manifest("one"), manifest("two"));
  EXPECT_EQ(manifest("one"), manifest("many"));
}

TEST_F(Cli, KilledRunsAreFinishedToTheSameBytes) {
  const pid_t child = start("killed");
  await_packets("killed");
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_THAT(greatx("verify " + path("killed")).out, HasSubstr("unfinished"));
  ASSERT_EQ(greatx(fmt::format("inspect {}", path("killed"))).code, 0) << "whole packets can be looked at";
  const Outcome other = generate("killed", "-q --resume --ticks 40");
  EXPECT_EQ(other.code, 1) << "another length is another run";
  const Outcome resumed = generate("killed", "-q --resume --ticks 250");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  ASSERT_EQ(generate("whole", "-q --ticks 250").code, 0);
  EXPECT_EQ(manifest("killed"), manifest("whole"));
}

TEST_F(Cli, InterruptionEndsAfterTheTick) {
  const pid_t child = start("stopped");
  await_packets("stopped");
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status)) << "ended by the signal, not cleanly";
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_EQ(generate("stopped", "-q --resume --ticks 250").code, 0);
  EXPECT_EQ(greatx("verify " + path("stopped")).code, 0);
}

TEST_F(Cli, ExplainGivesAReasonForEveryEffect) {
  const Outcome explained = greatx("explain --json " + path("small.yaml"));
  ASSERT_EQ(explained.code, 0) << explained.err;
  const auto effects = nlohmann::json::parse(explained.out)["effects"];
  EXPECT_GT(effects.size(), 15u);
  for (const auto& effect : effects)
    EXPECT_FALSE(effect["reason"].get<std::string>().empty()) << effect["name"];
}

TEST_F(Cli, BenchTimesTicksAndPasses) {
  const Outcome bench = greatx(fmt::format("bench {} --json --warm-up 1", path("small.yaml")));
  ASSERT_EQ(bench.code, 0) << bench.err;
  const auto json = nlohmann::json::parse(bench.out);
  EXPECT_GT(json["tick_ms"]["median"], 0.0);
  EXPECT_GE(json["tick_ms"]["max"], json["tick_ms"]["min"]);
  EXPECT_TRUE(json["pass_ms"].contains("uav/lidar"));
}

TEST_F(Cli, ImportsAMitsubaScene) {
  const auto write = [&](const char* name, const char* text) { std::ofstream(folder_ / name) << text; };
  write("floor.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n4 0 0\n0 3 0\n3 0 1 2\n");
  write("floor.xml",
        "<scene version=\"2.1.0\">\n<bsdf type=\"diffuse\" id=\"mat-itu_concrete\">"
        "<rgb value=\"0.5 0.5 0.5\" name=\"reflectance\"/></bsdf>\n<shape type=\"ply\" id=\"floor\">"
        "<string name=\"filename\" value=\"floor.ply\"/><ref id=\"mat-itu_concrete\" "
        "name=\"bsdf\"/></shape>\n</scene>\n");
  const std::string out = (folder_ / "new/floor.glb").string();
  const Outcome done = greatx(fmt::format("scene import {} -o {}", (folder_ / "floor.xml").string(), out));
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("1 objects, 1 triangles, 1 materials"));
  const Outcome info = greatx("scene info " + out);
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("itu_concrete"));
  fs::remove(folder_ / "floor.ply");
  const Outcome lacks = greatx(fmt::format("scene import {} -o {}", (folder_ / "floor.xml").string(), out));
  EXPECT_EQ(lacks.code, 1);
  EXPECT_THAT(lacks.err, HasSubstr("floor.ply"));
}

TEST_F(Cli, ScenesAreWrittenAndDescribed) {
  ASSERT_EQ(greatx(fmt::format("scene car --variant van -o {}", path("van.glb"))).code, 0);
  const Outcome described = greatx("scene info " + path("van.glb"));
  EXPECT_EQ(described.code, 0) << described.err;
  EXPECT_THAT(described.out, HasSubstr("triangles"));
}

TEST_F(Cli, SceneInfoSaysWhatMaterialsAre) {
  ASSERT_EQ(greatx(fmt::format("scene city --size 120 -o {}", path("city.glb"))).code, 0);
  const Outcome described = greatx("scene info " + path("city.glb"));
  ASSERT_EQ(described.code, 0) << described.err;
  std::istringstream lines(described.out);
  std::map<std::string, std::string> materials;
  for (std::string line, word, name; std::getline(lines, line);)
    if (std::istringstream words(line); words >> word >> name && word == "material") materials[name] = line;
  // The base colour is 1 times a picture of asphalt, which reflects a tenth or two of the light.
  const std::string asphalt = materials["asphalt"], said = "reflectance ";
  EXPECT_THAT(asphalt, HasSubstr("asphalt_concrete, half-space;"));
  EXPECT_THAT(asphalt, HasSubstr("905 nm, mean of the base colour's texture"));
  const double reflectance = std::stod(asphalt.substr(asphalt.find(said) + said.size()));
  EXPECT_GT(reflectance, 0.02);
  EXPECT_LT(reflectance, 0.3);
  EXPECT_THAT(materials["shopfront"], HasSubstr("glass, 0.006 m | "));
  for (const auto& [name, line] : materials) EXPECT_THAT(line, testing::Not(HasSubstr("0.000 m"))) << name;
}

// ------------------------------------------------------------------------------------------------- bad input

void expect_user_error(const Outcome& outcome, const std::string& part) {
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("greatx: error: "));
  EXPECT_THAT(outcome.err, HasSubstr(part));
  EXPECT_EQ(outcome.out, "");
}

TEST_F(Cli, FaultyScenarios) {
  const auto fails = [&](const std::string& from, const std::string& to, const std::string& part) {
    expect_user_error(greatx(fmt::format("generate {} -o {}", changed(from, to), path("bad"))), part);
    EXPECT_FALSE(fs::exists(folder_ / "bad")) << "nothing is begun: " << part;
  };
  expect_user_error(greatx("generate " + path("absent.yaml")), "absent.yaml");
  fails("ticks: 6", "ticks: [", "changed.yaml:");
  fails("seed: 3", "sead: 3", "changed.yaml:3: sead");
  fails("ticks: 6", "ticks: six", "changed.yaml:4: ticks");
  fails("rate_hz: 5", "rate_hz: -5", "rate_hz");
  fails("rate_hz: 5", "rate_hz: 11", "rate_hz");
  fails("max_depth: 2", "carrier_hz: 500e9",
        "changed.yaml:20: channels[0].carrier_hz: channel 'csi': material ");
  fails("[uav/antenna]", "[uav/antena]", "uav/antena");
  fails("\nchannels:", "\neffects: {reflexion: on}\nchannels:", "reflexion");
}

TEST_F(Cli, ATerminalObeysNoNameAndJsonHoldsNoOtherBytes) {
  // Names of nodes, meshes and materials hold escapes, which come into an error, into notes and into a table.
  const std::string gltf = R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], )"
                           R"("nodes": [{"mesh": 0, "name": "n\u001b[2J"}],
    "materials": [{"name": "@\u001b]0;x\u0007\u009b31m"}],
    "meshes": [{"name": "m\u001b[31m", "primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36,
    "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  const auto named = [&](const std::string& material) {
    std::string text = gltf;
    return text.replace(text.find('@'), 1, material);
  };
  write("good.gltf", named("itu_concrete"));
  write("bad.gltf", named("unobtainium"));
  const Outcome good = greatx("scene info " + path("good.gltf") + " --optical-only"),
                bad = greatx("scene info " + path("bad.gltf"));
  EXPECT_EQ(good.code, 0) << good.err;
  EXPECT_EQ(bad.code, 1);
  for (const Outcome& outcome : {good, bad})
    for (const char forbidden : {'\x1b', '\x07', '\x9b'}) {
      EXPECT_EQ(outcome.out.find(forbidden), std::string::npos);
      EXPECT_EQ(outcome.err.find(forbidden), std::string::npos);
    }
  EXPECT_THAT(good.out, HasSubstr("itu_concrete\\u001b]0;x\\u0007\\u009b31m"));
  EXPECT_THAT(bad.err, HasSubstr("m\\u001b[31m"));
  // The name of this folder is not UTF-8.
  const Outcome set =
      greatx(fmt::format("generate {} --json -o {}", changed("seed: 3", "seed: 4"), path("s\xff")));
  ASSERT_EQ(set.code, 0) << set.err;
  EXPECT_EQ(nlohmann::json::parse(set.out)["output"], path("s\uFFFD"));
}

TEST_F(Cli, FaultySceneFiles) {
  const auto with = [&](const std::string& file) {
    return greatx(fmt::format("explain {}", changed("scene: {generate: {kind: city, seed: 3, size_m: 100}}",
                                                    "scene: {file: " + file + "}")));
  };
  expect_user_error(with("absent.glb"), "absent.glb");
  write("torn.glb", "glTF");
  expect_user_error(with("torn.glb"), "torn.glb");
  ASSERT_EQ(greatx(fmt::format("scene mast -o {}", path("mast.glb"))).code, 0);
  fs::resize_file(folder_ / "mast.glb", fs::file_size(folder_ / "mast.glb") / 2);
  expect_user_error(with("mast.glb"), "mast.glb");
  // The file refers to a buffer outside its folder, and has a material that radio does not know.
  const std::string gltf =
      R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "materials": [{"name": "unobtainium"}],
    "meshes": [{"name": "wall", "primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "@"}]})";
  const std::string inside =
      "data:application/octet-stream;base64,"
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";  // (0,0,0), (1,0,0), (0,1,0)
  const auto with_buffer = [&](const std::string& uri) {
    std::string text = gltf;
    write("wall.gltf", text.replace(text.find('@'), 1, uri));
    return with("wall.gltf");
  };
  expect_user_error(with_buffer("../secret.bin"), "wall.gltf: buffer 0");
  expect_user_error(with_buffer(inside), "\"unobtainium\": { itu: ");
}

TEST_F(Cli, UnwritableOutput) {
  write("file", "not a folder");
  expect_user_error(generate("file/out", "-q"), "file/out");
}

/// Fills a real disk: 120 KiB of memory, mounted in a namespace of its own.
TEST_F(Cli, AFullDiskIsAClearErrorAndResumable) {
  fs::create_directory(folder_ / "disk");
  write("run.sh",
        fmt::format("mount -t tmpfs -o size=120k none {0}/disk || exit 77\n"
                    "{1} generate {0}/small.yaml -o {0}/disk/a -q && exit 3\n"
                    "test $? = 1 || exit 4\n"
                    "mount -o remount,size=8m {0}/disk\n"
                    "{1} generate {0}/small.yaml -o {0}/disk/a -q --resume && cp -r {0}/disk/a {0}/a\n",
                    folder_.string(), GREATX_PROGRAM));
  const std::string log = path("log");
  const int status = std::system(
      fmt::format("unshare --map-root-user --mount /bin/sh {} 2>{}", path("run.sh"), log).c_str());
  const std::string said = read_file(log);
  if (WEXITSTATUS(status) == 77 || said.find("unshare") != std::string::npos)
    GTEST_SKIP() << "no mount namespaces here: " << said;
  ASSERT_EQ(WEXITSTATUS(status), 0) << said;
  EXPECT_THAT(said, HasSubstr("cannot be written: No space left on device"));
  EXPECT_THAT(said, HasSubstr("--resume finishes it"));
  EXPECT_EQ(greatx("verify " + path("a")).code, 0);
  ASSERT_EQ(generate("whole", "-q").code, 0);
  EXPECT_EQ(manifest("a"), manifest("whole"));
}

TEST_F(Cli, WithoutAVulkanDriver) {
  const std::string none = "VK_DRIVER_FILES=/nonexistent.json VK_ICD_FILENAMES=/nonexistent.json";
  expect_user_error(greatx("info", none), "no Vulkan driver found: install one");
  expect_user_error(generate("none", "-q", none), "no Vulkan driver found");
  expect_user_error(generate("none", "-q --device 'no such thing'"),
                    "no Vulkan device matches 'no such thing'");
}

}  // namespace
