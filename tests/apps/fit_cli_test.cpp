// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests fits of materials by `greatx calibrate` from the command line. The measurements are radio maps of the
// embedded room with other materials.
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <sched.h>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace {

namespace fs = std::filesystem;
using greatx::apps::test::greatx;
using greatx::apps::test::Outcome;
using greatx::apps::test::read_file;
using nlohmann::json;
using testing::HasSubstr;

constexpr const char* scenario = R"(greatx: 1
name: room
seed: 5
ticks: 1
tick_rate_hz: 10
scene: {generate: {kind: room}, radio_materials: RADIO}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [-4.7, 2.9, 2.8], rotation_deg: [-30, 20, 0]}
    sensors: [{name: antenna, type: antenna, polarization: vh}]
  - name: ue
    trajectory: {type: static, position_m: [0, 0, 1.5]}
    sensors: [{name: antenna, type: antenna}]
channels:
  - {name: csi, tx: bs/antenna, rx: [ue/antenna], rate_hz: 10, carrier_hz: 3.5e9, bandwidth_hz: 100e6,
      subcarriers: 64, max_depth: 2}
)";

constexpr const char* description = R"(greatx_fit: 1
scenario: before.yaml
measurements:
  - {name: walk, file: walk.csv, quantity: power_db, columns: {value: gain}}
unknown:
  scale_db: {bounds: [-50, 50]}
parameters:
  - {material: blind_plaster, property: permittivity, bounds: [2, 9]}
  - {material: concrete, property: permittivity, bounds: [2, 9]}
  - {material: shopfront, property: thickness, layer: 1, bounds: [0.004, 0.04],
     prior: {mean: 0.016, sigma: 0.001}}
seed: 4
starts: STARTS
)";

std::string with(std::string text, const std::string& what, const std::string& instead) {
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), instead);
}

class FitCli : public testing::Test {
 protected:
  /// Makes the measurements once.
  static void SetUpTestSuite() {
    folder_ = new greatx::test::TemporaryFolder;
    // A wall of thick concrete that waves do not come through makes the power depend smoothly on it.
    write("before_radio.yaml",
          "materials:\n"
          "  # ours\n"
          "  blind_plaster: {relative_permittivity: 4, conductivity: 0.1}\n"
          "  concrete: {relative_permittivity: 5, conductivity: 0.1, thickness_m: 0.4}\n");
    write("truth_radio.yaml",
          "materials:\n"
          "  blind_plaster: {relative_permittivity: 6, conductivity: 0.1}\n"
          "  concrete: {relative_permittivity: 3.5, conductivity: 0.1, thickness_m: 0.4}\n");
    write("before.yaml", with(scenario, "RADIO", "before_radio.yaml"));
    write("truth.yaml", with(scenario, "RADIO", "truth_radio.yaml"));
    write("fit.yaml", with(description, "STARTS", "2"));
    const Outcome made =
        greatx(fmt::format("map {} -o {} --plane 1.5 --cell 1 --quantities path_gain --no-pictures -q",
                           path("truth.yaml"), path("truth")));
    ASSERT_EQ(made.code, 0) << made.err;
    std::vector<double> gains = numbers("truth/path_gain.npy");
    ASSERT_EQ(gains.size(), 96u);
    std::string csv = "x_m, y_m, z_m, gain\n# the room, every metre, 3 dB too strong\n";
    for (size_t i = 0; i < gains.size(); ++i)
      csv += fmt::format("{}, {}, 1.5, {:.4f}\n", -5.5 + static_cast<double>(i % 12),
                         -3.5 + static_cast<double>(i / 12), 10.0 * std::log10(gains[i]) + 3.0);
    write("walk.csv", csv);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static void write(const std::string& name, const std::string& text) { std::ofstream(path(name)) << text; }
  static std::string path(const std::string& name) { return (folder_->path() / name).string(); }
  static std::vector<double> numbers(const std::string& file) {
    const std::string bytes = read_file(path(file));
    std::vector<double> values((bytes.size() - 256) / sizeof(double));
    std::memcpy(values.data(), bytes.data() + 256, values.size() * sizeof(double));
    return values;
  }
  static Outcome calibrate(const std::string& arguments, const std::string& before = "") {
    return greatx("calibrate " + arguments, before);
  }
  static std::map<std::string, std::string> files(const std::string& name) {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::directory_iterator(path(name)))
      all[entry.path().filename().string()] = read_file(entry.path());
    return all;
  }
  /// Runs a fit with another description, which fails; returns its message.
  static std::string refusal(const std::string& what, const std::string& instead) {
    write("bad.yaml", with(with(description, "STARTS", "1"), what, instead));
    const Outcome run = calibrate(fmt::format("{} -o {}", path("bad.yaml"), path("bad")));
    EXPECT_EQ(run.code, 1) << instead << run.err;
    EXPECT_FALSE(fs::exists(path("bad"))) << instead;
    return run.err;
  }
  static inline greatx::test::TemporaryFolder* folder_ = nullptr;
};

