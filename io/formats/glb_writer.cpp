// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/glb_writer.h"

#include <algorithm>
#include <limits>
#include <set>

#include <nlohmann/json.hpp>

namespace greatx::io {

namespace {

using Json = nlohmann::ordered_json;

constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr int unsigned_int = 5125, float32 = 5126;
constexpr const char* unlit = "KHR_materials_unlit";

/// z up to glTF's y up. Adding 0 turns -0 into +0.
template <typename Vec>
Vec to_gltf(const Vec& v) {
  return {v.x, v.z, -v.y + 0};
}

std::vector<vec3> to_gltf(const std::vector<vec3>& vectors) {
  std::vector<vec3> out(vectors.size());
  std::transform(vectors.begin(), vectors.end(), out.begin(), [](const vec3& v) { return to_gltf(v); });
  return out;
}

Json json_of(const vec3& v) { return Json::array({v.x, v.y, v.z}); }

void append_u32(Bytes& out, uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::byte>(value >> shift & 0xffu));
}

void check(const std::string& mesh, const GlbPrimitive& primitive) {
  const size_t count = primitive.positions.size();
  const size_t corners = primitive.mode == GlbPrimitive::Mode::lines ? 2 : 3;
  GREATX_CHECK(count > 0 && !primitive.indices.empty(), "mesh '{}': an empty primitive", mesh);
  GREATX_CHECK(primitive.indices.size() % corners == 0, "mesh '{}': {} indices", mesh,
               primitive.indices.size());
  GREATX_CHECK(primitive.normals.empty() || primitive.normals.size() == count, "mesh '{}': {} normals", mesh,
               primitive.normals.size());
  GREATX_CHECK(primitive.colors.empty() || primitive.colors.size() == count, "mesh '{}': {} colours", mesh,
               primitive.colors.size());
  for (const uint32_t index : primitive.indices)
    GREATX_CHECK(index < count, "mesh '{}': index {} of {}", mesh, index, count);
}

}  // namespace

struct GlbWriter::Document {
  Json materials = Json::array(), meshes = Json::array(), nodes = Json::array(), roots = Json::array(),
       accessors = Json::array(), views = Json::array();
  std::set<std::string> extensions;  ///< used
  Bytes binary;
};

GlbWriter::GlbWriter() : document_(std::make_unique<Document>()) {}
GlbWriter::~GlbWriter() = default;

int GlbWriter::add_view(std::span<const std::byte> bytes, int target) {
  Bytes& binary = document_->binary;
  document_->views.push_back(
      {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}, {"target", target}});
  append(binary, bytes);  // every component has four bytes: offsets stay multiples of four
  return static_cast<int>(document_->views.size()) - 1;
}

template <typename T>
int GlbWriter::add_accessor(const std::vector<T>& values, int component_type, const char* type, int target) {
  const int view = add_view(std::as_bytes(std::span(values)), target);
  document_->accessors.push_back(
      {{"bufferView", view}, {"componentType", component_type}, {"count", values.size()}, {"type", type}});
  return static_cast<int>(document_->accessors.size()) - 1;
}

int GlbWriter::add_material(const GlbMaterial& material) {
  Json pbr{{"baseColorFactor", {material.base_color.r, material.base_color.g, material.base_color.b, 1.0}},
           {"metallicFactor", material.metallic},
           {"roughnessFactor", material.roughness}};
  Json json{{"name", material.name}, {"pbrMetallicRoughness", std::move(pbr)}};
  if (material.double_sided) json["doubleSided"] = true;
  if (!material.extensions_json.empty()) json["extensions"] = Json::parse(material.extensions_json);
  if (material.unlit) json["extensions"][unlit] = Json::object();
  if (json.contains("extensions"))
    for (const auto& [name, fields] : json["extensions"].items()) document_->extensions.insert(name);
  document_->materials.push_back(std::move(json));
  return static_cast<int>(document_->materials.size()) - 1;
}

