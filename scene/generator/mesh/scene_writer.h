// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A generated scene as glTF: meshes with the materials that they name, nodes, lights.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "io/formats/glb_writer.h"
#include "scene/description/scene.h"
#include "scene/generator/mesh/mesh_builder.h"
#include "scene/generator/paint/textures.h"

namespace greatx::scene::generator {

struct NodeSpec {
  std::string name;
  int mesh = -1;        ///< of add_mesh; -1: none
  dvec3 position{0.0};  ///< m, z up, in the parent's frame
  double yaw = 0.0;     ///< rad about z
  double scale = 1.0;
  SemanticClass semantic_class = SemanticClass::unlabeled;
  int parent = -1;   ///< of add_node; -1: the scene
  int light = -1;    ///< of add_light
  dvec3 shine{0.0};  ///< where the light looks, in the parent's frame; 0: as `yaw` says
};

struct LightSpec {
  vec3 color{1.0f};  ///< linear, of luminance 1
  double intensity_cd = 0.0;
  double range_m = 0.0;
  double inner_cone = 0.0, outer_cone = 0.0;  ///< rad from the axis; 0: a point light
  /// What it gives off, lm, by KHR_lights_punctual's fall-off between the cones, the square of a ramp in the
  /// cosine.
  double flux_lm() const;
};

/// Numbers are rounded on their way into the file, so that its bytes do not depend on the last bit of a sine.
class SceneWriter {
 public:
  SceneWriter();
  /// Takes the mesh; the number to name it by.
  int add_mesh(const std::string& name, const MeshBuilder& mesh);
  int add_node(const NodeSpec& node);
  int add_light(const LightSpec& light);
  /// The whole file.
  std::vector<std::byte> finish(const std::string& scene_name);

 private:
  /// glTF textures of the maps of one surface; -1: not in the file, or none.
  struct Textures {
    int color = -1, surface = -1, normal = -1;
    std::array<int, lit_pictures> lit{-1, -1};
  };
  /// Writes the material, and the textures that no material before it had.
  void add_material(int library_index);
  /// Adds the raster when it is first asked for; -1 if it is empty.
  int texture(int& index, const std::string& name, const Raster& raster, bool exact = false);
  const TextureMaps& maps(const std::string& name);

  io::GlbWriter file_;
  std::map<int, int> materials_;  ///< library index -> glTF material
  std::map<std::string, TextureMaps> maps_;
  std::map<std::string, Textures> textures_;
};

}  // namespace greatx::scene::generator
