// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/model.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/ranges.h>

#include "core/activity.h"
#include "core/error.h"
#include "core/text.h"
#include "scene/files/asset_folder.h"
#include "scene/files/known_format.h"
#include "scene/georeference/georeference.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/gltf_geometry.h"
#include "scene/gltf/gltf_materials.h"
#include "scene/gltf/gltf_nodes.h"

namespace greatx::scene {
namespace {

/// Reads the meshes that nodes place. Instances of a mesh without triangles are removed with a note.
void read_placed_meshes(const GltfFile& file, Model& model) {
  constexpr uint32_t skipped = 0xFFFFFFFFu;
  std::map<uint32_t, uint32_t> new_index;
  GeometryMemory memory;
  for (const ModelInstance& instance : model.instances) {
    if (new_index.count(instance.mesh) > 0) continue;
    ModelMesh mesh = read_mesh(file, instance.mesh, model.notes, memory);
    if (mesh.primitives.empty()) {
      new_index[instance.mesh] = skipped;
      continue;
    }
    new_index[instance.mesh] = static_cast<uint32_t>(model.meshes.size());
    model.meshes.push_back(std::move(mesh));
  }
  std::vector<ModelInstance> kept;
  for (ModelInstance& instance : model.instances) {
    instance.mesh = new_index.at(instance.mesh);
    if (instance.mesh != skipped) kept.push_back(std::move(instance));
  }
  model.instances = std::move(kept);
  if (new_index.size() < file.model.meshes.size()) {
    model.notes.push_back(fmt::format("{}: {} meshes are placed by no node of the scene and are not loaded",
                                      file.name, file.model.meshes.size() - new_index.size()));
  }
}

void note_ignored_extensions(const GltfFile& file, Model& model) {
  std::vector<std::string> ignored;
  for (const std::string& extension : file.model.extensionsUsed) {
    if (extension != "KHR_lights_punctual" && extension != "KHR_materials_emissive_strength" &&
        extension != "KHR_materials_transmission" && extension != "KHR_mesh_quantization" &&
        extension != "GREATX_radio_material") {
      ignored.push_back(extension);
    }
  }
  if (!ignored.empty()) {
    model.notes.push_back(
        fmt::format("{}: extensions that are ignored: {}", file.name, fmt::join(ignored, ", ")));
  }
  if (!file.model.animations.empty()) {
    model.notes.push_back(
        fmt::format("{}: {} animations are ignored", file.name, file.model.animations.size()));
  }
}

/// Reads the extras of the scenes alone, so that a large file is not written out and parsed again.
void read_extras(const GltfFile& file, Model& model) {
  nlohmann::json scenes;
  for (const char* member : {"scene", "scenes"})
    if (file.json.contains(member)) scenes[member] = file.json[member];
  const std::string text = scenes.dump();
  model.georeference = georeference_of_document(text, {file.name, 0});
  model.streets = street_network_of_document(text, {file.name, 0});
}

Model model_of(const GltfFile& file, const LoadOptions& options) {
  Model model;
  model.file = file.name;
  read_extras(file, model);
  note_ignored_extensions(file, model);
  read_nodes(file, model);
  read_placed_meshes(file, model);
  if (model.instances.empty() && model.lights.empty()) {
    throw_user_error("{}: it places no mesh and no light: expected triangles in the default scene",
                     file.name);
  }
  read_materials(file, options, model);
  return model;
}

}  // namespace

std::string node_names(const Model& model) {
  constexpr size_t most = 20;
  std::vector<std::string> names;
  std::set<std::string_view> seen;
  for (const ModelNode& node : model.nodes)
    if (seen.insert(node.name).second && names.size() < most) names.push_back(printable(node.name));
  const size_t left_out = seen.size() - names.size();
  return fmt::format("{}{}", fmt::join(names, ", "),
                     left_out > 0 ? fmt::format(" and {} more", left_out) : "");
}

Model load_model(const std::filesystem::path& file, const LoadOptions& options) {
  const Activity activity("loading a model");
  const std::string name = file.string();
  const std::vector<unsigned char> bytes = read_regular_file(file, "model", budget::model_file);
  // The JSON parser would complain about the first character of a file that is something else.
  const std::optional<KnownFormat> format = recognised_format(file, bytes);
  // A faulty file that is called glTF has the faults of one.
  const bool called_gltf = file.extension() == ".gltf" || file.extension() == ".glb";
  if (format ? !format->is_gltf : !called_gltf)
    throw UserError(wrong_format(file, format.value_or(unknown_format()), "glTF 2.0 (.glb, .gltf)"));
  AssetFolder folder(file);
  return model_of(parse_gltf(name, bytes, folder, options.keep_faults), options);
}

Model load_model(const std::string& name, std::span<const std::byte> glb, const LoadOptions& options) {
  const std::span<const unsigned char> bytes(reinterpret_cast<const unsigned char*>(glb.data()), glb.size());
  AssetFolder folder({});
  return model_of(parse_gltf(name, bytes, folder, options.keep_faults), options);
}

}  // namespace greatx::scene