TEST_F(FitCli, FindsTheMaterialsAndAScenarioTakesThem) {
  const Outcome run = calibrate(fmt::format("{} -o {}", path("fit.yaml"), path("out")));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("wrote " + path("out")));
  EXPECT_THAT(run.out, HasSubstr(read_file(path("out/report.txt"))));
  EXPECT_THAT(run.out, HasSubstr("shopfront: thickness of layer 1"));
  std::vector<std::string> names;
  for (const auto& [name, bytes] : files("out")) names.push_back(name);
  EXPECT_THAT(names, testing::ElementsAre("correlation.png", "distributions_walk.png", "errors_walk.png",
                                          "fit.json", "materials.yaml", "positions.csv", "report.txt"));
  const json result = json::parse(read_file(path("out/fit.json")));
  const double truth[] = {6.0, 3.5, 0.016, 3.0}, within[] = {0.01, 0.01, 0.002, 0.01};
  for (size_t v = 0; v < 4; ++v)
    EXPECT_NEAR(result["variables"][v]["value"].get<double>(), truth[v], within[v]) << v;
  EXPECT_EQ(result["fitted_positions"], 72);
  EXPECT_EQ(result["held_out_positions"], 24);
  const json& walk = result["sets"][0];
  EXPECT_LT(walk["held_out"]["after"]["rms"], 0.01);
  EXPECT_GT(walk["held_out"]["before"]["rms"], 0.1);

  // The sidecar keeps what the old one says beside the fit, and gives the measured powers.
  const std::string sidecar = read_file(path("out/materials.yaml"));
  EXPECT_THAT(sidecar, HasSubstr("# ours"));
  EXPECT_THAT(sidecar, HasSubstr("#   concrete: permittivity: 3.5"));
  write("after.yaml", with(scenario, "RADIO", "out/materials.yaml"));
  ASSERT_EQ(greatx(fmt::format("map {} -o {} --plane 1.5 --cell 1 --quantities path_gain --no-pictures -q",
                               path("after.yaml"), path("after")))
                .code,
            0);
  const std::vector<double> expected = numbers("truth/path_gain.npy"), got = numbers("after/path_gain.npy");
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(got[i] / expected[i], 1.0, 0.002) << i;

  // Again: finished; without --resume refused; with another description refused.
  const std::string again = fmt::format("{} -o {}", path("fit.yaml"), path("out"));
  EXPECT_THAT(calibrate(again).err, HasSubstr("holds a finished fit: choose another folder"));
  EXPECT_THAT(calibrate(again + " --resume").out, HasSubstr("is already finished"));
  write("other.yaml", with(description, "STARTS", "3"));
  EXPECT_THAT(
      calibrate(fmt::format("{} -o {} --resume", path("other.yaml"), path("out"))).err,
      HasSubstr("holds a fit that asked for something else, which this one cannot resume: /fit: asked for"));
}

