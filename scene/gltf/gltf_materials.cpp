// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/ranges.h>

#include "core/error.h"
#include "core/text.h"
#include "scene/gltf/gltf_geometry.h"
#include "scene/gltf/gltf_textures.h"
#include "scene/material/material_words.h"
#include "scene/material/radio_fields.h"
#include "scene/material/radio_sidecar.h"

namespace greatx::scene {
namespace {

using nlohmann::json;

constexpr const char* default_name = "default_material";

float in_range(double value, double max, const std::string& what) {
  if (!(value >= 0.0 && value <= max)) {
    throw_user_error("{}: expected a number from 0 to {:g}, found {}", what, max, value);
  }
  return static_cast<float>(value);
}

template <typename Vec>
Vec color_of(const std::vector<double>& factor, const std::string& what) {
  if (factor.size() != static_cast<size_t>(Vec::length())) {
    throw_user_error("{}: expected {} numbers, found {}", what, Vec::length(), factor.size());
  }
  Vec color;
  for (int axis = 0; axis < Vec::length(); ++axis)
    color[axis] = in_range(factor[static_cast<size_t>(axis)], 1.0, what);
  return color;
}

/// Returns the object of extension `name` of a material, or null if there is none.
const json* extension_of(const json& material, const char* name) {
  const auto extensions = material.find("extensions");
  if (extensions == material.end() || !extensions->is_object()) return nullptr;
  const auto extension = extensions->find(name);
  return extension == extensions->end() ? nullptr : &*extension;
}

float emissive_strength(const json& material, const std::string& what) {
  const json* extension = extension_of(material, "KHR_materials_emissive_strength");
  if (!extension || !extension->is_object() || !extension->contains("emissiveStrength")) return 1.0f;
  const json& strength = (*extension)["emissiveStrength"];
  const double value = strength.is_number() ? strength.get<double>() : -1.0;
  if (!(value >= 0.0 && value <= 1e6)) {
    throw_user_error("{}, emissiveStrength: expected a number from 0 to 1e6, found {}", what,
                     strength.dump());
  }
  return static_cast<float>(value);
}

/// Returns the factor of KHR_materials_transmission; 0: none.
float transmission_of(const json& material, const std::string& what) {
  const json* extension = extension_of(material, "KHR_materials_transmission");
  if (!extension || !extension->is_object() || !extension->contains("transmissionFactor")) return 0.0f;
  const json& factor = (*extension)["transmissionFactor"];
  const double value = factor.is_number() ? factor.get<double>() : -1.0;
  if (!(value >= 0.0 && value <= 1.0)) {
    throw_user_error("{}, transmissionFactor: expected a number from 0 to 1, found {}", what, factor.dump());
  }
  return static_cast<float>(value);
}

void read_alpha(const tinygltf::Material& source, PbrMaterial& pbr, const std::string& what, Model& model) {
  pbr.alpha_cutoff = in_range(source.alphaCutoff, 1e6, what + ", alphaCutoff");
  if (source.alphaMode == "MASK") {
    pbr.alpha_mode = AlphaMode::mask;
  } else if (source.alphaMode == "BLEND") {
    // A textured blend is foliage or a decal, whose holes matter. An untextured blend is a pane, which must
    // not vanish.
    const bool textured = pbr.base_color_texture >= 0;
    pbr.alpha_mode = textured ? AlphaMode::mask : AlphaMode::opaque;
    pbr.alpha_cutoff = 0.5f;
    if (!textured && pbr.transmission == 0.0f)
      pbr.transmission = std::clamp(1.0f - pbr.base_color.a, 0.0f, 1.0f);
    model.notes.push_back(
        fmt::format("{}: alpha mode BLEND is treated as {}", what,
                    textured ? "MASK with cutoff 0.5 (it has a texture)"
                             : "OPAQUE (no texture), but LiDAR's light goes through by 1 - alpha"));
  } else if (source.alphaMode != "OPAQUE" && !source.alphaMode.empty()) {
    throw_user_error("{}: alphaMode '{}', expected OPAQUE, MASK or BLEND", what, source.alphaMode);
  }
}

PbrMaterial read_pbr(const tinygltf::Material& source, const json& document, const std::string& what,
                     TextureReader& textures, Model& model) {
  const auto& metallic_roughness = source.pbrMetallicRoughness;
  PbrMaterial pbr;
  pbr.base_color = color_of<vec4>(metallic_roughness.baseColorFactor, what + ", baseColorFactor");
  pbr.metallic = in_range(metallic_roughness.metallicFactor, 1.0, what + ", metallicFactor");
  pbr.roughness = in_range(metallic_roughness.roughnessFactor, 1.0, what + ", roughnessFactor");
  if (!source.emissiveFactor.empty())
    pbr.emissive = color_of<vec3>(source.emissiveFactor, what + ", emissiveFactor");
  pbr.emissive *= emissive_strength(document, what);
  pbr.normal_scale = static_cast<float>(source.normalTexture.scale);
  pbr.double_sided = source.doubleSided;
  pbr.base_color_texture =
      textures.read(metallic_roughness.baseColorTexture.index, true, what + ", baseColorTexture");
  pbr.metallic_roughness_texture = textures.read(metallic_roughness.metallicRoughnessTexture.index, false,
                                                 what + ", metallicRoughnessTexture");
  pbr.normal_texture = textures.read(source.normalTexture.index, false, what + ", normalTexture");
  pbr.emissive_texture = textures.read(source.emissiveTexture.index, true, what + ", emissiveTexture");
  pbr.transmission = transmission_of(document, what);
  read_alpha(source, pbr, what, model);
  if (!std::isfinite(pbr.normal_scale)) throw_user_error("{}: normalTexture.scale is not finite", what);
  if (document.dump().find("KHR_texture_transform") != std::string::npos) {
    model.notes.push_back(what + ": KHR_texture_transform is ignored");
  }
  return pbr;
}

/// Returns the radio fields that `extras.greatx_radio` holds, where tools such as Blender put custom
/// properties: a map, or a text of YAML such as "itu: glass, thickness_m: 0.006", with or without braces.
/// Throws UserError for any other value and for any other key that begins with "greatx", since somebody meant
/// it for this program.
std::optional<Field> radio_of_extras(const json& material, const std::string& what) {
  const auto extras = material.find("extras");
  if (extras == material.end() || !extras->is_object()) return std::nullopt;
  std::optional<Field> radio;
  for (const auto& [key, value] : extras->items()) {
    const std::string path = "extras." + printable(key);
    if (key == "greatx_radio") {
      if (!value.is_string()) {
        radio = field_from_json(value, what, path);
        continue;
      }
      const std::string text = value.get<std::string>();
      constexpr size_t longest = 65536;
      if (text.size() > longest)
        throw_user_error("{}: {}: {} bytes, expected at most {}", what, path, text.size(), longest);
      const bool braces = text.find_first_not_of(" \t\n") != std::string::npos &&
                          text[text.find_first_not_of(" \t\n")] == '{';
      radio = Field::parse_yaml(braces ? text : "{" + text + "}", {what + ", " + path, {}, {}});
    } else if (key.starts_with("greatx") || key.starts_with("GREATX")) {
      throw_user_error("{}: {}: expected greatx_radio, found '{}'", what, path, printable(key));
    }
  }
  return radio;
}

/// Reads the radio properties: from the name, then from the extension, the extras and the sidecar. Later
/// fields replace earlier ones (docs/materials.md).
void read_radio(Material& material, const json& document, const std::string& what,
                const RadioSidecar& sidecar) {
  RadioSources sources;
  if (const auto itu = itu_part_of_name(material.name)) {
    if (auto medium = itu_medium(*itu)) sources.radio.emplace().layers.push_back({std::move(*medium), 0.0});
  }
  if (const json* extension = extension_of(document, "GREATX_radio_material")) {
    sources = read_radio_fields(field_from_json(*extension, what, "GREATX_radio_material"), sources);
  }
  if (const auto radio = radio_of_extras(document, what)) sources = read_radio_fields(*radio, sources);
  if (const Field* entry = sidecar.find(material.name)) sources = read_radio_fields(*entry, sources);
  if (sources.radio) sidecar.extrapolate(material.name, *sources.radio);
  material.radio = std::move(sources.radio);
  material.reflectance_905nm = sources.reflectance_905nm;
  material.reflectance_1550nm = sources.reflectance_1550nm;
}

/// A material without radio properties that a mesh uses.
struct MissingRadio {
  std::string material;
  std::string mesh;  ///< a mesh that uses the material
};

std::string yaml_quoted(const std::string& name) {
  std::string quoted = "\"";
  for (const char character : name) {
    if (character == '"' || character == '\\') quoted += '\\';
    quoted += character;
  }
  return quoted + "\"";
}

[[noreturn]] void refuse_missing(const std::string& file, const std::vector<MissingRadio>& missing) {
  std::string lines, hints;
  for (const MissingRadio& entry : missing) {
    const std::string guess = suggested_radio(entry.material);
    lines += fmt::format("\n  {}: {{ {} }}  # used by mesh '{}'{}", yaml_quoted(printable(entry.material)),
                         guess.empty() ? "itu: concrete, thickness_m: 0.3" : guess, printable(entry.mesh),
                         guess.empty() ? "; its name says nothing" : "");
    if (const auto itu = itu_part_of_name(entry.material)) {
      hints += fmt::format("\n'{}' is no material of ITU-R P.2040-4, Table 3{}.", printable(*itu),
                           suggestion(*itu, itu_names()));
    }
  }
  throw_user_error(
      "{}: {} material{} used by meshes without radio properties. Add the extension GREATX_radio_material "
      "(in Blender: the custom property greatx_radio), or a line "
      "each to the radio-materials YAML. These are guesses by the names; put the right medium in their place "
      "(one of {}; a conductor; foliage; or relative_permittivity and conductivity):\nmaterials:{}{}",
      file, missing.size(), missing.size() == 1 ? " is" : "s are", fmt::join(itu_names(), ", "), lines,
      hints);
}

/// Returns a map from file index to the first mesh that uses the material. `no_material` sorts last.
std::map<uint32_t, std::string> used_materials(const Model& model) {
  std::map<uint32_t, std::string> used;
  for (const ModelMesh& mesh : model.meshes) {
    for (const ModelPrimitive& primitive : mesh.primitives) used.emplace(primitive.material, mesh.name);
  }
  return used;
}

}  // namespace

void read_materials(const GltfFile& file, const LoadOptions& options, Model& model) {
  const RadioSidecar sidecar =
      options.radio_materials.empty() ? RadioSidecar() : RadioSidecar::read(options.radio_materials);
  const tinygltf::Material default_source;
  const json default_document = json::object();
  TextureReader textures(file, model);
  std::map<uint32_t, uint32_t> new_index;
  std::vector<MissingRadio> missing;
  for (const auto& [index, mesh] : used_materials(model)) {
    const bool is_default = index == no_material;
    const tinygltf::Material& source = is_default ? default_source : file.model.materials[index];
    const json& document = is_default ? default_document : file.element("materials", index);
    Material material;
    material.name = is_default ? default_name : source.name;
    if (material.name.empty()) material.name = fmt::format("material_{}", index);
    const std::string what = fmt::format("{}: material '{}'", file.name, printable(material.name));
    material.pbr = read_pbr(source, document, what, textures, model);
    read_radio(material, document, what, sidecar);
    if (!material.radio && !options.optical_only) missing.push_back({material.name, mesh});
    new_index[index] = static_cast<uint32_t>(model.materials.size());
    model.materials.push_back(std::move(material));
  }
  for (size_t index = 0; index < file.model.materials.size(); ++index)
    if (new_index.count(static_cast<uint32_t>(index)) == 0) {
      const std::string& name = file.model.materials[index].name;
      model.unused_materials.push_back(name.empty() ? fmt::format("material_{}", index) : name);
    }
  if (!missing.empty()) refuse_missing(file.name, missing);
  for (ModelMesh& mesh : model.meshes) {
    for (ModelPrimitive& primitive : mesh.primitives) primitive.material = new_index.at(primitive.material);
  }
}

}  // namespace greatx::scene
