// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs `greatx scene build` on small places, good and bad, and on the village of the examples.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// A house of some 12 x 11 m and an L of wings with a notch of some 0.4 m, in the southern hemisphere.
constexpr const char* houses = R"({"type": "FeatureCollection", "features": [
 {"type": "Feature", "id": "a", "properties": {"building": "house", "height": "7", "roof:shape": "gabled"},
  "geometry": {"type": "Polygon", "coordinates": [[[146.9480, -42.7310], [146.94815, -42.7310],
   [146.94815, -42.7309], [146.9480, -42.7309], [146.9480, -42.7310]]]}},
 {"type": "Feature", "id": "b", "properties": {"building": "office", "building:levels": "3"},
  "geometry": {"type": "Polygon", "coordinates": [[[146.9484, -42.7310], [146.9486, -42.7310],
   [146.9486, -42.7308], [146.9485, -42.7308], [146.9485, -42.730804], [146.9484, -42.730804],
   [146.9484, -42.7310]]]}}]})";

class SceneBuildCli : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  std::string place(const std::string& more = "") const {
    write("houses.geojson", houses);
    return write("place.yaml", "greatx_place: 1\nname: two\nmaps: [{file: houses.geojson}]\n" + more);
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  greatx::test::TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_.path();
};

TEST_F(SceneBuildCli, WithoutItsProgramItSaysWhatToInstall) {
  std::filesystem::copy_file(GREATX_PROGRAM, folder_ / "greatx");
  const std::string err = path("err.txt");
  const int status = std::system(
      fmt::format("{} scene build {} >{} 2>{}", path("greatx"), place(), path("out.txt"), err).c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(read_file(err),
              ::testing::AllOf(HasSubstr("greatx-places"), HasSubstr("libgdal-dev libproj-dev")));
}

TEST_F(SceneBuildCli, ASceneAndAReportAreWritten) {
  const Outcome outcome = greatx(fmt::format("scene build {} -o {} --quiet", place(), path("new/two.glb")));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("wrote " + path("new/two.glb")));
  EXPECT_THAT(outcome.out, HasSubstr("2 buildings of 2 parts with 0 courts"));
  EXPECT_THAT(outcome.out, HasSubstr("scene check: 0 faults"));
  const std::string markdown = read_file(path("new/two_report/report.md"));
  EXPECT_TRUE(markdown.starts_with("# two\n"));
  EXPECT_THAT(markdown, HasSubstr("**streets_unknown** (1, assumed)"));
  EXPECT_THAT(markdown, HasSubstr("| ground/base_built | asphalt_lot |"));
  EXPECT_TRUE(read_file(path("new/two_report/plan.png")).starts_with("\x89PNG"));
  const json report = json::parse(read_file(path("new/two_report/report.json")));
  EXPECT_EQ(report["buildings"]["count"], 2);
  EXPECT_EQ(report["buildings"]["heights"]["tag height"], 1);
  EXPECT_EQ(report["buildings"]["heights"]["storeys"], 1);
  EXPECT_EQ(report["scene_check"]["faults"], 0);
  EXPECT_EQ(report["scene_check"]["rays_out"], 0);
  EXPECT_NEAR(report["georeference"]["latitude_deg"].get<double>(), -42.7309, 1e-9);
  // What was built is a scene like any other one, and checks clean.
  const Outcome check = greatx(fmt::format("scene check {}", path("new/two.glb")));
  EXPECT_EQ(check.code, 0) << check.out;
  const Outcome info = greatx(fmt::format("scene info {}", path("new/two.glb")));
  EXPECT_THAT(info.out, HasSubstr("-42.7309"));
}

TEST_F(SceneBuildCli, JsonIsTheReport) {
  const Outcome outcome =
      greatx(fmt::format("scene build {} -o {} --report {} --json", place(), path("a.glb"), path("r")));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out), json::parse(read_file(path("r/report.json"))));
  EXPECT_FALSE(exists("a_report"));
}

TEST_F(SceneBuildCli, FilesAreFoundAmongTheAssets) {
  std::filesystem::create_directories(folder_ / "data");
  write("data/houses.geojson", houses);
  const std::string file = write("p.yaml", "greatx_place: 1\nmaps: [{file: houses.geojson}]\n");
  const Outcome without = greatx(fmt::format("scene build {} -o {}", file, path("p.glb")));
  EXPECT_EQ(without.code, 1);
  EXPECT_THAT(without.err, HasSubstr("houses.geojson"));
  const Outcome with =
      greatx(fmt::format("scene build {} --assets {} -o {} --quiet", file, path("data"), path("p.glb")));
  EXPECT_EQ(with.code, 0) << with.err;
}

