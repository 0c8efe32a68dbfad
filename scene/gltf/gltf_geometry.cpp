// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gltf_geometry.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "scene/gltf/gltf_accessor.h"

namespace greatx::scene {
namespace {

template <typename Vec>
std::vector<Vec> read_vectors(const GltfFile& file, int accessor, const std::string& what,
                              GeometryMemory& memory) {
  const std::vector<float> floats = read_floats(file, accessor, Vec::length(), what, memory);
  std::vector<Vec> vectors(floats.size() / static_cast<size_t>(Vec::length()));
  for (size_t index = 0; index < vectors.size(); ++index) {
    for (int axis = 0; axis < Vec::length(); ++axis) {
      const float value = floats[index * static_cast<size_t>(Vec::length()) + static_cast<size_t>(axis)];
      if (!std::isfinite(value) && !file.keep_faults)
        throw_user_error("{}: vertex {} is not finite ({})", what, index, value);
      vectors[index][axis] = value;
    }
  }
  return vectors;
}

/// Turns strips and fans into triangles with the same winding (glTF 2.0, section 3.7.2.1).
std::vector<uint32_t> unroll(std::vector<uint32_t> corners, int mode, const std::string& what,
                             GeometryMemory& memory) {
  if (mode == TINYGLTF_MODE_TRIANGLES || corners.size() < 3) return corners;
  memory.all.plan(what + ", its strip or fan", 2 * sizeof(uint32_t) * corners.size());
  std::vector<uint32_t> triangles;
  triangles.reserve((corners.size() - 2) * 3);
  for (size_t index = 0; index + 2 < corners.size(); ++index) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
      triangles.insert(triangles.end(), {corners[index + 1], corners[index + 2], corners[0]});
    } else {
      const size_t swap = index % 2;
      triangles.insert(triangles.end(),
                       {corners[index], corners[index + 1 + swap], corners[index + 2 - swap]});
    }
  }
  return triangles;
}

/// Returns whether the area is exactly zero. The differences of floats are exact in double here, and so is a
/// product that is zero.
bool is_degenerate(const vec3& a, const vec3& b, const vec3& c) {
  return glm::cross(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a)) == dvec3(0.0);
}

/// Returns the number of triangles that were dropped.
size_t drop_degenerate(ModelPrimitive& primitive) {
  size_t kept = 0;
  auto& indices = primitive.indices;
  for (size_t first = 0; first < indices.size(); first += 3) {
    const uint32_t a = indices[first], b = indices[first + 1], c = indices[first + 2];
    if (is_degenerate(primitive.positions[a], primitive.positions[b], primitive.positions[c])) continue;
    indices[kept] = a, indices[kept + 1] = b, indices[kept + 2] = c;
    kept += 3;
  }
  const size_t dropped = (indices.size() - kept) / 3;
  indices.resize(kept);
  return dropped;
}

/// Returns the set of texture coordinates that the material's maps use. Several sets in one material are not
/// supported; a note says so.
int uv_set_of(const GltfFile& file, int material, const std::string& what, std::vector<std::string>& notes) {
  if (material < 0 || static_cast<size_t>(material) >= file.model.materials.size()) return 0;
  const tinygltf::Material& source = file.model.materials[static_cast<size_t>(material)];
  std::vector<int> sets;
  const auto add = [&](const auto& texture) {
    if (texture.index >= 0) sets.push_back(texture.texCoord);
  };
  add(source.pbrMetallicRoughness.baseColorTexture);
  add(source.pbrMetallicRoughness.metallicRoughnessTexture);
  add(source.normalTexture);
  add(source.emissiveTexture);
  if (sets.empty()) return 0;
  if (std::any_of(sets.begin(), sets.end(), [&](int set) { return set != sets.front(); })) {
    notes.push_back(
        fmt::format("{}: material '{}' uses several texture coordinate sets; TEXCOORD_{} serves them all",
                    what, source.name, sets.front()));
  }
  return sets.front();
}

int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

template <typename Vec>
std::vector<Vec> read_optional(const GltfFile& file, const tinygltf::Primitive& source,
                               const std::string& name, size_t vertex_count, const std::string& what,
                               GeometryMemory& memory) {
  const int accessor = attribute(source, name);
  if (accessor < 0) return {};
  auto values = read_vectors<Vec>(file, accessor, what + ", " + name, memory);
  if (values.size() != vertex_count) {
    throw_user_error("{}: {} has {} elements, POSITION has {}", what, name, values.size(), vertex_count);
  }
  return values;
}

