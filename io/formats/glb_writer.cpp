// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/glb_writer.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

namespace greatx::io {

namespace {

using Json = nlohmann::ordered_json;

constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr int no_target = 0;  // for views that hold pictures
constexpr int unsigned_short = 5123, unsigned_int = 5125, float32 = 5126;
constexpr size_t most_narrow_vertices = 65534;  // the index 65535 may restart a primitive
constexpr const char* unlit_extension = "KHR_materials_unlit";
constexpr const char* strength_extension = "KHR_materials_emissive_strength";
constexpr const char* lights_extension = "KHR_lights_punctual";

/// Converts from z up to glTF's y up. Adding 0 turns -0 into +0.
template <typename Vec>
Vec to_gltf(const Vec& v) {
  return {v.x, v.z, -v.y + 0};
}

std::vector<vec3> to_gltf(const std::vector<vec3>& vectors) {
  std::vector<vec3> out(vectors.size());
  std::transform(vectors.begin(), vectors.end(), out.begin(), [](const vec3& v) { return to_gltf(v); });
  return out;
}

template <typename Vec>
Json json_of(const Vec& v) {
  return Json::array({v.x, v.y, v.z});
}

/// Rounds to float. The value goes through memory, because GCC 12.2 drops the two conversions if it
/// vectorises two neighbouring values (seen with x86-64, -O2, two members of a quaternion).
double narrow(double value) {
  const volatile float rounded = static_cast<float>(value);
  return static_cast<double>(rounded);
}

/// Returns the shortest rotation in glTF's axes that turns -z, the direction of glTF's lights, to `aim` (z
/// up).
dquat rotation_to(const dvec3& aim, const std::string& node) {
  const dvec3 d = glm::normalize(dvec3(aim.x, aim.z, -aim.y));
  const dvec3 axis = glm::cross(dvec3(0.0, 0.0, -1.0), d);
  const double w = 1.0 - d.z, length = std::sqrt(w * w + glm::dot(axis, axis));
  GREATX_CHECK(length > 1e-6, "node '{}' aims straight back", node);
  return {w / length, axis.x / length, axis.y / length, axis.z / length};
}

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
  GREATX_CHECK(primitive.uvs.empty() || primitive.uvs.size() == count, "mesh '{}': {} texture coordinates",
               mesh, primitive.uvs.size());
  GREATX_CHECK(primitive.colors.empty() || primitive.colors.size() == count, "mesh '{}': {} colours", mesh,
               primitive.colors.size());
  for (const uint32_t index : primitive.indices)
    GREATX_CHECK(index < count, "mesh '{}': index {} of {}", mesh, index, count);
}

/// Returns the file: the header, the JSON chunk and, if it is not empty, the binary chunk.
Bytes packed(std::string text, const Bytes& binary) {
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

}  // namespace

/// Holds the file while it is built. The root has all lists from the beginning, which fixes their order;
/// finish() drops the empty ones.
struct GlbWriter::Document {
  explicit Document(const GlbOptions& options) {
    root = {{"asset", {{"version", "2.0"}, {"generator", options.generator}}}, {"scene", 0}};
    static constexpr std::initializer_list<const char*> from_the_data = {
        "extensionsUsed", "bufferViews", "accessors", "images",     "textures", "materials",
        "meshes",         "nodes",       "scenes",    "extensions", "samplers", "buffers"};
    static constexpr std::initializer_list<const char*> from_the_scene = {
        "scenes",   "extensionsUsed", "extensions", "nodes",     "meshes",      "materials",
        "textures", "images",         "samplers",   "accessors", "bufferViews", "buffers"};
    for (const char* const list : options.compact ? from_the_data : from_the_scene)
      root[list] = Json::array();
    root["scenes"].push_back(options.compact ? Json{{"nodes", Json::array()}}
                                             : Json{{"name", ""}, {"nodes", Json::array()}});
  }

  int add(const char* list, Json entry) {
    Json& entries = root[list];
    entries.push_back(std::move(entry));
    return static_cast<int>(entries.size()) - 1;
  }
  void pad() { binary.resize((binary.size() + 3) / 4 * 4); }

