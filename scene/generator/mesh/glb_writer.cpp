// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/mesh/glb_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/mesh/png_encoder.h"
#include "scene/generator/paint/textures.h"

namespace greatx::scene::generator {

namespace {

using Json = nlohmann::ordered_json;

constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr int unsigned_short = 5123, unsigned_int = 5125, float32 = 5126;

/// z up to glTF's y up: (x, y, z) -> (x, z, -y). Adding 0 turns -0 into +0.
vec3 to_gltf(const vec3& v) { return {v.x, v.z, -v.y + 0.0f}; }

/// A JSON number with no more digits than the value deserves.
double micro(double value) { return static_cast<double>(std::llround(value * 1e6)) / 1e6; }
Json json_of(const vec3& v) { return Json::array({micro(v.x), micro(v.y), micro(v.z)}); }

void append_u32(std::vector<std::byte>& out, uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::byte>(value >> shift & 0xffu));
}

}  // namespace

int GlbWriter::view(const void* data, size_t bytes, int target) {
  while (binary_.size() % 4 != 0) binary_.push_back(std::byte{0});
  Json view{{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}};
  if (target != 0) view["target"] = target;
  const std::byte* const first = static_cast<const std::byte*>(data);
  binary_.insert(binary_.end(), first, first + bytes);
  root_["bufferViews"].push_back(view);
  return static_cast<int>(root_["bufferViews"].size()) - 1;
}

int GlbWriter::accessor(int buffer_view, int component_type, size_t count, const char* type) {
  root_["accessors"].push_back(
      {{"bufferView", buffer_view}, {"componentType", component_type}, {"count", count}, {"type", type}});
  return static_cast<int>(root_["accessors"].size()) - 1;
}

int GlbWriter::add_mesh(const std::string& name, const MeshBuilder& mesh) {
  GREATX_CHECK(!mesh.empty(), "mesh \"{}\" is empty", name);
  Json primitives = Json::array();
  for (const PrimitiveData& data : mesh.primitives()) {
    const size_t count = data.positions.size();
    std::vector<vec3> positions(count), normals(count);
    std::transform(data.positions.begin(), data.positions.end(), positions.begin(), to_gltf);
    std::transform(data.normals.begin(), data.normals.end(), normals.begin(), to_gltf);
    vec3 low = positions[0], high = positions[0];
    for (const vec3& p : positions) low = glm::min(low, p), high = glm::max(high, p);

    const int position = accessor(view(positions.data(), 12 * count, array_buffer), float32, count, "VEC3");
    // Exactly the float's value: a validator compares them bit by bit.
    root_["accessors"][static_cast<size_t>(position)]["min"] = {low.x, low.y, low.z};
    root_["accessors"][static_cast<size_t>(position)]["max"] = {high.x, high.y, high.z};
    const int normal = accessor(view(normals.data(), 12 * count, array_buffer), float32, count, "VEC3");
    const int uv = accessor(view(data.uvs.data(), 8 * count, array_buffer), float32, count, "VEC2");
    int indices = 0;
    if (count < 65535) {
      const std::vector<uint16_t> narrow(data.indices.begin(), data.indices.end());
      indices = accessor(view(narrow.data(), 2 * narrow.size(), element_array_buffer), unsigned_short,
                         narrow.size(), "SCALAR");
    } else {
      indices = accessor(view(data.indices.data(), 4 * data.indices.size(), element_array_buffer),
                         unsigned_int, data.indices.size(), "SCALAR");
    }
    primitives.push_back({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}},
                          {"indices", indices},
                          {"material", gltf_material(data.material)}});
  }
  root_["meshes"].push_back({{"name", name}, {"primitives", primitives}});
  return static_cast<int>(root_["meshes"].size()) - 1;
}

int GlbWriter::add_node(const NodeSpec& node) {
  Json json{{"name", node.name}};
  if (node.mesh >= 0) json["mesh"] = node.mesh;
  const dvec3 p = snap(node.position);
  if (p != dvec3(0.0)) json["translation"] = {p.x, p.z, -p.y + 0.0};
  // Rounded to float, so that the last bit of a sine does not show.
  const auto narrow = [](double value) { return static_cast<double>(static_cast<float>(value)); };
  if (node.shine != dvec3(0.0)) {
    // The rotation that takes -z, where a light looks (KHR_lights_punctual), to `shine` by the shortest way.
    const dvec3 d = glm::normalize(dvec3(node.shine.x, node.shine.z, -node.shine.y));
    const dvec3 axis = glm::cross(dvec3(0.0, 0.0, -1.0), d);
    const double w = 1.0 - d.z, length = std::sqrt(w * w + glm::dot(axis, axis));
    GREATX_CHECK(length > 1e-6, "node \"{}\" shines straight back", node.name);
    json["rotation"] = {narrow(axis.x / length), narrow(axis.y / length), narrow(axis.z / length),
                        narrow(w / length)};
  } else if (node.yaw != 0.0)
    json["rotation"] = {0.0, narrow(std::sin(node.yaw / 2)), 0.0, narrow(std::cos(node.yaw / 2))};
  if (node.scale != 1.0) json["scale"] = std::vector<double>(3, snap(node.scale));
  if (node.semantic_class != SemanticClass::unlabeled)
    json["extras"] = {{"greatx_class", name_of(node.semantic_class)}};
  if (node.light >= 0) json["extensions"] = {{"KHR_lights_punctual", {{"light", node.light}}}};
  root_["nodes"].push_back(json);
  const int index = static_cast<int>(root_["nodes"].size()) - 1;
  if (node.parent < 0)
    root_["scenes"][0]["nodes"].push_back(index);
  else
    root_["nodes"][static_cast<size_t>(node.parent)]["children"].push_back(index);
  return index;
}

