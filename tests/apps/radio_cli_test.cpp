// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests faulty and doubtful input to radio as a user meets it, and the text of `greatx explain` about a
// channel.
#include <cstdint>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using greatx::apps::test::greatx;
using greatx::apps::test::Outcome;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A house of 10 x 10 x 10 m with a corner at (20, -5, 0), a base station beside it and a terminal in front
/// of it.
constexpr const char* radio_scenario = R"(greatx: 1
name: house
ticks: 2
tick_rate_hz: 10
scene:
  radio_materials: radio.yaml
  objects: [{name: house, file: box.gltf, scale: 10, position_m: [20, -5, 0]}]
nodes:
  - name: bs
    trajectory: {type: static, position_m: [0, 0, 5]}
    sensors: [{name: panel, type: antenna}]
  - name: ue
    trajectory: {type: static, position_m: [10, 3, 1.5]}
    sensors: [{name: antenna, type: antenna}]
channels:
  - {name: csi, tx: bs/panel, rx: [ue/antenna], rate_hz: 10, subcarriers: 16, )"
                                       R"(bandwidth_hz: 20e6, max_depth: 2}
)";
constexpr const char* radio = R"(materials:
  plaster:
    itu: concrete
    thickness_m: 0.2
    scattering_coefficient: 0.3
)";

