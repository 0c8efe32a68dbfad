// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/import/mitsuba.h"

#include <cmath>
#include <map>

#include "core/activity.h"
#include "core/budget.h"
#include "core/text.h"
#include "scene/files/asset_folder.h"
#include "scene/import/mitsuba_materials.h"
#include "scene/import/mitsuba_xml.h"
#include "scene/import/ply_mesh.h"

namespace greatx::scene {

namespace {

std::string id_of(const pugi::xml_node& node) { return node.attribute("id").value(); }
/// Returns the id as messages show it.
std::string shown_id(const pugi::xml_node& node) { return printable(node.attribute("id").value()); }

/// Returns a file name as a URI. AssetFolder decodes percent escapes, so a per cent sign of the file name
/// must be escaped.
std::string uri_of(const std::string& filename) {
  std::string uri;
  for (const char character : filename) uri += character == '%' ? "%25" : std::string(1, character);
  return uri;
}

class MitsubaImporter {
 public:
  MitsubaImporter(const std::filesystem::path& file, const MitsubaOptions& options)
      : options_(options), xml_(file), folder_(file) {}

  ImportedScene import() {
    for (const pugi::xml_node& node : xml_.scene().children()) {
      const std::string kind = node.name();
      if (kind == "bsdf") add_top_level_bsdf(node);
      if (kind == "include" || kind == "path")
        xml_.fail(node, "<{}> is not supported: expected one file", kind);
    }
    for (const pugi::xml_node& shape : xml_.scene().children("shape")) add_shape(shape);
    if (scene_.objects.empty()) throw_user_error("{}: no shapes", xml_.file().string());
    return std::move(scene_);
  }

 private:
  void add_top_level_bsdf(const pugi::xml_node& bsdf) {
    const std::string id = xml_.text(bsdf, "id");
    if (!bsdfs_.emplace(id, bsdf).second) xml_.fail(bsdf, "a second <bsdf> with the id '{}'", printable(id));
  }

  void add_shape(const pugi::xml_node& shape) {
    const std::string type = shape.attribute("type").value();
    // Sionna RT makes one mesh of all shapes in this way. The shapes inside keep their names here.
    if (type == "merge") {
      for (const pugi::xml_node& inner : shape.children("shape")) add_shape(inner);
      return;
    }
    if (type != "ply")
      xml_.fail(shape, "shape '{}': expected the type ply, found '{}': export it as PLY", shown_id(shape),
                type);
    ImportedObject object;
    object.name = without_prefix(id_of(shape), "mesh-");
    if (object.name.empty()) object.name = fmt::format("shape_{}", scene_.objects.size() + 1);
    object.material = material_of(shape);
    read_mesh(shape, object);
    scene_.objects.push_back(std::move(object));
    if (shape.child("emitter"))
      scene_.notes.push_back(fmt::format("shape '{}': its emitter is left out", shown_id(shape)));
  }

  /// Returns the shape's own <bsdf>, or the one that its <ref> names.
  int material_of(const pugi::xml_node& shape) {
    pugi::xml_node bsdf = shape.child("bsdf");
    if (!bsdf) {
      const pugi::xml_node reference = shape.child("ref");
      if (!reference) xml_.fail(shape, "shape '{}': expected a <bsdf> or a <ref> to one", shown_id(shape));
      const std::string id = xml_.text(reference, "id");
      const auto found = bsdfs_.find(id);
      if (found == bsdfs_.end())
        xml_.fail(reference, "shape '{}': there is no <bsdf> with the id '{}'", shown_id(shape),
                  printable(id));
      bsdf = found->second;
    }
    const auto [entry, added] = materials_.emplace(bsdf.offset_debug(), 0);
    if (added) entry->second = add_material(bsdf);
    return entry->second;
  }