double LightSpec::flux_lm() const {
  if (outer_cone == 0.0) return 4.0 * pi * intensity_cd;
  const double inner = std::cos(inner_cone), outer = std::cos(outer_cone);
  return 2.0 * pi * intensity_cd * (1.0 - inner + (inner - outer) / 3.0);
}

int GlbWriter::add_light(const LightSpec& light) {
  Json& lights = root_["extensions"]["KHR_lights_punctual"]["lights"];
  const bool spot = light.outer_cone > 0.0;
  Json json{
      {"type", spot ? "spot" : "point"},
      {"color", json_of(light.color / std::max({light.color.x, light.color.y, light.color.z}))},
      {"intensity", micro(light.intensity_cd * std::max({light.color.x, light.color.y, light.color.z}))},
      {"range", light.range_m}};
  if (spot)
    json["spot"] = {{"innerConeAngle", micro(light.inner_cone)}, {"outerConeAngle", micro(light.outer_cone)}};
  lights.push_back(json);
  return static_cast<int>(lights.size()) - 1;
}

GlbWriter::Textures& GlbWriter::textures_of(const std::string& name) { return textures_[name]; }

const Picture& GlbWriter::picture(const std::string& name) {
  const auto found = pictures_.find(name);
  return found != pictures_.end() ? found->second : pictures_[name] = make_texture(name);
}

int GlbWriter::texture(int& index, const std::string& name, const Raster& raster, bool exact) {
  if (index >= 0 || raster.empty()) return index;
  const std::vector<std::byte> png = encode_png(raster.width, raster.height, raster.rgb, exact);
  root_["images"].push_back(
      {{"name", name}, {"mimeType", "image/png"}, {"bufferView", view(png.data(), png.size(), 0)}});
  root_["textures"].push_back({{"sampler", 0}, {"source", root_["images"].size() - 1}});
  return index = static_cast<int>(root_["textures"].size()) - 1;
}

int GlbWriter::gltf_material(int library_index) {
  const auto found = materials_.find(library_index);
  if (found != materials_.end()) return found->second;
  const MaterialSpec& spec = material_library()[static_cast<size_t>(library_index)];
  const Json base = json_of(spec.color);
  Json pbr{{"baseColorFactor", {base[0], base[1], base[2], 1.0}},
           {"metallicFactor", micro(spec.metallic)},
           {"roughnessFactor", micro(spec.roughness)}};
  Json json{{"name", spec.name}};
  if (!spec.texture.empty()) {
    const Picture& painted = picture(spec.texture);
    Textures& known = textures_of(spec.texture);
    pbr["baseColorTexture"] = {{"index", texture(known.color, spec.texture, painted.color)}};
    const int surface = texture(known.surface, spec.texture + "_surface", painted.metallic_roughness);
    if (surface >= 0) pbr["metallicRoughnessTexture"] = {{"index", surface}};
    if (spec.relief)
      json["normalTexture"] = {
          {"index", texture(known.normal, spec.texture + "_normal", painted.normal, true)}};
    if (spec.lit >= 0) {
      const size_t evening = static_cast<size_t>(spec.lit);
      const std::string name = fmt::format("{}_lit_{}", spec.texture, spec.lit);
      json["emissiveTexture"] = {{"index", texture(known.lit[evening], name, painted.lit[evening], true)}};
    }
  }
  json["pbrMetallicRoughness"] = pbr;
  json["extensions"]["GREATX_radio_material"] = Json::parse(spec.radio);
  const float strength = std::max({spec.emissive.x, spec.emissive.y, spec.emissive.z, 1.0f});
  if (spec.emissive != vec3(0.0f)) json["emissiveFactor"] = json_of(spec.emissive / strength);
  if (strength > 1.0f)
    json["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", micro(strength)}};
  root_["materials"].push_back(json);
  const int index = static_cast<int>(root_["materials"].size()) - 1;
  materials_[library_index] = index;
  return index;
}

std::vector<std::byte> GlbWriter::finish(const std::string& scene_name) {
  while (binary_.size() % 4 != 0) binary_.push_back(std::byte{0});
  Json out{{"asset", {{"version", "2.0"}, {"generator", "greatx scene generator"}}}, {"scene", 0}};
  Json used = Json::array({"GREATX_radio_material"});
  if (root_.contains("extensions")) used.push_back("KHR_lights_punctual");
  for (const Json& m : root_["materials"])
    if (m["extensions"].contains("KHR_materials_emissive_strength")) {
      used.push_back("KHR_materials_emissive_strength");
      break;
    }
  out["extensionsUsed"] = used;
  root_["scenes"][0]["name"] = scene_name;
  if (root_.contains("textures"))
    root_["samplers"] =
        Json::array({{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}}});
  root_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
  for (const auto& [key, value] : root_.items()) out[key] = value;

  std::string text = out.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<std::byte> glb;
  glb.reserve(28 + text.size() + binary_.size());
  for (const uint32_t word : {0x46546C67u, 2u, static_cast<uint32_t>(28 + text.size() + binary_.size()),
                              static_cast<uint32_t>(text.size()), 0x4E4F534Au})
    append_u32(glb, word);
  const auto* const first = reinterpret_cast<const std::byte*>(text.data());
  glb.insert(glb.end(), first, first + text.size());
  for (const uint32_t word : {static_cast<uint32_t>(binary_.size()), 0x004E4942u}) append_u32(glb, word);
  glb.insert(glb.end(), binary_.begin(), binary_.end());
  return glb;
}

}  // namespace greatx::scene::generator