std::vector<uint32_t> read_corners(const GltfFile& file, const tinygltf::Primitive& source,
                                   size_t vertex_count, const std::string& what, GeometryMemory& memory) {
  if (source.indices < 0) {
    memory.all.plan(what + ", its indices", sizeof(uint32_t) * vertex_count);
    std::vector<uint32_t> corners(vertex_count);
    for (size_t index = 0; index < vertex_count; ++index) corners[index] = static_cast<uint32_t>(index);
    return corners;
  }
  std::vector<uint32_t> corners = read_indices(file, source.indices, what + ", indices", memory);
  for (size_t index = 0; index < corners.size(); ++index) {
    if (corners[index] >= vertex_count) {
      throw_user_error("{}: index {} at position {} is out of range (the primitive has {} vertices)", what,
                       corners[index], index, vertex_count);
    }
  }
  return corners;
}

/// Normalizes the normals. A primitive with a normal of length zero gets flat normals instead.
void normalize_normals(ModelPrimitive& primitive, const std::string& what, std::vector<std::string>& notes) {
  for (vec3& normal : primitive.normals) {
    const double length = glm::length(dvec3(normal));
    if (length < 1e-12) {
      notes.push_back(what + ": a normal has no length; flat normals are made for the whole primitive");
      primitive.normals.clear();
      primitive.tangents.clear();
      return;
    }
    normal = vec3(dvec3(normal) / length);
  }
}

ModelPrimitive read_primitive(const GltfFile& file, const tinygltf::Primitive& source,
                              const std::string& what, size_t& dropped, std::vector<std::string>& notes,
                              GeometryMemory& memory) {
  const int position = attribute(source, "POSITION");
  if (position < 0) throw_user_error("{}: it has no POSITION attribute", what);
  ModelPrimitive primitive;
  primitive.positions = read_vectors<vec3>(file, position, what + ", POSITION", memory);
  const size_t count = primitive.positions.size();
  if (count == 0) throw_user_error("{}: it has no vertices", what);
  primitive.normals = read_optional<vec3>(file, source, "NORMAL", count, what, memory);
  normalize_normals(primitive, what, notes);
  // Without normals, given tangents must be ignored (glTF 2.0, section 3.7.2.1).
  if (!primitive.normals.empty())
    primitive.tangents = read_optional<vec4>(file, source, "TANGENT", count, what, memory);
  const std::string uv_name = fmt::format("TEXCOORD_{}", uv_set_of(file, source.material, what, notes));
  primitive.uvs = read_optional<vec2>(file, source, uv_name, count, what, memory);
  if (attribute(source, "COLOR_0") >= 0) notes.push_back(what + ": vertex colours are ignored");
  if (!source.targets.empty()) notes.push_back(what + ": morph targets are ignored");

  primitive.indices = unroll(read_corners(file, source, count, what, memory), source.mode, what, memory);
  if (primitive.indices.empty() || primitive.indices.size() % 3 != 0) {
    throw_user_error("{}: {} corners make no whole number of triangles", what, primitive.indices.size());
  }
  if (!file.keep_faults) dropped += drop_degenerate(primitive);

  const int material = source.material;
  if (material >= 0 && static_cast<size_t>(material) >= file.model.materials.size()) {
    throw_user_error("{}: material {} does not exist (the file has {})", what, material,
                     file.model.materials.size());
  }
  primitive.material = material < 0 ? no_material : static_cast<uint32_t>(material);
  return primitive;
}

}  // namespace

std::string mesh_name(const GltfFile& file, size_t mesh) {
  const std::string& name = file.model.meshes[mesh].name;
  return name.empty() ? fmt::format("mesh {}", mesh) : name;
}

ModelMesh read_mesh(const GltfFile& file, size_t mesh_index, std::vector<std::string>& notes,
                    GeometryMemory& memory) {
  const tinygltf::Mesh& source = file.model.meshes[mesh_index];
  ModelMesh mesh;
  mesh.name = mesh_name(file, mesh_index);
  const std::string where = fmt::format("{}: mesh '{}'", file.name, printable(mesh.name));
  if (source.primitives.empty()) throw_user_error("{} is empty: it has no primitives", where);

  size_t dropped = 0, skipped = 0;
  for (size_t index = 0; index < source.primitives.size(); ++index) {
    const int mode = source.primitives[index].mode;
    if (mode < TINYGLTF_MODE_POINTS || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
      throw_user_error("{}, primitive {}: mode {}, expected 0 to 6", where, index, mode);
    }
    if (mode < TINYGLTF_MODE_TRIANGLES) {
      ++skipped;
      continue;
    }
    const std::string what = fmt::format("{}, primitive {}", where, index);
    ModelPrimitive primitive = read_primitive(file, source.primitives[index], what, dropped, notes, memory);
    if (!primitive.indices.empty()) mesh.primitives.push_back(std::move(primitive));
  }
  if (skipped > 0)
    notes.push_back(fmt::format("{}: {} primitives of points or lines are skipped", where, skipped));
  if (dropped > 0 && mesh.primitives.empty()) {
    throw_user_error("{} has nothing but {} triangles of zero area", where, dropped);
  }
  if (dropped > 0) notes.push_back(fmt::format("{}: {} triangles of zero area are dropped", where, dropped));
  return mesh;
}

}  // namespace greatx::scene