  /// Adds a material. A sidecar finds materials by name, so a name must mean one material.
  int add_material(const pugi::xml_node& bsdf) {
    ImportedMaterial material = read_mitsuba_material(xml_, bsdf, options_);
    for (size_t i = 0; i < scene_.materials.size(); ++i) {
      if (scene_.materials[i].name != material.name) continue;
      if (scene_.materials[i].radio_json != material.radio_json)
        xml_.fail(bsdf, "a second material '{}' with other radio properties", printable(material.name));
      return static_cast<int>(i);
    }
    scene_.materials.push_back(std::move(material));
    return static_cast<int>(scene_.materials.size()) - 1;
  }

  void read_mesh(const pugi::xml_node& shape, ImportedObject& object) {
    const pugi::xml_node node = MitsubaXml::property(shape, "string", "filename");
    if (!node) xml_.fail(shape, "shape '{}': expected <string name=\"filename\">", shown_id(shape));
    const std::string filename = xml_.text(node, "value");
    const std::vector<unsigned char> bytes = folder_.read(
        uri_of(filename), fmt::format("{}: shape '{}'", xml_.where(node).str(), shown_id(shape)));
    PlyMesh mesh = read_ply_mesh(bytes, (xml_.file().parent_path() / filename).string());
    memory_.plan(fmt::format("{}: with shape '{}'", xml_.where(node).str(), shown_id(shape)),
                 mesh.positions.size() * sizeof(vec3) + mesh.normals.size() * sizeof(vec3) +
                     mesh.indices.size() * sizeof(uint32_t));
    object.positions = std::move(mesh.positions);
    object.indices = std::move(mesh.indices);
    if (!xml_.flag(shape, "face_normals")) object.normals = std::move(mesh.normals);
    bool turned = xml_.flag(shape, "flip_normals");
    if (turned)
      for (vec3& normal : object.normals) normal = -normal;
    if (const pugi::xml_node transform = MitsubaXml::property(shape, "transform", "to_world"))
      turned ^= place(transform, object);
    if (turned)
      for (size_t i = 0; i < object.indices.size(); i += 3)
        std::swap(object.indices[i + 1], object.indices[i + 2]);
    normalize(shape, object);
  }

  /// Places the object. It computes in fp64 and rounds once. Returns true if the transform mirrors, so that
  /// the winding must be turned.
  bool place(const pugi::xml_node& node, ImportedObject& object) const {
    const dmat4 world_from_shape = xml_.transform(node);
    for (vec3& position : object.positions) {
      position = vec3(world_from_shape * dvec4(dvec3(position), 1.0));
      if (!std::isfinite(position.x + position.y + position.z))
        xml_.fail(node, "shape '{}': it leaves what a float can hold", printable(object.name));
    }
    const dmat3 linear(world_from_shape);
    const dmat3 normals = glm::transpose(glm::inverse(linear));
    for (vec3& normal : object.normals) normal = vec3(normals * dvec3(normal));
    return glm::determinant(linear) < 0.0;
  }

  void normalize(const pugi::xml_node& shape, ImportedObject& object) {
    for (vec3& normal : object.normals) {
      const double length = glm::length(dvec3(normal));
      if (!(length > 0.0) || !std::isfinite(length)) {
        scene_.notes.push_back(
            fmt::format("shape '{}': a normal is zero: its faces are flat", shown_id(shape)));
        object.normals.clear();
        return;
      }
      normal = vec3(dvec3(normal) / length);
    }
  }

  MitsubaOptions options_;
  MitsubaXml xml_;
  AssetFolder folder_;
  std::map<std::string, pugi::xml_node> bsdfs_;  ///< top level, by id
  std::map<std::ptrdiff_t, int> materials_;      ///< index of the material of the <bsdf> at this offset
  ImportedScene scene_;
  Spending memory_{budget::import_geometry};
};

}  // namespace

ImportedScene import_mitsuba(const std::filesystem::path& xml, const MitsubaOptions& options) {
  const Activity activity("importing a scene");
  if (!(options.default_thickness_m > 0.0) || !std::isfinite(options.default_thickness_m))
    throw_user_error("thickness: expected metres above 0, found {}", options.default_thickness_m);
  return MitsubaImporter(xml, options).import();
}

}  // namespace greatx::scene