  Json root, lights = Json::array();
  std::set<std::string> extensions;  ///< names of the used extensions
  Bytes binary;
};

GlbWriter::GlbWriter(const GlbOptions& options)
    : options_(options), document_(std::make_unique<Document>(options)) {}
GlbWriter::~GlbWriter() = default;

int GlbWriter::add_view(std::span<const std::byte> bytes, int target) {
  document_->pad();
  Bytes& binary = document_->binary;
  Json view{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
  if (target != no_target) view["target"] = target;
  append(binary, bytes);
  return document_->add("bufferViews", std::move(view));
}

template <typename T>
int GlbWriter::add_accessor(const std::vector<T>& values, int component_type, const char* type, int target) {
  const int view = add_view(std::as_bytes(std::span(values)), target);
  return document_->add(
      "accessors",
      {{"bufferView", view}, {"componentType", component_type}, {"count", values.size()}, {"type", type}});
}

int GlbWriter::add_texture(const std::string& name, std::span<const std::byte> png) {
  const int view = add_view(png, no_target);
  const int image =
      document_->add("images", {{"name", name}, {"mimeType", "image/png"}, {"bufferView", view}});
  constexpr int linear = 9729, linear_mipmap_linear = 9987, repeat = 10497;
  if (document_->root["samplers"].empty())
    document_->add(
        "samplers",
        {{"magFilter", linear}, {"minFilter", linear_mipmap_linear}, {"wrapS", repeat}, {"wrapT", repeat}});
  return document_->add("textures", {{"sampler", 0}, {"source", image}});
}

int GlbWriter::add_material(const GlbMaterial& material) {
  Json json{{"name", material.name}};
  const auto use = [](Json& object, const char* key, int texture) {
    if (texture >= 0) object[key] = {{"index", texture}};
  };
  use(json, "normalTexture", material.normal_texture);
  use(json, "emissiveTexture", material.emissive_texture);
  Json& pbr = json["pbrMetallicRoughness"];
  pbr = {{"baseColorFactor", {material.base_color.r, material.base_color.g, material.base_color.b, 1.0}},
         {"metallicFactor", material.metallic},
         {"roughnessFactor", material.roughness}};
  use(pbr, "baseColorTexture", material.base_color_texture);
  use(pbr, "metallicRoughnessTexture", material.metallic_roughness_texture);
  if (material.double_sided) json["doubleSided"] = true;
  if (material.holes) json["alphaMode"] = "MASK";  // glTF's cut-off is 0.5 unless the file gives another one
  Json extensions = material.extensions_json.empty() ? Json::object() : Json::parse(material.extensions_json);
  if (material.unlit) extensions[unlit_extension] = Json::object();
  if (material.emissive_strength != 1.0)
    extensions[strength_extension] = {{"emissiveStrength", material.emissive_strength}};
  for (const auto& [name, fields] : extensions.items()) document_->extensions.insert(name);
  if (!extensions.empty()) json["extensions"] = std::move(extensions);
  if (material.emissive != dvec3(0.0)) json["emissiveFactor"] = json_of(material.emissive);
  return document_->add("materials", std::move(json));
}

int GlbWriter::add_mesh(const std::string& name) {
  return document_->add("meshes", {{"name", name}, {"primitives", Json::array()}});
}

int GlbWriter::add_mesh(const std::string& name, const std::vector<GlbPrimitive>& primitives) {
  GREATX_CHECK(!primitives.empty(), "mesh '{}' has no primitive", name);
  const int mesh = add_mesh(name);
  for (const GlbPrimitive& primitive : primitives) add_primitive(mesh, primitive);
  return mesh;
}

void GlbWriter::add_primitive(int mesh, const GlbPrimitive& primitive) {
  Json& owner = document_->root["meshes"].at(static_cast<size_t>(mesh));
  check(owner["name"].get<std::string>(), primitive);
  const std::vector<vec3> positions = to_gltf(primitive.positions);
  vec3 low = positions[0], high = positions[0];
  for (const vec3& p : positions) low = glm::min(low, p), high = glm::max(high, p);
  const int position = add_accessor(positions, float32, "VEC3", array_buffer);
  // The bounds are exactly the values of the floats, because a validator compares them bit by bit.
  Json& accessor = document_->root["accessors"].back();
  accessor["min"] = json_of(low);
  accessor["max"] = json_of(high);
  Json json{{"attributes", {{"POSITION", position}}}};
  if (!primitive.normals.empty())
    json["attributes"]["NORMAL"] = add_accessor(to_gltf(primitive.normals), float32, "VEC3", array_buffer);
  if (!primitive.uvs.empty())
    json["attributes"]["TEXCOORD_0"] = add_accessor(primitive.uvs, float32, "VEC2", array_buffer);
  if (!primitive.colors.empty())
    json["attributes"]["COLOR_0"] = add_accessor(primitive.colors, float32, "VEC3", array_buffer);
  if (options_.compact && positions.size() <= most_narrow_vertices) {
    const std::vector<uint16_t> narrow(primitive.indices.begin(), primitive.indices.end());
    json["indices"] = add_accessor(narrow, unsigned_short, "SCALAR", element_array_buffer);
  } else {
    json["indices"] = add_accessor(primitive.indices, unsigned_int, "SCALAR", element_array_buffer);
  }
  if (!options_.compact || primitive.mode != GlbPrimitive::Mode::triangles)
    json["mode"] = static_cast<int>(primitive.mode);
  if (primitive.material >= 0) json["material"] = primitive.material;
  owner["primitives"].push_back(std::move(json));
}

int GlbWriter::add_light(const GlbLight& light) {
  const bool spot = light.outer_cone > 0.0;
  Json json{{"type", spot ? "spot" : "point"},
            {"color", json_of(light.color)},
            {"intensity", light.intensity_cd},
            {"range", light.range_m}};
  if (spot) json["spot"] = {{"innerConeAngle", light.inner_cone}, {"outerConeAngle", light.outer_cone}};
  if (light.passing_beam) json["extras"] = {{"greatx_beam", "passing"}};
  document_->extensions.insert(lights_extension);
  document_->lights.push_back(std::move(json));
  return static_cast<int>(document_->lights.size()) - 1;
}

int GlbWriter::add_node(const GlbNode& node) {
  Json json{{"name", node.name}};
  if (node.mesh >= 0) json["mesh"] = node.mesh;
  const dvec3 position = to_gltf(node.pose.position);
  if (position != dvec3(0.0)) json["translation"] = json_of(position);
  const auto rotate = [&](const dvec3& axis, double w) {
    json["rotation"] = options_.compact ? Json{narrow(axis.x), narrow(axis.y), narrow(axis.z), narrow(w)}
                                        : Json{axis.x, axis.y, axis.z, w};
  };
  const dquat& q = node.pose.orientation;
  if (node.aim != dvec3(0.0)) {
    const dquat aimed = rotation_to(node.aim, node.name);
    rotate({aimed.x, aimed.y, aimed.z}, aimed.w);
  } else if (const dvec3 axis = to_gltf(dvec3(q.x, q.y, q.z)); axis != dvec3(0.0)) {
    rotate(axis, q.w);
  }
  if (node.scale) json["scale"] = std::vector<double>(3, *node.scale);
  if (!node.extras_json.empty()) json["extras"] = Json::parse(node.extras_json);
  if (node.light >= 0) json["extensions"] = {{lights_extension, {{"light", node.light}}}};
  const int index = document_->add("nodes", std::move(json));
  Json& nodes = document_->root["nodes"];
  Json& parent = node.parent < 0 ? document_->root["scenes"][0]["nodes"]
                                 : nodes.at(static_cast<size_t>(node.parent))["children"];
  parent.push_back(index);
  return index;
}

Bytes GlbWriter::finish(const std::string& scene_name, const std::string& scene_extras_json) {
  document_->pad();
  const std::unique_ptr<Document> done = std::exchange(document_, std::make_unique<Document>(options_));
  Json& root = done->root;
  for (const Json& mesh : root["meshes"])
    GREATX_CHECK(!mesh["primitives"].empty(), "mesh {} has no primitive", mesh["name"].dump());
  Json& scene = root["scenes"][0];
  scene["name"] = scene_name;
  if (scene["nodes"].empty()) scene.erase("nodes");
  if (!scene_extras_json.empty()) scene["extras"] = Json::parse(scene_extras_json);
  root["extensionsUsed"] = done->extensions;
  if (!done->lights.empty()) root["extensions"] = {{lights_extension, {{"lights", std::move(done->lights)}}}};
  if (!done->binary.empty()) root["buffers"].push_back({{"byteLength", done->binary.size()}});
  // glTF allows no empty lists.
  for (auto entry = root.begin(); entry != root.end();) {
    if (entry->empty())
      entry = root.erase(entry);
    else
      ++entry;
  }
  return packed(root.dump(), done->binary);
}

}  // namespace greatx::io
