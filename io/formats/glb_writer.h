// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// glTF 2.0 binary (Khronos glTF 2.0.1, chapter 4) for looking at results elsewhere: lines and triangles with plain
// colours. Everything is given with z up and written with glTF's y up: (x, y, z) -> (x, z, -y).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "io/files/file.h"

namespace greatx::io {

struct GlbMaterial {
  std::string name;
  vec3 base_color{1.0f};  ///< linear Rec. 709; times the vertices' colours
  float metallic = 0.0f, roughness = 1.0f;
  bool unlit = false;  ///< KHR_materials_unlit: shown as it is, whatever the light
  bool double_sided = false;
  std::string extensions_json;  ///< one JSON object, extension by name, or empty; the file lists them as used
};

struct GlbPrimitive {
  enum class Mode : int { lines = 1, triangles = 4 } mode = Mode::triangles;
  int material = -1;            ///< of add_material
  std::vector<vec3> positions;  ///< m; one at least
  std::vector<vec3> normals;    ///< unit, [positions] or empty
  std::vector<vec3> colors;     ///< linear Rec. 709, [positions] or empty
  std::vector<uint32_t> indices;
};

struct GlbNode {
  std::string name;
  int mesh = -1;            ///< of add_mesh; -1: none
  int parent = -1;          ///< of add_node; -1: the scene
  Pose pose;                ///< parent_from_node
  std::string extras_json;  ///< one JSON object, or empty
};

/// The same calls give the same bytes.
class GlbWriter {
 public:
  GlbWriter();
  ~GlbWriter();
  GlbWriter(const GlbWriter&) = delete;
  GlbWriter& operator=(const GlbWriter&) = delete;

  int add_material(const GlbMaterial& material);
  /// Indices must be below the number of positions; lines come in pairs, triangles in threes.
  int add_mesh(const std::string& name, const std::vector<GlbPrimitive>& primitives);
  int add_node(const GlbNode& node);
  /// The whole file. Throws UserError if it is beyond the 4 GiB of the format.
  Bytes finish(const std::string& scene_name, const std::string& scene_extras_json = "");

 private:
  int add_view(std::span<const std::byte> bytes, int target);
  template <typename T>
  int add_accessor(const std::vector<T>& values, int component_type, const char* type, int target);

  struct Document;
  std::unique_ptr<Document> document_;
};

}  // namespace greatx::io
