// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/files/scene_import.h"

#include <nlohmann/json.hpp>

#include "io/formats/glb_writer.h"

namespace greatx::apps {

io::Bytes imported_glb(const scene::ImportedScene& scene, const std::string& name) {
  io::GlbWriter writer;
  std::vector<int> materials;
  for (const scene::ImportedMaterial& material : scene.materials) {
    io::GlbMaterial out;
    out.name = material.name;
    out.base_color = dvec3(material.base_color);
    out.metallic = material.metallic;
    out.roughness = 0.8f;
    out.double_sided = true;  // walls are often single sheets with either winding
    out.extensions_json = fmt::format(R"({{"GREATX_radio_material":{}}})", material.radio_json);
    materials.push_back(writer.add_material(out));
  }
  for (const scene::ImportedObject& object : scene.objects) {
    io::GlbPrimitive primitive;
    primitive.material = materials.at(static_cast<size_t>(object.material));
    primitive.positions = object.positions;
    primitive.normals = object.normals;
    primitive.indices = object.indices;
    io::GlbNode node;
    node.name = object.name;
    node.mesh = writer.add_mesh(object.name, {primitive});
    writer.add_node(node);
  }
  return writer.finish(name);
}

std::string imported_sidecar(const scene::ImportedScene& scene, const std::string& source) {
  std::string text = fmt::format("# Radio materials of {}, by `greatx scene import`.\nmaterials:\n", source);
  // JSON is valid YAML.
  for (const scene::ImportedMaterial& material : scene.materials)
    text += fmt::format("  {}: {}\n", nlohmann::json(material.name).dump(),
                        nlohmann::ordered_json::parse(material.radio_json).dump());
  return text;
}

}  // namespace greatx::apps
