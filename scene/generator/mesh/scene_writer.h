// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes a generated scene as glTF: meshes with the materials that they name, nodes, and lights.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/formats/glb_writer.h"
#include "scene/description/scene.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/mesh/mesh_builder.h"
#include "scene/generator/paint/textures.h"

namespace greatx::scene::generator {

struct NodeSpec {
  std::string name;
  int mesh = -1;        ///< from add_mesh; -1: none
  dvec3 position{0.0};  ///< m, z up, in the parent's frame
  double yaw = 0.0;     ///< rad about z
  double pitch = 0.0;   ///< rad about y, before the yaw
  double scale = 1.0;
  SemanticClass semantic_class = SemanticClass::unlabeled;
  int parent = -1;     ///< from add_node; -1: the scene
  int light = -1;      ///< from add_light; -1: none
  dvec3 shine{0.0};    ///< direction of the light in the parent's frame; 0: given by `yaw`
  std::string extras;  ///< further members of the node's extras, as JSON without braces; may be empty
};

struct LightSpec {
  vec3 color{1.0f};  ///< linear, of luminance 1
  double intensity_cd = 0.0;
  double range_m = 0.0;
  double inner_cone = 0.0, outer_cone = 0.0;  ///< rad from the axis; 0: a point light
  bool passing_beam = false;                  ///< scene::PunctualLight::Beam
  /// Returns the luminous flux of the light, lm. Between the cones KHR_lights_punctual's intensity falls with
  /// the square of a ramp in the cosine.
  double flux_lm() const;
};

/// Collects the parts of the file. It rounds numbers before they go into the file, so that the bytes do not
/// depend on the last bit of a sine.
class SceneWriter {
 public:
  /// Meshes refer to the materials of `library` by index. MaterialSpec::texture names a picture of `pictures`
  /// or, if there is none, a texture known to make_texture.
  explicit SceneWriter(std::vector<MaterialSpec> library = material_library(),
                       std::map<std::string, TextureMaps> pictures = {},
                       const std::string& generator = "greatx scene generator");
  /// Adds the mesh and returns its index for NodeSpec.
  int add_mesh(const std::string& name, const MeshBuilder& mesh);
  int add_mesh(const std::string& name, std::span<const PrimitiveData> primitives);
  int add_node(const NodeSpec& node);
  int add_light(const LightSpec& light);
  /// Packs pictures in a hurry from now on: for a file that is read back at once.
  void set_quick(bool quick) { quick_ = quick; }
  /// Paints textures that make_texture knows on all cores. Without it they are painted one by one, when a
  /// mesh first shows them. The file is the same.
  void paint_ahead(std::span<const char* const> names);
  /// Sets the extras of the scene for a finish() that gives none: JSON, or empty.
  void set_scene_extras(std::string json) { scene_extras_ = std::move(json); }
  /// Returns the bytes of the whole file.
  std::vector<std::byte> finish(const std::string& scene_name, const std::string& scene_extras_json = "");

 private:
  /// Holds the glTF textures of the maps of one surface; -1: not in the file, or none.
  struct Textures {
    int color = -1, surface = -1, normal = -1;
    std::array<int, lit_pictures> lit{-1, -1};
  };
  /// Writes the material, and those of its textures that no earlier material has written.
  void add_material(int library_index);
  /// Returns the texture in `index`, which it adds to the file at the first call, or -1 if the raster is
  /// empty. If `exact`, the PNG holds exactly the raster's values. `alpha` is TextureMaps::alpha.
  int texture(int& index, const std::string& name, const Raster& raster, bool exact = false,
              const std::vector<uint8_t>& alpha = {});
  const TextureMaps& maps(const std::string& name);

  std::vector<MaterialSpec> library_;
  io::GlbWriter file_;
  std::map<int, int> materials_;  ///< library index -> glTF material
  std::map<std::string, TextureMaps> maps_;
  std::map<std::string, Textures> textures_;
  std::string scene_extras_;
  bool quick_ = false;
};

}  // namespace greatx::scene::generator
