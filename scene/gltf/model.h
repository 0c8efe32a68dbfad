// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the content of one glTF 2.0 file, parsed, checked and flattened. Transforms are in fp64 and lead to
// a frame with z up.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/description/scene.h"
#include "scene/network/network.h"

namespace greatx::scene {

struct ModelPrimitive {
  std::vector<vec3> positions;    ///< in the mesh's own frame, glTF axes (y up), as in the file
  std::vector<vec3> normals;      ///< empty: flat normals are to be computed
  std::vector<vec4> tangents;     ///< may be empty
  std::vector<vec2> uvs;          ///< may be empty
  std::vector<uint32_t> indices;  ///< triangles; strips and fans are unrolled, missing indices are filled in
  uint32_t material = 0;
};

struct ModelMesh {
  std::string name;
  std::vector<ModelPrimitive> primitives;
};

/// A node of the file, with or without a mesh.
struct ModelNode {
  std::string name;  ///< the file's, else its mesh's, else "node_" and its number; may not be unique
  dmat4 model_from_node{1.0};  ///< includes y-up to z-up
  uint32_t end = 0;            ///< its descendants are the nodes after it, up to but excluding this index
};

/// A node with a mesh, placed in the model's frame (x east, y north, z up).
struct ModelInstance {
  std::string name;
  uint32_t mesh = 0;
  dmat4 model_from_mesh{1.0};  ///< includes y-up to z-up; may have non-uniform or negative scale
  SemanticClass semantic_class = SemanticClass::unlabeled;
  uint32_t node = 0;  ///< into Model::nodes
};

struct Model {
  std::filesystem::path file;
  std::vector<ModelMesh> meshes;
  std::vector<ModelNode> nodes;  ///< those that the scene reaches, depth first, parents before their children
  std::vector<ModelInstance> instances;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<PunctualLight> lights;         ///< in the model's frame
  std::vector<uint32_t> nodes_of_lights;     ///< [lights], into nodes
  std::optional<Georeference> georeference;  ///< of the model's frame (scene/georeference)
  std::optional<StreetNetwork> streets;      ///< in the model's frame (scene/network)
  std::vector<std::string> notes;
  std::vector<std::string> unused_materials;  ///< names of those that the file has and no loaded mesh uses
  /// Pictures that `LoadOptions::keep_faults` has left out, each as the message of the error.
  std::vector<std::string> lost_pictures;
};

/// Returns the names of a model's nodes for messages, each once, at most 20: "hull, wheel and 3 more".
std::string node_names(const Model& model);

struct LoadOptions {
  /// A YAML file that maps material names or globs to radio properties; empty: none.
  std::filesystem::path radio_materials;
  /// Accepts materials without radio properties (scenes for cameras and LiDAR alone).
  bool optical_only = false;
  /// For `greatx scene check`, which lists the faults of a file instead of stopping at the first. Vertices
  /// that are not finite and triangles of zero area are kept, and a material does without a picture that
  /// cannot be read. Such a model is for checks alone: build_scene() may refuse it.
  bool keep_faults = false;
};

/// Loads a .gltf or .glb file. Throws UserError, which names the file and the mesh or material.
Model load_model(const std::filesystem::path& file, const LoadOptions& options);
/// Loads a .glb from memory (the embedded assets). `name` stands for the file in messages.
Model load_model(const std::string& name, std::span<const std::byte> glb, const LoadOptions& options);

}  // namespace greatx::scene