int GlbWriter::add_mesh(const std::string& name, const std::vector<GlbPrimitive>& primitives) {
  GREATX_CHECK(!primitives.empty(), "mesh '{}' has no primitive", name);
  Json list = Json::array();
  for (const GlbPrimitive& primitive : primitives) {
    check(name, primitive);
    const std::vector<vec3> positions = to_gltf(primitive.positions);
    vec3 low = positions[0], high = positions[0];
    for (const vec3& p : positions) low = glm::min(low, p), high = glm::max(high, p);
    const int position = add_accessor(positions, float32, "VEC3", array_buffer);
    Json& accessor = document_->accessors.back();
    accessor["min"] = json_of(low);
    accessor["max"] = json_of(high);
    Json json{{"attributes", {{"POSITION", position}}}};
    if (!primitive.normals.empty())
      json["attributes"]["NORMAL"] = add_accessor(to_gltf(primitive.normals), float32, "VEC3", array_buffer);
    if (!primitive.colors.empty())
      json["attributes"]["COLOR_0"] = add_accessor(primitive.colors, float32, "VEC3", array_buffer);
    json["indices"] = add_accessor(primitive.indices, unsigned_int, "SCALAR", element_array_buffer);
    json["mode"] = static_cast<int>(primitive.mode);
    if (primitive.material >= 0) json["material"] = primitive.material;
    list.push_back(std::move(json));
  }
  document_->meshes.push_back({{"name", name}, {"primitives", std::move(list)}});
  return static_cast<int>(document_->meshes.size()) - 1;
}

int GlbWriter::add_node(const GlbNode& node) {
  Json json{{"name", node.name}};
  if (node.mesh >= 0) json["mesh"] = node.mesh;
  const dvec3 position = to_gltf(node.pose.position);
  if (position != dvec3(0.0)) json["translation"] = {position.x, position.y, position.z};
  const dquat& q = node.pose.orientation;
  if (const dvec3 axis = to_gltf(dvec3(q.x, q.y, q.z)); axis != dvec3(0.0))
    json["rotation"] = {axis.x, axis.y, axis.z, q.w};
  if (!node.extras_json.empty()) json["extras"] = Json::parse(node.extras_json);
  const int index = static_cast<int>(document_->nodes.size());
  document_->nodes.push_back(std::move(json));
  if (node.parent < 0)
    document_->roots.push_back(index);
  else
    document_->nodes.at(static_cast<size_t>(node.parent))["children"].push_back(index);
  return index;
}

Bytes GlbWriter::finish(const std::string& scene_name, const std::string& scene_extras_json) {
  Json scene{{"name", scene_name}};
  // glTF allows no empty lists.
  if (!document_->roots.empty()) scene["nodes"] = std::move(document_->roots);
  if (!scene_extras_json.empty()) scene["extras"] = Json::parse(scene_extras_json);
  Json root{{"asset", {{"version", "2.0"}, {"generator", "greatx " GREATX_VERSION}}},
            {"scene", 0},
            {"scenes", Json::array({std::move(scene)})}};
  if (!document_->extensions.empty()) root["extensionsUsed"] = document_->extensions;
  const auto put = [&](const char* key, Json& list) {
    if (!list.empty()) root[key] = std::move(list);
  };
  put("nodes", document_->nodes);
  put("meshes", document_->meshes);
  put("materials", document_->materials);
  put("accessors", document_->accessors);
  put("bufferViews", document_->views);
  Bytes binary = std::move(document_->binary);
  *document_ = {};
  if (!binary.empty()) root["buffers"] = Json::array({{{"byteLength", binary.size()}}});

  std::string text = root.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const uint64_t size = 20 + text.size() + (binary.empty() ? 0 : 8 + binary.size());
  if (size > std::numeric_limits<uint32_t>::max())
    throw_user_error("glb: {:.1f} GiB do not fit into one file of the format (4 GiB)",
                     static_cast<double>(size) / (1u << 30));
  Bytes glb;
  glb.reserve(size);
  for (const uint32_t word : {0x46546C67u, 2u, static_cast<uint32_t>(size)}) append_u32(glb, word);
  for (const uint32_t word : {static_cast<uint32_t>(text.size()), 0x4E4F534Au}) append_u32(glb, word);
  append(glb, bytes_of(text));
  if (!binary.empty()) {
    for (const uint32_t word : {static_cast<uint32_t>(binary.size()), 0x004E4942u}) append_u32(glb, word);
    append(glb, binary);
  }
  return glb;
}

}  // namespace greatx::io
