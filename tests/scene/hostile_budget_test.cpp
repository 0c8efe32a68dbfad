// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks small files that ask for much memory or time. They are refused by name before memory is allocated,
// or are processed in a time that grows about linearly with the file. No test here measures time: a quadratic
// algorithm would exceed the time limit of the test run.
#include <cmath>

#include "core/budget.h"
#include "scene/build/build.h"
#include "scene/gltf/gltf_accessor.h"
#include "scene/gltf/gltf_file.h"
#include "tests/scene/gltf_writer.h"

namespace greatx::scene {
namespace {

using test::expect_user_error;
using test::GltfWriter;
using test::json;
using test::TemporaryFolder;

TEST(HostileBudget, ElementsThatNoByteStandsBehind) {
  // Each accessor is within the limit of one accessor, but a few dozen of them would take gigabytes.
  GltfWriter writer;
  json primitives = json::array();
  for (int i = 0; i < 24; ++i) {
    const int zeros =
        writer.append("accessors", {{"componentType", 5126}, {"count", 4194303}, {"type", "VEC3"}});
    primitives.push_back(
        {{"attributes", {{"POSITION", zeros}}}, {"material", i == 0 ? writer.itu_material() : 0}});
  }
  writer.root({{"name", "n"}, {"mesh", writer.mesh("zeros", primitives)}});
  expect_user_error([&] { writer.load(); },
                    {"test.glb: mesh 'zeros', primitive 5, POSITION, accessor 5: 4194303 elements",
                     "at most 256 MiB", "without a buffer view", "docs/limits.md", "288 MiB"});
}

TEST(HostileBudget, OneAccessorForThousandsOfPrimitivesCountsEachTime) {
  GltfWriter writer;
  const int positions = writer.vec3s(test::unit_quad());
  AssetFolder folder({});
  const GltfFile file = parse_gltf("test.glb", writer.glb(), folder);
  GeometryMemory memory;
  memory.all.plan("before", budget::model_geometry.most - 60);
  EXPECT_EQ(read_floats(file, positions, 3, "test.glb: mesh 'm', primitive 7", memory).size(), 12u);
  expect_user_error(
      [&] { read_floats(file, positions, 3, "test.glb: mesh 'm', primitive 8, POSITION", memory); },
      {"mesh 'm', primitive 8, POSITION, accessor 0: 4 elements", "at most 2 GiB",
       "the geometry of a model"});
}

TEST(HostileBudget, OneMeshPlacedTenThousandTimes) {
  GltfWriter writer;
  std::vector<vec3> positions;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < 3000; ++i) {
    const float x = static_cast<float>(i);
    for (const vec3& corner : {vec3(x, 0, 0), vec3(x, 1, 0), vec3(x, 0, 1)}) {
      indices.push_back(static_cast<uint32_t>(positions.size()));
      positions.push_back(corner);
    }
  }
  writer.add_triangles("wall", positions, indices, writer.itu_material());
  for (int i = 0; i < 10000; ++i) writer.root({{"name", "copy"}, {"mesh", 0}});
  const Model model = writer.load();
  expect_user_error(
      [&] {
        build_scene({{"town", &model, {}, dvec3(1.0), false, {}, {}}}, {"s", {}});
      },
      {"object 'town' (test.glb)", "10001 places", "at most 24000000 triangles", "30003000"});
}

TEST(HostileBudget, ASidecarOfAliases) {
  std::string text = "materials: {}\nx0: &x0 {a: 1, b: 1, c: 1, d: 1, e: 1, f: 1, g: 1, h: 1}\n";
  for (int i = 1; i < 9; ++i) {
    text += fmt::format("x{0}: &x{0} {{", i);
    for (const char key : std::string("abcdefgh")) text += fmt::format("{}: *x{}, ", key, i - 1);
    text += "}\n";
  }
  const TemporaryFolder folder;
  GltfWriter writer;
  writer.add_triangles("wall", test::unit_quad(), test::quad_indices(), writer.itu_material());
  LoadOptions options;
  options.radio_materials = folder.write("radio.yaml", text);
  expect_user_error([&] { writer.load(options); }, {"radio.yaml:", "at most 1000000 values", "aliases"});
}

TEST(HostileBudget, SparseFilesAreRefusedByTheirSize) {
  const TemporaryFolder folder;
  const auto sparse = [&](const std::string& name) {
    const std::filesystem::path file = folder.write(name, "x");
    std::filesystem::resize_file(file, 100 * budget::gib);
    return file;
  };
  try {
    sparse("try.bin");
  } catch (const std::filesystem::filesystem_error& error) {
    GTEST_SKIP() << "no sparse files here: " << error.what();
  }
  expect_user_error([&] { load_model(sparse("big.glb"), {}); }, {"big.glb", "at most 2 GiB", "100 GiB"});
  GltfWriter writer;
  writer.add_triangles("wall", test::unit_quad(), test::quad_indices(), writer.itu_material());
  sparse("wall.bin");
  writer.document["buffers"] = json::array({{{"byteLength", writer.binary.size()}, {"uri", "wall.bin"}}});
  expect_user_error([&] { load_model(folder.write("wall.gltf", writer.document.dump()), {}); },
                    {"buffer 0", "wall.bin", "at most 2 GiB", "100 GiB"});
  LoadOptions options;
  options.radio_materials = sparse("radio.yaml");
  GltfWriter plain;
  plain.add_triangles("wall", test::unit_quad(), test::quad_indices(), plain.itu_material());
  expect_user_error([&] { plain.load(options); }, {"radio.yaml", "at most 16 MiB", "100 GiB"});
}

TEST(HostileBudget, OneFileNamedAgainAndAgainCountsEachTime) {
  const TemporaryFolder folder;
  folder.write("part.bin", "0123456789");
  AssetFolder files(folder.path / "a.gltf", {"the files", 25});
  EXPECT_EQ(files.read("part.bin", "a.gltf: buffer 0").size(), 10u);
  EXPECT_EQ(files.read("part.bin", "a.gltf: buffer 1").size(), 10u);
  expect_user_error(
      [&] { files.read("part.bin", "a.gltf: buffer 2"); },
      {"a.gltf: buffer 2: with file", "part.bin", "at most 25 bytes for the files", "found 30 bytes"});
}

Scene built(const GltfWriter& writer) {
  const Model model = writer.load();
  return build_scene({{"", &model, {}, dvec3(1.0), false, {}, {}}}, {"s", {}});
}

/// Writes triangles around one edge, `layers` of them in each of `directions`. Each direction makes one
/// facet.
GltfWriter fan(uint32_t directions, uint32_t layers) {
  std::vector<vec3> positions = {vec3(0, 0, 0), vec3(0, 0, 1)};
  std::vector<uint32_t> indices;
  for (uint32_t layer = 0; layer < layers; ++layer)
    for (uint32_t i = 0; i < directions; ++i) {
      const double angle = 6.283185307179586 * i / directions;
      // exact multiples, so that the layers lie in one plane up to rounding
      const double length = 1.0 + 0.25 * layer;
      indices.insert(indices.end(), {0u, 1u, static_cast<uint32_t>(positions.size())});
      positions.emplace_back(std::cos(angle) * length, std::sin(angle) * length, 0.5);
    }
  GltfWriter writer;
  writer.add_triangles("fan", positions, indices, writer.itu_material());
  return writer;
}

TEST(HostileBudget, TrianglesAroundOneEdgeMergeByDirection) {
  for (const uint32_t directions : {3u, 5u, 16u, 40u, 359u}) {
    const Scene scene = built(fan(directions, 3));
    EXPECT_EQ(scene.facets.size(), directions);
    for (uint32_t triangle = 0; triangle < 3 * directions; ++triangle)
      EXPECT_EQ(scene.facet_of_triangle[triangle], triangle % directions);
  }
}

TEST(HostileBudget, ThousandsOfTrianglesAroundOneEdge) {
  // Neighbours are 0.25 mrad apart. Each is 0.13 mrad from the plane of both, which is more than may merge.
  EXPECT_EQ(built(fan(25000, 1)).facets.size(), 25000u);
}

TEST(HostileBudget, ManyNodesMaterialsAndPrimitives) {
  constexpr int count = 20000;
  GltfWriter writer;
  const json attributes = {{"POSITION", writer.vec3s({vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)})}};
  json primitives = json::array();
  for (int i = 0; i < count; ++i)
    primitives.push_back(
        {{"attributes", attributes}, {"material", writer.itu_material(fmt::format("itu_wood.{}", i))}});
  const int many = writer.mesh("many", primitives);
  writer.root({{"name", "all"}, {"mesh", many}});
  const int one = writer.mesh("one", json::array({primitives[0]}));
  for (int i = 0; i < count; ++i) writer.root({{"name", fmt::format("n{}", i)}, {"mesh", one}});
  const Model model = writer.load();
  EXPECT_EQ(node_names(model),
            "all, n0, n1, n2, n3, n4, n5, n6, n7, n8, n9, n10, n11, n12, n13, n14, n15, n16, n17, n18 and "
            "19981 more");
  const Scene scene = build_scene({{"", &model, {}, dvec3(1.0), false, {}, {}}}, {"s", {}});
  EXPECT_EQ(scene.instances.size(), size_t{count} + 1);
  EXPECT_EQ(scene.materials.size(), size_t{count});
}

TEST(HostileName, ATerminalObeysNoNameOfAFile) {
  GltfWriter writer;
  writer.add_triangles("wall\x1b[31m\nred", test::unit_quad(), {0, 1, 4}, writer.itu_material());
  expect_user_error([&] { writer.load(); }, {"mesh 'wall\\u001b[31m\\u000ared', primitive 0"});
  GltfWriter named;
  named.add_triangles("a\x1b]0;x\x07", test::unit_quad(), test::quad_indices(), named.itu_material());
  EXPECT_EQ(node_names(named.load()), "a\\u001b]0;x\\u0007");
}

}  // namespace
}  // namespace greatx::scene
