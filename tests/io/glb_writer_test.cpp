// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Files are read back by tinygltf, which shares no code with the writer.
#include "io/formats/glb_writer.h"

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include "core/units.h"

namespace greatx::io {
namespace {

using testing::ElementsAre;

tinygltf::Model read_back(const Bytes& glb) {
  tinygltf::TinyGLTF reader;
  tinygltf::Model model;
  std::string error, warning;
  EXPECT_TRUE(reader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(glb.data()),
                                          static_cast<unsigned>(glb.size())))
      << error;
  EXPECT_EQ(error + warning, "");
  return model;
}

template <typename T>
std::vector<T> values_of(const tinygltf::Model& model, int accessor_index) {
  const tinygltf::Accessor& accessor = model.accessors.at(static_cast<size_t>(accessor_index));
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<size_t>(accessor.bufferView));
  std::vector<T> values(accessor.count);
  EXPECT_EQ(view.byteLength, sizeof(T) * accessor.count);
  std::memcpy(values.data(), model.buffers.at(0).data.data() + view.byteOffset, view.byteLength);
  return values;
}

GlbPrimitive a_line(int material) {
  GlbPrimitive line;
  line.mode = GlbPrimitive::Mode::lines;
  line.material = material;
  line.positions = {{1, 2, 3}, {4, 5, 6}, {-7, 8, -9}};
  line.colors = {{1, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.25f}};
  line.indices = {0, 1, 1, 2};
  return line;
}

TEST(GlbWriter, LinesComeBackWithYUp) {
  GlbWriter writer;
  const int material = writer.add_material({.name = "R", .base_color = {1, 0.5f, 0}, .unlit = true});
  const int mesh = writer.add_mesh("path 1", {a_line(material)});
  writer.add_node({.name = "path 1", .mesh = mesh, .extras_json = R"({"id": "00ff", "gain_db": -81.5})"});
  const tinygltf::Model model = read_back(writer.finish("paths", R"({"tick": 4})"));

  ASSERT_EQ(model.meshes.size(), 1u);
  const tinygltf::Primitive& primitive = model.meshes[0].primitives.at(0);
  EXPECT_EQ(primitive.mode, TINYGLTF_MODE_LINE);
  EXPECT_THAT(values_of<vec3>(model, primitive.attributes.at("POSITION")),
              ElementsAre(vec3(1, 3, -2), vec3(4, 6, -5), vec3(-7, -9, -8)));
  EXPECT_THAT(values_of<vec3>(model, primitive.attributes.at("COLOR_0")),
              ElementsAre(vec3(1, 0, 0), vec3(0, 0.5f, 0), vec3(0, 0, 0.25f)));
  EXPECT_THAT(values_of<uint32_t>(model, primitive.indices), ElementsAre(0, 1, 1, 2));
  const tinygltf::Accessor& positions =
      model.accessors.at(static_cast<size_t>(primitive.attributes.at("POSITION")));
  EXPECT_THAT(positions.minValues, ElementsAre(-7, -9, -8));
  EXPECT_THAT(positions.maxValues, ElementsAre(4, 6, -2));

  ASSERT_EQ(model.materials.size(), 1u);
  EXPECT_EQ(model.materials[0].name, "R");
  EXPECT_TRUE(model.materials[0].extensions.contains("KHR_materials_unlit"));
  EXPECT_THAT(model.extensionsUsed, ElementsAre("KHR_materials_unlit"));
  ASSERT_EQ(model.nodes.size(), 1u);
  EXPECT_EQ(model.nodes[0].extras.Get("id").Get<std::string>(), "00ff");
  EXPECT_EQ(model.nodes[0].extras.Get("gain_db").GetNumberAsDouble(), -81.5);
  EXPECT_EQ(model.scenes.at(0).extras.Get("tick").GetNumberAsInt(), 4);
}

TEST(GlbWriter, PosesAndParentsComeBackWithYUp) {
  GlbWriter writer;
  const int root = writer.add_node({.name = "root"});
  // A quarter turn to the left about z is one about glTF's y.
  writer.add_node({.name = "child",
                   .parent = root,
                   .pose = {{10, 20, 30}, orientation_from_yaw_pitch_roll(0.5 * pi, 0, 0)}});
  const tinygltf::Model model = read_back(writer.finish("poses"));
  EXPECT_THAT(model.scenes.at(0).nodes, ElementsAre(0));
  EXPECT_THAT(model.nodes.at(0).children, ElementsAre(1));
  EXPECT_THAT(model.nodes.at(1).translation, ElementsAre(10, 30, -20));
  const std::vector<double>& q = model.nodes.at(1).rotation;
  const dvec3 turned = dquat(q[3], q[0], q[1], q[2]) * dvec3(1, 0, 0);  // x, which is to become y: glTF's -z
  EXPECT_NEAR(glm::distance(turned, dvec3(0, 0, -1)), 0.0, 1e-15);
}

TEST(GlbWriter, TrianglesKeepNormals) {
  GlbWriter writer;
  GlbPrimitive triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.normals.assign(3, vec3(0, 0, 1));
  triangle.indices = {0, 1, 2};
  writer.add_node({.name = "t", .mesh = writer.add_mesh("t", {triangle, a_line(-1)})});
  const tinygltf::Model model = read_back(writer.finish("s"));
  ASSERT_EQ(model.meshes.at(0).primitives.size(), 2u);
  EXPECT_EQ(model.meshes[0].primitives[0].mode, TINYGLTF_MODE_TRIANGLES);
  EXPECT_EQ(values_of<vec3>(model, model.meshes[0].primitives[0].attributes.at("NORMAL"))[2], vec3(0, 1, 0));
}

TEST(GlbWriter, NothingToShowIsAFileAllTheSame) {
  GlbWriter writer;
  EXPECT_TRUE(read_back(writer.finish("empty")).nodes.empty());
}

TEST(GlbWriter, BrokenPrimitivesAreRefused) {
  GlbWriter writer;
  GlbPrimitive line = a_line(-1);
  line.indices = {0, 3};
  EXPECT_THROW(writer.add_mesh("m", {line}), ContractError);
  line.indices = {0, 1, 2};
  EXPECT_THROW(writer.add_mesh("m", {line}), ContractError);
  EXPECT_THROW(writer.add_mesh("m", {GlbPrimitive{}}), ContractError);
  EXPECT_THROW(writer.add_mesh("m", {}), ContractError);
}

}  // namespace
}  // namespace greatx::io
