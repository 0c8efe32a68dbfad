// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads files back by tinygltf, which shares no code with the writer.
#include "io/formats/glb_writer.h"

#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include "core/record.h"
#include "core/units.h"
#include "io/formats/png.h"

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
  // A quarter turn to the left about z is a quarter turn about glTF's y.
  writer.add_node({.name = "child",
                   .parent = root,
                   .pose = {{10, 20, 30}, orientation_from_yaw_pitch_roll(0.5 * pi, 0, 0)}});
  const tinygltf::Model model = read_back(writer.finish("poses"));
  EXPECT_THAT(model.scenes.at(0).nodes, ElementsAre(0));
  EXPECT_THAT(model.nodes.at(0).children, ElementsAre(1));
  EXPECT_THAT(model.nodes.at(1).translation, ElementsAre(10, 30, -20));
  const std::vector<double>& q = model.nodes.at(1).rotation;
  // The turn maps x to y, which is glTF's -z.
  const dvec3 turned = dquat(q[3], q[0], q[1], q[2]) * dvec3(1, 0, 0);
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

GlbPrimitive a_triangle() {
  GlbPrimitive triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.indices = {0, 1, 2};
  return triangle;
}

/// Returns the direction of a light by glTF's rule: the node's rotation of -z.
dvec3 aim_of(const tinygltf::Node& node) {
  const std::vector<double>& q = node.rotation;
  return dquat(q.at(3), q.at(0), q.at(1), q.at(2)) * dvec3(0, 0, -1);
}

TEST(GlbWriter, TexturesComeBackWithTheirMaterial) {
  GlbWriter writer;
  Array image(DType::u8, {1, 2, 3});
  const std::vector<uint8_t> rgb{250, 128, 3, 0, 64, 255};
  std::copy(rgb.begin(), rgb.end(), image.as<uint8_t>().begin());
  const Bytes png = encode_png(image);
  GlbPrimitive triangle = a_triangle();
  triangle.uvs = {{0, 0}, {1, 0}, {0, 0.5f}};
  triangle.material = 0;
  const int mesh = writer.add_mesh("m");
  writer.add_primitive(mesh, triangle);
  // A texture with an odd number of bytes must not shift the data behind it.
  const int color = writer.add_texture("color", png), glow = writer.add_texture("glow", png);
  GlbMaterial material;
  material.name = "lit";
  material.base_color_texture = color;
  material.emissive_texture = glow;
  material.emissive = {1, 0.5, 0.25};
  material.emissive_strength = 3.5;
  EXPECT_EQ(writer.add_material(material), 0);
  writer.add_primitive(mesh, a_triangle());
  writer.add_node({.name = "m", .mesh = mesh, .scale = 1.25});
  const tinygltf::Model model = read_back(writer.finish("s"));

  ASSERT_EQ(model.materials.size(), 1u);
  const tinygltf::Material& back = model.materials[0];
  ASSERT_EQ(model.textures.size(), 2u);
  EXPECT_EQ(back.pbrMetallicRoughness.baseColorTexture.index, color);
  EXPECT_EQ(back.emissiveTexture.index, glow);
  EXPECT_EQ(back.normalTexture.index, -1);
  EXPECT_THAT(back.emissiveFactor, ElementsAre(1, 0.5, 0.25));
  EXPECT_EQ(back.extensions.at("KHR_materials_emissive_strength").Get("emissiveStrength").GetNumberAsDouble(),
            3.5);
  EXPECT_THAT(model.extensionsUsed, ElementsAre("KHR_materials_emissive_strength"));
  EXPECT_EQ(model.samplers.size(), 1u);
  const tinygltf::Image& picture = model.images.at(static_cast<size_t>(model.textures[0].source));
  EXPECT_EQ(picture.name, "color");
  ASSERT_EQ(picture.component, 4);  // tinygltf adds an alpha channel
  EXPECT_THAT(picture.image, ElementsAre(250, 128, 3, 255, 0, 64, 255, 255));

  const std::vector<tinygltf::Primitive>& primitives = model.meshes.at(0).primitives;
  ASSERT_EQ(primitives.size(), 2u);
  EXPECT_EQ(values_of<vec2>(model, primitives[0].attributes.at("TEXCOORD_0"))[2], vec2(0, 0.5f));
  EXPECT_EQ(values_of<vec3>(model, primitives[1].attributes.at("POSITION"))[2], vec3(0, 0, -1));
  EXPECT_THAT(model.nodes.at(0).scale, ElementsAre(1.25, 1.25, 1.25));
}