TEST_F(FitCli, AKilledFitGoesOnToTheSameBytes) {
  write("long.yaml", with(description, "STARTS", "30"));
  cpu_set_t all, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  CPU_ZERO(&one);
  for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++cpu)
    if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);  // one thread; the others have all
  const Outcome whole = calibrate(fmt::format("{} -o {} --no-pictures -q", path("long.yaml"), path("whole")));
  ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
  ASSERT_EQ(whole.code, 0) << whole.err;
  for (const char* signal : {"INT", "KILL"}) {
    const std::string out = path(std::string("stopped_") + signal);
    // Stops the fit once it has made some iterations.
    const std::string before = fmt::format(
        "( while ! grep -qs '.run.: [1-9]' {}/fit.part; do sleep 0.01; done; kill -{} \\$\\$ ) & ", out,
        signal);
    const Outcome stopped =
        calibrate(fmt::format("{} -o {} --no-pictures -q", path("long.yaml"), out), before);
    EXPECT_EQ(stopped.code, std::string(signal) == "INT" ? 130 : 128 + 9) << stopped.err;
    if (stopped.code == 130) {
      EXPECT_THAT(stopped.err, HasSubstr("the same command with --resume goes on"));
    }
    const Outcome refused = calibrate(fmt::format("{} -o {} -q", path("long.yaml"), out));
    EXPECT_THAT(refused.err,
                HasSubstr("holds an unfinished fit: choose another folder, or add --resume to go on"));
    const Outcome resumed =
        calibrate(fmt::format("{} -o {} --no-pictures --resume -q", path("long.yaml"), out));
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    for (const char* file : {"fit.json", "materials.yaml", "positions.csv", "report.txt"})
      EXPECT_EQ(read_file(out + "/" + file), read_file(path("whole") + "/" + file)) << file;
    EXPECT_FALSE(fs::exists(out + "/fit.part"));
  }
}

