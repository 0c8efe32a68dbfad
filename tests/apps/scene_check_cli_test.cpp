// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs `greatx scene check` on files with and without faults.
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class SceneCheckCli : public ::testing::Test {
 protected:
  /// Writes a box of 10 x 6 x 8 m without its roof (y up) as x.gltf and x.bin.
  std::string write_open_box(const std::string& material) const {
    std::vector<float> corners;
    for (int i = 0; i < 8; ++i)
      corners.insert(corners.end(), {i & 1 ? 10.0f : 0.0f, i & 2 ? 6.0f : 0.0f, i & 4 ? 8.0f : 0.0f});
    const std::vector<uint16_t> indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 4, 6,
                                           0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4};
    std::ofstream bin(folder_ / "x.bin", std::ios::binary);
    bin.write(reinterpret_cast<const char*>(corners.data()), 96);
    bin.write(reinterpret_cast<const char*>(indices.data()), 60);
    const json primitive = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}};
    const json document = {
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"name", "house"}, {"mesh", 0}}}},
        {"meshes", {{{"primitives", json::array({primitive})}}}},
        {"materials", {{{"name", material}}}},
        {"buffers", {{{"uri", "x.bin"}, {"byteLength", 156}}}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 96}},
          {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 60}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"count", 8}, {"type", "VEC3"}},
          {{"bufferView", 1}, {"componentType", 5123}, {"count", 30}, {"type", "SCALAR"}}}}};
    std::ofstream(folder_ / "x.gltf") << document.dump();
    return (folder_ / "x.gltf").string();
  }
  greatx::test::TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_.path();
};

TEST_F(SceneCheckCli, AFaultIsPrintedDrawnAndWritten) {
  const std::string file = write_open_box("red_brick");
  const std::string json_file = (folder_ / "new" / "f.json").string(), png = (folder_ / "f.png").string();
  const Outcome outcome = greatx(fmt::format("scene check {} --json {} --png {}", file, json_file, png));
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out,
              HasSubstr(file + ": fault: 1 holes in solids (hole)\n    'house' (red_brick) at ("));
  EXPECT_THAT(outcome.out, HasSubstr("materials without radio properties (no_radio)\n    'red_brick', "));
  EXPECT_THAT(outcome.out, HasSubstr("perhaps { itu: brick, thickness_m: 0.24 }"));
  EXPECT_THAT(outcome.out, HasSubstr("  10 triangles, 5 facets, 1 objects, 1 materials\n"));
  EXPECT_THAT(outcome.out, HasSubstr(file + ": 3 faults, no doubts\n"));
  const json found = json::parse(read_file(json_file));
  EXPECT_EQ(found["faults"], 3);
  EXPECT_EQ(found["findings"][0]["kind"], "hole");
  EXPECT_EQ(found["findings"][0]["places"][0]["object"], "house");
  EXPECT_NEAR(found["findings"][0]["total"].get<double>(), 36.0, 0.02);
  EXPECT_EQ(found["findings"][0]["unit"], "m");
  EXPECT_TRUE(read_file(png).starts_with("\x89PNG"));
}

TEST_F(SceneCheckCli, OptionsLeaveFaultsOut) {
  const std::string file = write_open_box("red_brick");
  const std::string base = "scene check " + file;
  const Outcome optical = greatx(base + " --optical-only --rays 0 -q");
  EXPECT_EQ(optical.code, 1);
  EXPECT_THAT(optical.out, Not(HasSubstr("no_radio")));
  EXPECT_THAT(optical.out, Not(HasSubstr("ray_leak")));
  EXPECT_THAT(optical.out, Not(HasSubstr("triangles, ")));
  std::ofstream(folder_ / "radio.yaml") << "materials: {red_brick: {itu: brick}}\n";
  const Outcome sidecar = greatx(base + " --radio-materials " + (folder_ / "radio.yaml").string());
  EXPECT_THAT(sidecar.out, Not(HasSubstr("no_radio")));
  EXPECT_THAT(greatx(base + " --places 0").out, Not(HasSubstr("'house'")));
}

TEST_F(SceneCheckCli, DoubtsAloneSucceed) {
  const std::string room = (folder_ / "room.glb").string();
  ASSERT_EQ(greatx("scene room -o " + room).code, 0);
  const Outcome outcome = greatx("scene check " + room);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("(looks_inwards)"));
  EXPECT_THAT(outcome.out, HasSubstr(": no faults, 1 doubt\n"));
}

TEST_F(SceneCheckCli, ErrorsOfTheFileAndOfOptions) {
  std::ofstream(folder_ / "bad.gltf") << "{";
  const Outcome bad = greatx("scene check " + (folder_ / "bad.gltf").string());
  EXPECT_EQ(bad.code, 1);
  EXPECT_THAT(bad.err, HasSubstr("bad.gltf"));
  const std::string file = write_open_box("itu_brick");
  const Outcome negative = greatx("scene check " + file + " --weld -1");
  EXPECT_EQ(negative.code, 1);
  EXPECT_THAT(negative.err, HasSubstr("--weld"));
  const Outcome unwritable = greatx("scene check " + file + " --json /dev/null/x.json");
  EXPECT_EQ(unwritable.code, 1);
  EXPECT_THAT(unwritable.err, HasSubstr("/dev/null"));
}

}  // namespace
}  // namespace greatx::apps::test