class RadioCli : public testing::Test {
 protected:
  void SetUp() override {
    write_box();
    write("radio.yaml", radio);
    write("house.yaml", radio_scenario);
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  /// Writes `text` with one piece replaced to a file.
  void change(const std::string& name, std::string text, const std::string& from,
              const std::string& to) const {
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(name, text.replace(at, from.size(), to));
  }
  /// Writes the unit cube in glTF's axes (y up) with its normals outwards.
  void write_box() const {
    std::string bytes;
    const auto put = [&](const auto& value) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (int corner = 0; corner < 8; ++corner)
      for (const int axis : {0, 2, 1}) {
        const float unit = static_cast<float>((corner >> axis) & 1);
        put(axis == 1 ? -unit : unit);  // (x, y, z) of the world is (x, z, -y) in glTF
      }
    // clang-format off
    const uint16_t indices[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    // clang-format on
    for (const uint16_t index : indices) put(index);
    write("box.bin", bytes);
    write("box.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0, "name": "walls"}], "materials": [{"name": "plaster"}],
      "meshes": [{"name": "walls", )"
                      R"("primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}],
      "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
      "buffers": [{"byteLength": 168, "uri": "box.bin"}]})");
  }
  Outcome run(const std::string& command, const std::string& more = "") const {
    return greatx(fmt::format("{} {} {}", command, path("house.yaml"), more));
  }
  void fails(const std::string& what, const std::vector<std::string>& parts) const {
    for (const char* command : {"explain", "paths", "generate"}) {
      const Outcome outcome =
          run(command, std::string(command) == "generate" ? "-q -o " + path("out") : std::string());
      EXPECT_EQ(outcome.code, 1) << command << ", " << what << ": " << outcome.out;
      for (const std::string& part : parts)
        EXPECT_THAT(outcome.err, HasSubstr(part)) << command << ", " << what;
      EXPECT_EQ(outcome.out, "") << command << ", " << what;
      EXPECT_FALSE(fs::exists(folder_ / "out")) << what;
    }
  }
  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(RadioCli, TheSceneOfTheseTestsIsSound) {
  const Outcome outcome = run("paths", "--json --validation");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_EQ(result["receivers"][0]["paths"].size(), 2u) << "straight, and by the house";
  EXPECT_EQ(result["counters"]["ends_inside_solids"], 0);
  EXPECT_THAT(outcome.err, Not(HasSubstr("warning")));
}

TEST_F(RadioCli, FrequenciesOutsideOfAMaterial) {
  change("house.yaml", radio_scenario, "max_depth: 2", "carrier_hz: 105e9");
  fails("gap", {"house.yaml:", "channels[0].carrier_hz", "channel 'csi'", "material 'plaster'", "105 GHz",
                "1 to 100 GHz"});
  change("radio.yaml", radio, "itu: concrete", "itu: concrete\n    extrapolate: true");
  EXPECT_EQ(run("explain").code, 0) << "asked for";
}

/// Half-spaces of concrete with windows: the terminal is in the house, behind the first wall.
TEST_F(RadioCli, WindowsLetWavesIntoAHouseOfThickWalls) {
  const auto glazed = [&](const char* share, const char* itu = "glass") {
    change("radio.yaml", radio, "thickness_m: 0.2",
           fmt::format("windows: {{share: {}, layers: [{{itu: {}, thickness_m: 0.006}}]}}", share, itu));
  };
  change("house.yaml", radio_scenario, "[10, 3, 1.5]", "[25, 3, 1.5]");
  glazed("0");
  EXPECT_THAT(run("explain").out, HasSubstr("half-spaces (no thickness given) without windows"));
  const Outcome none = run("paths", "--json");
  ASSERT_EQ(none.code, 0) << none.err;
  EXPECT_EQ(json::parse(none.out)["receivers"][0]["paths"].size(), 0u);
  glazed("0.25");
  EXPECT_THAT(run("explain").out, HasSubstr("1 materials let waves pass"));
  const Outcome listed = run("paths", "--json");
  ASSERT_EQ(listed.code, 0) << listed.err;
  EXPECT_GE(json::parse(listed.out)["receivers"][0]["paths"].size(), 1u);
  const Outcome info =
      greatx(fmt::format("scene info {} --radio-materials {}", path("box.gltf"), path("radio.yaml")));
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_THAT(info.out,
              HasSubstr("concrete, half-space; windows on 25 % of its area: ITU-R P.2040-4 Table 3, "
                        "glass, 0.006 m"));
  for (const char* value : {"1.01", "-0.1", "nan", "half"}) {
    glazed(value);
    fails(value, {"radio.yaml:4", "materials.plaster.windows.share", "from 0 to 1"});
  }
  glazed("0.25", "glazing");
  fails("glazing", {"radio.yaml:4", "materials.plaster.windows.layers[0].itu", "'glazing'"});
}

TEST_F(RadioCli, FrequenciesOutsideOfTheWindowsMaterial) {
  change("radio.yaml", radio, "thickness_m: 0.2",
         "windows: {share: 0.2, layers: [{itu: clear_acrylic, thickness_m: 0.006}]}");
  fails("acrylic",
        {"house.yaml:", "channel 'csi'", "material 'plaster (windows)'", "clear_acrylic", "110 to 330 GHz"});
  change("radio.yaml", radio, "thickness_m: 0.2",
         "extrapolate: true\n    windows: {share: 0.2, layers: [{itu: clear_acrylic, thickness_m: 0.006}]}");
  EXPECT_EQ(run("explain").code, 0) << "asked for, with the wall";
}

TEST_F(RadioCli, ThicknessesAndScatteringThatCannotBe) {
  for (const char* value : {"0", "-0.1", "nan", "thick"}) {
    change("radio.yaml", radio, "thickness_m: 0.2", fmt::format("thickness_m: {}", value));
    fails(value, {"radio.yaml:4", "materials.plaster.thickness_m"});
  }
  for (const char* value : {"1.01", "-0.1", "nan"}) {
    change("radio.yaml", radio, "scattering_coefficient: 0.3",
           fmt::format("scattering_coefficient: {}", value));
    fails(value, {"radio.yaml:5", "materials.plaster.scattering_coefficient", "from 0 to 1"});
  }
}

TEST_F(RadioCli, ATransmitterInsideASolidIsNamed) {
  change("house.yaml", radio_scenario, "[0, 0, 5]", "[25, 0, 5]");
  const Outcome outcome = run("paths", "--json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("warning"), HasSubstr("channel 'csi', tick 0: bs/panel lies inside 'house"),
                    HasSubstr("material plaster")));
  EXPECT_EQ(json::parse(outcome.out)["counters"]["ends_inside_solids"], 1);
  const Outcome made = run("generate", "--json -o " + path("out"));
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("bs/panel lies inside 'house"));
  EXPECT_EQ(json::parse(made.out)["counters"]["csi.ends_inside_solids"], 2) << "at both ticks";
}