TEST(GlbWriter, LightsComeBackAndLookWhereTheyAim) {
  GlbWriter writer;
  const int spot = writer.add_light(
      {.color = {1, 0.5, 0.25}, .intensity_cd = 900, .range_m = 30, .inner_cone = 0.5, .outer_cone = 0.75});
  const int point = writer.add_light({.intensity_cd = 7, .range_m = 2});
  writer.add_node({.name = "down", .light = spot, .aim = {0, 0, -2}});
  writer.add_node({.name = "north-west", .light = spot, .aim = {-3, 4, 0}});
  writer.add_node({.name = "bulb", .light = point});
  const tinygltf::Model model = read_back(writer.finish("s"));
  ASSERT_EQ(model.lights.size(), 2u);
  EXPECT_EQ(model.lights[0].type, "spot");
  EXPECT_THAT(model.lights[0].color, ElementsAre(1, 0.5, 0.25));
  EXPECT_EQ(model.lights[0].intensity, 900);
  EXPECT_EQ(model.lights[0].range, 30);
  EXPECT_EQ(model.lights[0].spot.innerConeAngle, 0.5);
  EXPECT_EQ(model.lights[0].spot.outerConeAngle, 0.75);
  EXPECT_EQ(model.lights[1].type, "point");
  EXPECT_THAT(model.extensionsUsed, ElementsAre("KHR_lights_punctual"));
  EXPECT_NEAR(glm::distance(aim_of(model.nodes.at(0)), dvec3(0, -1, 0)), 0.0, 1e-6);
  EXPECT_NEAR(glm::distance(aim_of(model.nodes.at(1)), dvec3(-0.6, 0, -0.8)), 0.0, 1e-6);
  EXPECT_TRUE(model.nodes.at(2).rotation.empty());
  EXPECT_EQ(model.nodes[2].extensions.at("KHR_lights_punctual").Get("light").GetNumberAsInt(), point);
  // Straight back there is no shortest rotation: -y is glTF's +z.
  EXPECT_THROW(writer.add_node({.name = "back", .light = spot, .aim = {0, -1, 0}}), ContractError);
}

TEST(GlbWriter, CompactFilesHoldTheSame) {
  GlbWriter plain, compact({.generator = "somebody", .compact = true});
  for (GlbWriter* const writer : {&plain, &compact})
    writer->add_node({.name = "t", .mesh = writer->add_mesh("t", {a_triangle(), a_line(-1)})});
  const Bytes large = plain.finish("s"), small = compact.finish("s");
  EXPECT_LT(small.size(), large.size());
  const tinygltf::Model model = read_back(small);
  EXPECT_EQ(model.asset.generator, "somebody");
  EXPECT_EQ(read_back(large).asset.generator, "greatx " GREATX_VERSION);
  const std::vector<tinygltf::Primitive>& primitives = model.meshes.at(0).primitives;
  ASSERT_EQ(primitives.size(), 2u);
  EXPECT_EQ(primitives[0].mode, TINYGLTF_MODE_TRIANGLES);
  EXPECT_EQ(primitives[1].mode, TINYGLTF_MODE_LINE);
  EXPECT_THAT(values_of<uint16_t>(model, primitives[0].indices), ElementsAre(0, 1, 2));
  // Rotations are rounded to float: here the sine and cosine of an eighth of a radian.
  const Pose turned{{}, dquat(std::cos(0.125), 0.0, 0.0, std::sin(0.125))};
  for (GlbWriter* const writer : {&plain, &compact}) writer->add_node({.name = "turned", .pose = turned});
  EXPECT_THAT(read_back(compact.finish("s")).nodes.at(0).rotation,
              ElementsAre(0.0, double{0.12467473f}, 0.0, double{0.99219767f}));
  EXPECT_THAT(read_back(plain.finish("s")).nodes.at(0).rotation,
              ElementsAre(0.0, std::sin(0.125), 0.0, std::cos(0.125)));
  // The index 65535 stands for a restart, so that a mesh that needs it has indices of 32 bits.
  for (const uint32_t count : {65534u, 65535u}) {
    GlbPrimitive large_one = a_triangle();
    large_one.positions.resize(count, vec3(0, 0, 1));
    large_one.indices = {0, 1, count - 1};
    compact.add_node({.name = "l", .mesh = compact.add_mesh("l", {large_one})});
    const tinygltf::Model back = read_back(compact.finish("s"));
    const int indices = back.meshes.at(0).primitives.at(0).indices;
    if (count == 65534)
      EXPECT_THAT(values_of<uint16_t>(back, indices), ElementsAre(0, 1, 65533));
    else
      EXPECT_THAT(values_of<uint32_t>(back, indices), ElementsAre(0, 1, 65534));
  }
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
  line = a_line(-1);
  line.uvs = {{0, 0}};
  EXPECT_THROW(writer.add_mesh("m", {line}), ContractError);
  GlbWriter another;
  another.add_mesh("nothing follows");
  EXPECT_THROW(another.finish("s"), ContractError);
}

}  // namespace
}  // namespace greatx::io
