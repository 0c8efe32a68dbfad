// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads files back by tinygltf and checks counts, positions and names.
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include "apps/paths/glb.h"
#include "tests/apps/sample_paths.h"

namespace greatx::apps {
namespace {

using testing::ElementsAre;

tinygltf::Model read_back(const io::Bytes& glb) {
  tinygltf::TinyGLTF reader;
  tinygltf::Model model;
  std::string error, warning;
  EXPECT_TRUE(reader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(glb.data()),
                                          static_cast<unsigned>(glb.size())));
  EXPECT_EQ(error + warning, "");
  return model;
}

const tinygltf::Node& node(const tinygltf::Model& model, const std::string& beginning) {
  for (const tinygltf::Node& each : model.nodes)
    if (each.name.starts_with(beginning)) return each;
  ADD_FAILURE() << "no node " << beginning;
  return model.nodes.at(0);
}

std::vector<vec3> positions(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  const tinygltf::Accessor& accessor =
      model.accessors.at(static_cast<size_t>(primitive.attributes.at("POSITION")));
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<size_t>(accessor.bufferView));
  std::vector<vec3> values(accessor.count);
  std::memcpy(values.data(), model.buffers.at(0).data.data() + view.byteOffset,
              accessor.count * sizeof(vec3));
  return values;
}

TEST(PathsGlb, PathsAreLinesWithMarkersAndFigures) {
  const dvec3 origin(500000.0, 5400000.0, 30.0);
  const SampleScene sample(origin);
  const PathLink link = sample_link(origin);
  PathGlbOptions options;
  options.name = "sample csi";
  options.tick = 12;
  const tinygltf::Model model = read_back(paths_glb(std::span(&link, 1), sample.view(), options));

  const tinygltf::Node& parent = node(model, "paths to uav/antenna");
  ASSERT_EQ(parent.children.size(), 2u);
  EXPECT_EQ(parent.extras.Get("paths").GetNumberAsInt(), 2);
  const tinygltf::Node& sight = node(model, "path 1 LoS ");
  const tinygltf::Node& echo = node(model, "path 2 R ");
  EXPECT_EQ(echo.extras.Get("id").Get<std::string>(), id_text(link.paths[1].id()));
  EXPECT_EQ(echo.extras.Get("delay_s").GetNumberAsDouble(), link.paths[1].delay_s);
  EXPECT_EQ(echo.extras.Get("interactions").Get<std::string>(), "R house (glass)");
  EXPECT_NEAR(echo.extras.Get("gain_db").GetNumberAsDouble(), gain_db(path_gain(link.paths[1], 3.5e9)),
              1e-12);

  const tinygltf::Mesh& line = model.meshes.at(static_cast<size_t>(sight.mesh));
  ASSERT_EQ(line.primitives.size(), 1u) << "no interaction, no marker";
  EXPECT_EQ(line.primitives[0].mode, TINYGLTF_MODE_LINE);
  // Local coordinates with y up: (x, y, z) -> (x, z, -y).
  EXPECT_THAT(positions(model, line.primitives[0]), ElementsAre(vec3(0, 2, 0), vec3(40, 2, 0)));
  const tinygltf::Mesh& bent = model.meshes.at(static_cast<size_t>(echo.mesh));
  ASSERT_EQ(bent.primitives.size(), 2u);
  EXPECT_THAT(positions(model, bent.primitives[0]),
              ElementsAre(vec3(0, 2, 0), vec3(20, 2, -10), vec3(40, 2, 0)));
  EXPECT_EQ(model.accessors.at(static_cast<size_t>(bent.primitives[0].indices)).count, 4u);
  vec3 center(0.0f);
  const std::vector<vec3> marker = positions(model, bent.primitives[1]);
  for (const vec3& corner : marker) center += corner / static_cast<float>(marker.size());
  EXPECT_NEAR(glm::distance(center, vec3(20, 2, -10)), 0.0f, 1e-5f);

  EXPECT_THAT(node(model, "transmitter").translation, ElementsAre(0, 2, 0));
  EXPECT_THAT(node(model, "uav/antenna").translation, ElementsAre(40, 2, 0));
  EXPECT_EQ(model.scenes.at(0).extras.Get("local_origin_m").Get(0).GetNumberAsDouble(), 500000.0);
  EXPECT_EQ(model.scenes.at(0).extras.Get("tick").GetNumberAsInt(), 12);
}

TEST(PathsGlb, TheSceneComesWithOneNodeAnInstance) {
  const SampleScene sample;
  const PathLink link = sample_link();
  PathGlbOptions options;
  const std::vector<Pose> bodies(1);
  options.bodies = bodies;
  const tinygltf::Model model = read_back(paths_glb(std::span(&link, 1), sample.view(), options));
  EXPECT_EQ(node(model, "scene").children.size(), 3u);
  const tinygltf::Mesh& house = model.meshes.at(static_cast<size_t>(node(model, "house").mesh));
  EXPECT_EQ(model.materials.at(static_cast<size_t>(house.primitives.at(0).material)).name, "glass");
  EXPECT_EQ(model.accessors.at(static_cast<size_t>(house.primitives[0].indices)).count, 6u);
  for (const vec3& corner : positions(model, house.primitives[0])) EXPECT_EQ(corner.z, -10.0f);
}

TEST(PathsGlb, NoPathIsAFileToo) {
  const SampleScene sample;
  PathLink link = sample_link();
  link.paths.clear();
  const tinygltf::Model model = read_back(paths_glb(std::span(&link, 1), sample.view(), {}));
  EXPECT_TRUE(node(model, "paths to uav/antenna").children.empty());
}

TEST(PathsGlb, MarkersFaceOutwards) {
  const SampleScene sample;
  const PathLink link = sample_link();
  const tinygltf::Model model = read_back(paths_glb(std::span(&link, 1), sample.view(), {}));
  const tinygltf::Primitive& marker =
      model.meshes.at(static_cast<size_t>(node(model, "transmitter").mesh)).primitives.at(0);
  const std::vector<vec3> corners = positions(model, marker);
  const tinygltf::Accessor& accessor = model.accessors.at(static_cast<size_t>(marker.indices));
  std::vector<uint32_t> indices(accessor.count);
  std::memcpy(indices.data(),
              model.buffers.at(0).data.data() +
                  model.bufferViews.at(static_cast<size_t>(accessor.bufferView)).byteOffset,
              4 * accessor.count);
  ASSERT_EQ(indices.size(), 24u);
  for (size_t i = 0; i < indices.size(); i += 3) {
    const vec3 a = corners[indices[i]], b = corners[indices[i + 1]], c = corners[indices[i + 2]];
    EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c), 0.0f) << i / 3;
  }
}

}  // namespace
}  // namespace greatx::apps