TEST_F(SceneBuildCli, SimplifyTakesDetailWithinItsBound) {
  const auto build = [&](const std::string& options) {
    const Outcome outcome =
        greatx(fmt::format("scene build {} -o {} --json {}", place(), path("s.glb"), options));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out);
  };
  const json whole = build(""), less = build("--simplify 1");
  EXPECT_LT(whole["buildings"]["most_moved_m"], 0.05);
  EXPECT_GT(less["buildings"]["most_moved_m"], 0.1);
  EXPECT_LE(less["buildings"]["most_moved_m"], 1.0);
  EXPECT_LT(less["triangles"]["buildings"], whole["triangles"]["buildings"]);
  const Outcome beyond = greatx(fmt::format("scene build {} --simplify 11", place()));
  EXPECT_NE(beyond.code, 0);
}

TEST_F(SceneBuildCli, ThePrintedTableOfMaterialsIsOneThatCanBeRead) {
  const Outcome table = greatx("scene build --print-materials");
  ASSERT_EQ(table.code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("  roof/tiles: [roof_tiles, roof_tiles_old]\n"));
  write("materials.yaml", table.out);
  const std::string file = place("materials: materials.yaml\n");
  const Outcome own = greatx(fmt::format("scene build {} -o {} --quiet", file, path("own.glb")));
  ASSERT_EQ(own.code, 0) << own.err;
  ASSERT_EQ(greatx(fmt::format("scene build {} -o {} --quiet", place(), path("default.glb"))).code, 0);
  EXPECT_EQ(read_file(path("own.glb")), read_file(path("default.glb")));
}

TEST_F(SceneBuildCli, AnEntryOfTheTableIsReplaced) {
  write("materials.yaml", "greatx_place_materials: 1\nclasses:\n  ground/base_built: [grass]\n");
  const Outcome outcome = greatx(
      fmt::format("scene build {} -o {} --json", place("materials: materials.yaml\n"), path("green.glb")));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_EQ(report["materials"]["ground/base_built"], json::array({"grass"}));
}

TEST_F(SceneBuildCli, ErrorsNameFileAndFieldAndLeaveNothing) {
  const auto fails = [&](const std::string& arguments) {
    const Outcome outcome = greatx(fmt::format("scene build {} -o {}", arguments, path("x.glb")));
    EXPECT_EQ(outcome.code, 1) << outcome.out;
    EXPECT_FALSE(exists("x.glb"));
    EXPECT_FALSE(exists("x_report"));
    return outcome.err;
  };
  EXPECT_THAT(fails(""), HasSubstr("expected the file of a place, place.yaml, found nothing"));
  EXPECT_THAT(fails(path("none.yaml")), HasSubstr("none.yaml"));
  EXPECT_THAT(fails(place("area: {bounds_deg: [10, 10, 10.01, 10.01]}\n")), HasSubstr("houses.geojson"));
  EXPECT_THAT(fails(place("storeys: 3\n")), HasSubstr("place.yaml:4: storeys"));
  write("materials.yaml", "greatx_place_materials: 1\nclasses:\n  ground/lava: [asphalt]\n");
  EXPECT_THAT(fails(place("materials: materials.yaml\n")),
              ::testing::AllOf(HasSubstr("materials.yaml:3"), HasSubstr("ground/lava")));
  write("materials.yaml", "greatx_place_materials: 1\nclasses:\n  ground/road: [lava]\n");
  EXPECT_THAT(fails(place("materials: materials.yaml\n")),
              ::testing::AllOf(HasSubstr("materials.yaml:3"), HasSubstr("lava")));
  write("houses.geojson", "{\"type\": \"FeatureCollection\", \"features\": [");
  EXPECT_THAT(fails(write("place.yaml", "greatx_place: 1\nmaps: [{file: houses.geojson}]\n")),
              HasSubstr("houses.geojson"));
}

TEST_F(SceneBuildCli, AFileThatIsThereStaysWhenABuildFails) {
  write("x.glb", "what was there");
  const Outcome outcome = greatx(fmt::format("scene build {} -o {}", path("none.yaml"), path("x.glb")));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(read_file(path("x.glb")), "what was there");
}

}  // namespace
}  // namespace greatx::apps::test