TEST_F(RadioCli, EndsExactlyOnASurfaceAreNamed) {
  change("house.yaml", radio_scenario, "[0, 0, 5]", "[20, 0, 5]");
  const Outcome outcome = run("paths", "--json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("warning"), HasSubstr("bs/panel lies on a surface of 'house"),
                                 HasSubstr("plaster")));
  const json result = json::parse(outcome.out);
  EXPECT_EQ(result["counters"]["ends_inside_solids"], 0);
  EXPECT_TRUE(result["receivers"][0]["line_of_sight"]) << "its own surface does not hide it";
  // The surface does not reflect either. The remaining path goes through to the far wall and back.
  for (const json& found : result["receivers"][0]["paths"]) EXPECT_NE(found["chain"], "R");
  change("house.yaml", radio_scenario, "[10, 3, 1.5]", "[20, 3, 1.5]");
  EXPECT_THAT(run("paths").err, HasSubstr("ue/antenna lies on a surface of 'house"));
}

TEST_F(RadioCli, PathsBeyondTheBoundAreCountedAndSaid) {
  change("house.yaml", radio_scenario, "max_depth: 2", "max_depth: 2, max_paths: 5, scattering_patch_m: 1");
  write("house.yaml", greatx::apps::test::read_file(folder_ / "house.yaml") + "effects: {scattering: on}\n");
  const Outcome outcome = run("paths", "--json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("warning"), HasSubstr("channel 'csi'"),
                                 HasSubstr("geometric paths beyond max_paths (5) were left out")));
  const json result = json::parse(outcome.out);
  EXPECT_EQ(result["counters"]["geometric_paths"], 5);
  EXPECT_GT(result["counters"]["path_overflow"], 100);
  const std::string left_out =
      fmt::format("{} geometric paths are left out, beyond the 5 of a link (max_paths)",
                  result["counters"]["path_overflow"].get<uint64_t>());
  EXPECT_THAT(result["guarantee"].get<std::string>(), HasSubstr(left_out));
  EXPECT_THAT(run("paths").out, HasSubstr(left_out));
  const Outcome made = run("generate", "--json -o " + path("bounded"));
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("beyond max_paths (5)"));
  const json summary = json::parse(made.out);
  EXPECT_GT(summary["counters"]["csi.path_overflow"], 200);
  EXPECT_THAT(summary["notes"]["csi.guarantee"].get<std::string>(),
              HasSubstr("geometric paths are left out"));
  change("house.yaml", radio_scenario, "max_depth: 2", "max_paths: 0");
  fails("no paths", {"house.yaml:", "channels[0].max_paths", "'0'"});
}

