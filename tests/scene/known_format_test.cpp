// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/files/known_format.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/gltf/model.h"
#include "tests/support/temporary_folder.h"

namespace greatx::scene {
namespace {

using testing::HasSubstr;

std::optional<KnownFormat> format_of(const std::string& name, const std::string& text) {
  return recognised_format(name, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

std::string binary_stl() {
  std::string text(80 + 4 + 2 * 50, '\0');
  text[80] = 2;
  return text;
}

TEST(KnownFormat, IsToldByContent) {
  const std::pair<std::string, const char*> cases[] = {
      {"BLENDER-v304", "a Blender file"},
      {"Kaydara FBX Binary  \0", "an FBX file"},
      {"; FBX 7.3.0 project file\n", "an FBX file"},
      {"# made by hand\nmtllib a.mtl\nv 0 0 0\n", "a Wavefront OBJ file"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a Wavefront OBJ file"},
      {"solid cube\nfacet normal 0 0 1\n", "an STL file"},
      {binary_stl(), "an STL file"},
      {"ply\nformat ascii 1.0\n", "a PLY file"},
      {"<?xml version=\"1.0\"?>\n<COLLADA version=\"1.4\">", "a COLLADA file"},
      {"<?xml version=\"1.0\"?>\n<core:CityModel>", "a CityGML file"},
      {"<scene version=\"3.0.0\">", "a scene of Mitsuba or Sionna RT"},
      {"<?xml version='1.0'?><osm version=\"0.6\">", "a map"},
      {R"({"type": "CityJSON", "version": "2.0"})", "a map"},
      {R"({"type": "FeatureCollection", "features": []})", "a map"},
      {std::string("II*\0", 4), "a raster"},
      {std::string("LASF\0\0", 6), "a point cloud"},
      {"# .PCD v0.7\n", "a point cloud"},
      {"PXR-USDC", "a USD file"},
      {"#usda 1.0\n", "a USD file"},
      {"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));", "an IFC file"},
      {"# a run\ngreatx: 1\nname: x\n", "a scenario of greatx"},
      {"greatx_campaign: 1\n", "a campaign of greatx"},
      {"greatx_place: 1\n", "a place of greatx"},
      {"glTF\2\0\0\0", "a glTF scene"},
      {R"({"asset": {"version": "2.0"}})", "a glTF scene"},
  };
  for (const auto& [text, name] : cases) {
    const std::optional<KnownFormat> found = format_of("scene.bin", text);
    ASSERT_TRUE(found.has_value()) << text;
    EXPECT_EQ(found->name, name) << text;
    EXPECT_NE(found->way, "") << text;
    EXPECT_EQ(found->is_gltf, found->name == "a glTF scene");
  }
  EXPECT_FALSE(format_of("scene.bin", "").has_value());
  EXPECT_FALSE(format_of("scene.bin", "hello").has_value());
}

TEST(KnownFormat, IsToldByTheExtensionElse) {
  for (const auto& [name, format] : {std::pair("a.blend", "a Blender file"),  // compressed
                                     {"a.LAZ", "a point cloud"},
                                     {"a.usdz", "a USD file"},
                                     {"a.osm.pbf", "a map"},
                                     {"a.zip", "an archive"}}) {
    const std::optional<KnownFormat> found = format_of(name, "\x28\xb5\x2f\xfd");
    ASSERT_TRUE(found.has_value()) << name;
    EXPECT_EQ(found->name, format);
  }
  EXPECT_FALSE(format_of("a", "?").has_value());
  EXPECT_EQ(format_of("a.ply", "glTF")->name, "a glTF scene") << "the content goes first";
}

TEST(KnownFormat, TheWayNamesTheFile) {
  EXPECT_THAT(format_of("/x/house.obj", "v 0 0 0\nf 1 1 1\n")->way,
              HasSubstr("`assimp export house.obj house.glb -fglb2`"));
}

/// Expects that load_model() refuses a file and says, after its path, what it is.
void expect_no_model(const std::string& name, const std::string& content, const std::string& words) {
  const greatx::test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / name;
  std::ofstream(file) << content;
  try {
    load_model(file, {});
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(),
                testing::StartsWith(file.string() + ": expected glTF 2.0 (.glb, .gltf), found a " + words));
  }
}

TEST(KnownFormat, AModelThatIsNoneSaysWhatItIs) {
  expect_no_model("house.blend", "BLENDER-v304RENDH", "Blender file; Blender exports glTF 2.0");
  expect_no_model("notes.md", "# Notes\n",
                  "format that greatx does not know; greatx reads glTF, imports scenes of Mitsuba 3");
}

}  // namespace
}  // namespace greatx::scene