TEST_F(FitCli, EveryFaultHasItsMessage) {
  EXPECT_THAT(refusal("greatx_fit: 1\n", "greatx_fit: 2\n"),
              HasSubstr("bad.yaml:1: greatx_fit: expected 1, found '2'"));
  EXPECT_THAT(refusal("scenario: before.yaml\n", ""), HasSubstr("expected a scenario, found nothing"));
  EXPECT_THAT(refusal("scenario: before.yaml", "scenario: nowhere.yaml"), HasSubstr("no such scenario"));
  EXPECT_THAT(refusal("seed: 4", "speed: 4"), HasSubstr("bad.yaml:12: speed: expected a known key"));
  EXPECT_THAT(refusal("file: walk.csv", "file: run.csv"),
              HasSubstr("measurements[0].file: expected an existing file"));
  EXPECT_THAT(refusal("quantity: power_db", "quantity: power"),
              HasSubstr("measurements[0].quantity: expected one of power_db"));
  EXPECT_THAT(
      refusal("quantity: power_db", "quantity: cir"),
      HasSubstr("measurements[0].file: expected positions and values (.npy) for a cir, found a table"));
  EXPECT_THAT(refusal("quantity: power_db", "quantity: power_db, subcarriers: 8"),
              HasSubstr("measurements[0].subcarriers: expected average: coherent beside it"));
  EXPECT_THAT(refusal("quantity: power_db", "quantity: power_db, transmitter: bs/antena"),
              HasSubstr("measurements[0].transmitter: expected bs/antenna, found 'bs/antena' (did you mean"));
  EXPECT_THAT(
      refusal("{value: gain}", "{value: power}"),
      HasSubstr("walk.csv:1:1: value: expected a column 'power' in the header, found x_m, y_m, z_m, gain"));
  EXPECT_THAT(refusal("[-50, 50]", "[50, -50]"),
              HasSubstr("unknown.scale_db.bounds: expected a least value below the greatest"));
  EXPECT_THAT(refusal("scale_db:", "clock_s:"), HasSubstr("expected a number from -0.01 to 0.01"));
  EXPECT_THAT(refusal("scale_db: {bounds: [-50, 50]}", "clock_s: {bounds: [-1e-9, 1e-9]}"),
              HasSubstr("bad.yaml:6: clock_s: expected a measurement that depends on it, found none"));
  EXPECT_THAT(
      refusal("material: concrete", "material: concrte"),
      HasSubstr(
          "bad.yaml:9: material: expected one of the scene's, found 'concrte' (did you mean 'concrete'?)"));
  EXPECT_THAT(refusal("property: thickness, layer: 1", "property: roughness, layer: 1"),
              HasSubstr("parameters[2].layer: expected no layer for a property of the whole surface"));
  EXPECT_THAT(refusal("layer: 1", "layer: 3"),
              HasSubstr("layer: expected 0 to 2, a layer of 'shopfront', found 3"));
  EXPECT_THAT(refusal("bounds: [0.004, 0.04]", "bounds: [0.02, 0.04]"),
              HasSubstr("expected bounds around the start 0.016"));
  EXPECT_THAT(refusal("bounds: [0.004, 0.04]", "log: true, bounds: [0, 0.04]"),
              HasSubstr("parameters[2].bounds[0]: expected"));
  EXPECT_THAT(refusal("starts: 1", "starts: 0"),
              HasSubstr("bad.yaml:13: starts: expected an integer from 1 to 10000"));
  write("walk_bad.csv", "x_m, y_m, z_m, gain\n1, 2, 1.5, -60\n1, two, 1.5, -60\n");
  EXPECT_THAT(refusal("file: walk.csv", "file: walk_bad.csv"),
              HasSubstr("walk_bad.csv:3:4: y: expected a number from -1e8 to 1e8, found 'two'"));
  write("walk_bad.csv", "x_m, y_m, z_m, gain\n1, 2, 1.5\n");
  EXPECT_THAT(refusal("file: walk.csv", "file: walk_bad.csv"),
              HasSubstr("expected 4 values as in the header, found 3"));
  write("walk_bad.csv", "x_m, y_m, z_m, gain\n1, 2, 1.5, inf\n");
  EXPECT_THAT(refusal("file: walk.csv", "file: walk_bad.csv"),
              HasSubstr("value: expected a finite number, nan or nothing, found 'inf'"));
  write("walk_bad.csv", "x_m, y_m, z_m, gain\n");
  EXPECT_THAT(refusal("file: walk.csv", "file: walk_bad.csv"),
              HasSubstr("expected one measured position or more, found none"));
  write("not.npy", "nothing");
  EXPECT_THAT(refusal("file: walk.csv", "positions: not.npy, values: not.npy"),
              HasSubstr("measurements[0].columns: expected a file (CSV) beside it"));
  EXPECT_THAT(refusal("file: walk.csv, quantity: power_db, columns: {value: gain}",
                      "positions: not.npy, values: not.npy, quantity: power_db"),
              HasSubstr("not.npy"));
}

TEST_F(FitCli, ScenariosAndFitsAreToldApart) {
  const Outcome help = greatx("calibrate --help");
  EXPECT_THAT(help.out, HasSubstr("fit materials to measurements"));
  EXPECT_THAT(help.out, HasSubstr("settings for a scenario that gives errors"));
  EXPECT_THAT(calibrate(path("fit.yaml")).err, HasSubstr("-o: expected a folder for the result of the fit"));
  EXPECT_THAT(calibrate(fmt::format("{} -o {} --again", path("fit.yaml"), path("no"))).err,
              HasSubstr("--again: expected a scenario beside it, found the fit"));
  EXPECT_THAT(calibrate(path("before.yaml") + " --resume").err,
              HasSubstr("--resume: expected a fit (measurements) beside it, found the scenario"));
  EXPECT_THAT(calibrate(path("before.yaml")).err,
              HasSubstr("expected 'accuracy' or 'time_budget_ms_per_tick'"));
  EXPECT_THAT(greatx("generate " + path("fit.yaml") + " -o " + path("no")).err, HasSubstr("fit"));
}

}  // namespace