TEST_F(RadioCli, ScatteringsBeyondTheBudgetAreDrawnAndSaid) {
  const auto with_budget = [&](const std::string& budget) {
    change("house.yaml", radio_scenario, "max_depth: 2",
           "max_depth: 2, scattering_patch_m: 0.5, scattering_budget: " + budget);
    write("house.yaml",
          greatx::apps::test::read_file(folder_ / "house.yaml") + "effects: {scattering: on}\n");
  };
  with_budget("30");
  const Outcome outcome = run("paths", "--json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json drawn = json::parse(outcome.out);
  EXPECT_THAT(drawn["scattering"].get<std::string>(),
              HasSubstr("of more than 30 scatterings of a link, 30 at most are traced"));
  EXPECT_EQ(drawn["counters"]["path_overflow"], 0);
  EXPECT_GT(drawn["receivers"][0]["gain_deviation"].get<double>(), 0.0);
  EXPECT_THAT(run("paths").out, HasSubstr("drawn scatterings: "));
  EXPECT_THAT(run("explain").out, HasSubstr("of more than 30 scatterings"));
  with_budget("0");
  const json all = json::parse(run("paths", "--json").out);
  EXPECT_FALSE(all.contains("scattering"));
  EXPECT_EQ(all["receivers"][0]["gain_deviation"], 0.0);
  EXPECT_GT(all["counters"]["geometric_paths"], 500);
  EXPECT_LE(drawn["counters"]["geometric_paths"], 60);
  for (const std::string wrong : {"-1", "2.5", "many", "1073741825"}) {
    with_budget(wrong);
    fails(wrong, {"house.yaml:", "channels[0].scattering_budget", "'" + wrong + "'"});
  }
}

TEST_F(RadioCli, PathsWithTwoBendsAreDrawnAndSaid) {
  const auto with = [&](const std::string& options) {
    change("house.yaml", radio_scenario, "max_depth: 2", "max_depth: 2, scattering_patch_m: 0.5, " + options);
    write("house.yaml", greatx::apps::test::read_file(folder_ / "house.yaml") +
                            "effects: {scattering: on, diffraction: on}\n");
  };
  with("scattering_budget: 200");
  EXPECT_FALSE(json::parse(run("paths", "--json").out).contains("scattering_twice"));
  with("scattering_budget: 200, max_scatterings: 2, scattering_beside_diffraction: true");
  const Outcome outcome = run("paths", "--json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json drawn = json::parse(outcome.out);
  EXPECT_THAT(drawn["scattering_twice"].get<std::string>(),
              HasSubstr("two patches, or an edge and a patch in either order"));
  EXPECT_THAT(run("explain").out, HasSubstr("paths over two patches"));
  for (const std::string option : {"max_scatterings: 2", "scattering_beside_diffraction: true"}) {
    with("scattering_budget: 0, " + option);
    fails(option,
          {"house.yaml:", "channels[0]." + option.substr(0, option.find(':')), "with scattering_budget: 0"});
  }
  with("max_scatterings: 3");
  fails("three", {"house.yaml:", "channels[0].max_scatterings", "'3'"});
}

// Transmissions have a bound of their own, which a path of greater depth keeps.
TEST_F(RadioCli, TheDeepestPathsRun) {
  change("house.yaml", radio_scenario, "max_depth: 2", "max_depth: 16");
  const Outcome outcome = run("paths", "--json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(json::parse(outcome.out)["guarantee"].get<std::string>(),
              AllOf(HasSubstr("up to 16 reflections"), HasSubstr("walls: at most 8")));
  change("house.yaml", radio_scenario, "max_depth: 2", "max_depth: 17");
  fails("too deep", {"house.yaml:", "channels[0].max_depth", "'17'"});
  change("house.yaml", radio_scenario, "max_depth: 2", "max_transmissions: 9");
  fails("too many walls", {"house.yaml:", "channels[0].max_transmissions", "'9'"});
}

TEST_F(RadioCli, PatchesTooSmallToBeCutAreRefused) {
  const auto with_patches_of = [&](const std::string& side) {
    change("house.yaml", radio_scenario, "max_depth: 2", "scattering_patch_m: " + side);
    write("house.yaml",
          greatx::apps::test::read_file(folder_ / "house.yaml") + "effects: {scattering: on}\n");
  };
  for (const std::string side : {"1e-300", "1e-12"}) {
    with_patches_of(side);
    fails(side, {"house.yaml:", "channels[0].scattering_patch_m", "'" + side + "'"});
  }
  with_patches_of("0.001");  // within the range, but too small for a house of this size
  for (const std::string command : {"paths", "generate"}) {
    const Outcome outcome = run(command, command == "generate" ? "-o " + path("patches") : "");
    EXPECT_EQ(outcome.code, 1) << command;
    EXPECT_THAT(outcome.err, HasSubstr("scattering_patch_m: 0.001 m makes more than 10000000 patches"));
  }
}

TEST_F(RadioCli, ReceiverListsWithFaults) {
  const auto refuse = [&](const std::string& text, const std::string& part) {
    write("rx.csv", text);
    const Outcome outcome = run("paths", "--receivers " + path("rx.csv"));
    EXPECT_EQ(outcome.code, 1) << text;
    EXPECT_THAT(outcome.err, HasSubstr(part)) << text;
    EXPECT_EQ(outcome.out, "") << text;
  };
  refuse("x,y,z\n1,2,3\n4,,6\n", "rx.csv:3:3: y");
  refuse("1,2,3\n4,5\n", "rx.csv:2");
  refuse("1,2,3\n4,5,6,7\n", "rx.csv:2");
  refuse("1,2,nan\n", "rx.csv:1:5: z: expected a finite number, found 'nan'");
  refuse("1,2,3\n1,-inf,3\n", "rx.csv:2:3: y: expected a finite number, found '-inf'");
  refuse("1,2,3\n1,1e999,3\n", "rx.csv:2:3: y");
  refuse("1,2,3\n1,2 m,3\n", "rx.csv:2:3: y");
}

TEST_F(RadioCli, EffectsThatAreNoneAndWeatherThatIsNone) {
  const std::string text = radio_scenario;
  write("house.yaml", text + "effects: {difraction: on}\n");
  fails("effect",
        {"house.yaml", "effects: 'difraction' is no effect (did you mean 'diffraction'?); expected one of",
         "diffraction"});
  write("house.yaml", text + "effects: {channel: off}\n");
  fails("fixed", {"house.yaml", "effects.channel: cannot be switched"});
  write("house.yaml", text + "environment: {temperature_k: 20}\n");
  fails("cold", {"house.yaml:17: environment.temperature_k", "found '20'"});
  write("house.yaml", text + "environment: {rain_mm_h: -1}\n");
  fails("dry", {"house.yaml:17: environment.rain_mm_h", "found '-1'"});
}

TEST_F(RadioCli, ExplainSaysHowCandidatesAreFoundAndWhatThatGuarantees) {
  const auto explained = [&](const std::string& channel) {
    change("house.yaml", radio_scenario, "max_depth: 2", channel);
    const Outcome outcome = run("explain", "--json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const json notes = json::parse(outcome.out)["channels"]["csi"];
    // The text form says the same.
    const std::string words = run("explain").out;
    EXPECT_THAT(words, HasSubstr("channel 'csi', candidates:"));
    for (const auto& [name, text] : notes.items())
      EXPECT_THAT(words, HasSubstr(text.get<std::string>())) << name;
    return notes;
  };
  const json beams = explained("max_depth: 2");
  EXPECT_EQ(beams["search"], "once, from the transmitter");
  EXPECT_THAT(beams["guarantee"].get<std::string>(),
              AllOf(HasSubstr("beams: no facet sequence is left out"), HasSubstr("up to 2 reflections")));
  EXPECT_THAT(explained("search: every_tick")["search"].get<std::string>(), HasSubstr("every tick"));
  const json rays = explained("candidates: rays, rays: 10000");
  EXPECT_THAT(rays["guarantee"].get<std::string>(),
              AllOf(HasSubstr("10000 rays"), HasSubstr("may be missed")));
  EXPECT_EQ(explained("max_depth: 0")["search"], "none");
  // The run says afterwards what `explain` says before.
  change("house.yaml", radio_scenario, "max_depth: 2", "max_depth: 2");
  const json summary = json::parse(run("generate", "--json -o " + path("out")).out);
  EXPECT_EQ(summary["notes"]["csi.guarantee"], beams["guarantee"]);
}

}  // namespace
