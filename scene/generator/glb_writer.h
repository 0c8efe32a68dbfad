// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// glTF 2.0 binary (Khronos glTF 2.0.1, chapter 4) from meshes with z up.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/generator/mesh_builder.h"
#include "scene/scene.h"

namespace greatx::scene::generator {

struct NodeSpec {
  std::string name;
  int mesh = -1;        ///< of add_mesh; -1: none
  dvec3 position{0.0};  ///< m, z up, in the parent's frame
  double yaw = 0.0;     ///< rad about z
  double scale = 1.0;
  SemanticClass semantic_class = SemanticClass::unlabeled;
  int parent = -1;  ///< of add_node; -1: the scene
  int light = -1;   ///< of add_point_light
};

class GlbWriter {
 public:
  /// Takes the mesh; the number to name it by.
  int add_mesh(const std::string& name, const MeshBuilder& mesh);
  int add_node(const NodeSpec& node);
  /// KHR_lights_punctual: intensity in cd.
  int add_point_light(const std::string& name, const vec3& color, double intensity_cd, double range_m);
  /// The whole file.
  std::vector<std::byte> finish(const std::string& scene_name);

 private:
  int view(const void* data, size_t bytes, int target);
  int accessor(int buffer_view, int component_type, size_t count, const char* type);
  int gltf_material(int library_index);
  int texture(const std::string& name, bool metallic_roughness);
  int add_texture(const std::string& name, uint32_t width, uint32_t height, const std::vector<uint8_t>& rgb);

  nlohmann::ordered_json root_;
  std::vector<std::byte> binary_;
  std::map<int, int> materials_;                         ///< library index -> glTF material
  std::map<std::string, std::pair<int, int>> textures_;  ///< name -> base colour, metallic-roughness (or -1)
};

}  // namespace greatx::scene::generator
