// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the small glTF files of the tests of scene/.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/vec.h"
#include "scene/gltf/model.h"

namespace greatx::scene::test {

using nlohmann::json;

/// A glTF document and its one buffer. Tests may change every member of `document` before it is written.
class GltfWriter {
 public:
  json document = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", json::array()}}}}};
  std::vector<unsigned char> binary;

  int append(const char* list, json element) {
    document[list].push_back(std::move(element));
    return static_cast<int>(document[list].size()) - 1;
  }
  int view(std::span<const unsigned char> bytes) {
    binary.resize((binary.size() + 3) / 4 * 4);
    const size_t offset = binary.size();
    binary.insert(binary.end(), bytes.begin(), bytes.end());
    return append("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
  }
  template <typename T>
  int accessor(const std::vector<T>& values, const char* type, int component_type, size_t count) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    return append("accessors", {{"bufferView", view({bytes, values.size() * sizeof(T)})},
                                {"componentType", component_type},
                                {"count", count},
                                {"type", type}});
  }
  int vec2s(const std::vector<vec2>& values) { return accessor(values, "VEC2", 5126, values.size()); }
  int vec3s(const std::vector<vec3>& values) { return accessor(values, "VEC3", 5126, values.size()); }
  int vec4s(const std::vector<vec4>& values) { return accessor(values, "VEC4", 5126, values.size()); }
  int indices8(const std::vector<uint8_t>& values) { return accessor(values, "SCALAR", 5121, values.size()); }
  int indices16(const std::vector<uint16_t>& values) {
    return accessor(values, "SCALAR", 5123, values.size());
  }
  int indices32(const std::vector<uint32_t>& values) {
    return accessor(values, "SCALAR", 5125, values.size());
  }
  int material(json fields) { return append("materials", std::move(fields)); }
  /// Adds a material whose name gives its radio properties.
  int itu_material(const std::string& name = "itu_concrete") { return material({{"name", name}}); }
  int mesh(const std::string& name, json primitives) {
    return append("meshes", {{"name", name}, {"primitives", std::move(primitives)}});
  }
  int root(json node) {
    const int index = append("nodes", std::move(node));
    document["scenes"][0]["nodes"].push_back(index);
    return index;
  }
  /// Adds a mesh of indexed triangles with positions alone, placed by a root node of the same name.
  int add_triangles(const std::string& name, const std::vector<vec3>& positions,
                    const std::vector<uint32_t>& indices, int material_index) {
    const json primitive = {{"attributes", {{"POSITION", vec3s(positions)}}},
                            {"indices", indices32(indices)},
                            {"material", material_index}};
    return root({{"name", name}, {"mesh", mesh(name, json::array({primitive}))}});
  }

  std::vector<unsigned char> glb() const {
    json copy = document;
    if (!binary.empty()) copy["buffers"] = json::array({{{"byteLength", binary.size()}}});
    return pack(copy.dump(), binary);
  }
  static std::vector<unsigned char> pack(std::string text, std::vector<unsigned char> bytes) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    bytes.resize((bytes.size() + 3) / 4 * 4);
    std::vector<unsigned char> out;
    const auto put = [&](size_t value) {
      for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<unsigned char>(value >> shift));
    };
    put(0x46546C67), put(2), put(20 + text.size() + (bytes.empty() ? 0 : 8 + bytes.size()));
    put(text.size()), put(0x4E4F534A);
    out.insert(out.end(), text.begin(), text.end());
    if (!bytes.empty()) {
      put(bytes.size()), put(0x004E4942);
      out.insert(out.end(), bytes.begin(), bytes.end());
    }
    return out;
  }
  Model load(const LoadOptions& options = {}) const { return load_bytes(glb(), options); }
  static Model load_bytes(const std::vector<unsigned char>& bytes, const LoadOptions& options = {}) {
    return load_model("test.glb", std::as_bytes(std::span(bytes)), options);
  }
};

/// A folder for one test, removed at its end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string pattern =
        (std::filesystem::temp_directory_path() /
         (std::string("greatx_") + info->test_suite_name() + "_" + info->name() + "_XXXXXX"))
            .string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("mkdtemp");
    path = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path write(const std::string& name, std::span<const unsigned char> bytes) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return path / name;
  }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    return write(name, std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
  }

  std::filesystem::path path;
};

/// Expects that `action` throws a UserError whose message contains every one of `parts`.
inline void expect_user_error(const std::function<void()>& action, const std::vector<std::string>& parts) {
  try {
    action();
    FAIL() << "no error; expected one with '" << parts.front() << "'";
  } catch (const UserError& error) {
    for (const std::string& part : parts) EXPECT_THAT(error.what(), testing::HasSubstr(part));
  }
}

inline const std::vector<vec3>& unit_quad() {
  static const std::vector<vec3> corners = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)};
  return corners;
}
inline const std::vector<uint32_t>& quad_indices() {
  static const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};
  return indices;
}
inline bool has_note(const std::vector<std::string>& notes, const std::string& part) {
  for (const std::string& note : notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

}  // namespace greatx::scene::test
