// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes glTF 2.0 binary files (Khronos glTF 2.0.1, chapter 4). Callers give all data with z up; the writer
// converts them to glTF's y up: (x, y, z) -> (x, z, -y).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "io/files/file.h"

namespace greatx::io {

/// Describes a material. Numbers are fp64, so that the caller decides how many digits the file has.
struct GlbMaterial {
  std::string name;
  dvec3 base_color{1.0};  ///< linear Rec. 709; multiplied by its texture and the vertex colours
  double metallic = 0.0, roughness = 1.0;
  /// Linear Rec. 709, each channel at most 1; multiplied by its texture and by `emissive_strength`.
  dvec3 emissive{0.0};
  double emissive_strength = 1.0;  ///< KHR_materials_emissive_strength
  /// Textures as returned by add_texture(); -1 stands for none.
  int base_color_texture = -1, metallic_roughness_texture = -1, normal_texture = -1, emissive_texture = -1;
  bool unlit = false;  ///< KHR_materials_unlit: shows the base colour independently of the light
  bool double_sided = false;
  /// Whether texels of the base colour's texture with an alpha below 0.5 are holes.
  bool holes = false;
  /// One JSON object with the extensions by name, or empty. The file lists these extensions as used.
  std::string extensions_json;
};

struct GlbPrimitive {
  enum class Mode : int { lines = 1, triangles = 4 } mode = Mode::triangles;
  int material = -1;            ///< index of add_material(), which may be called later; -1: none
  std::vector<vec3> positions;  ///< m; at least one
  std::vector<vec3> normals;    ///< unit, [positions] or empty
  std::vector<vec2> uvs;        ///< [positions] or empty
  std::vector<vec3> colors;     ///< linear Rec. 709, [positions] or empty
  std::vector<uint32_t> indices;
};

/// Describes a light of KHR_lights_punctual. Lights have no names, because readers use the name of the node.
struct GlbLight {
  dvec3 color{1.0};  ///< linear Rec. 709
  double intensity_cd = 0.0;
  double range_m = 0.0;
  double inner_cone = 0.0, outer_cone = 0.0;  ///< rad from the axis; a point light has outer_cone = 0
  bool passing_beam = false;                  ///< extras.greatx_beam: "passing"
};

struct GlbNode {
  std::string name;
  int mesh = -1;                ///< index of add_mesh(); -1: none
  int parent = -1;              ///< index of add_node(); -1: the scene
  Pose pose;                    ///< parent_from_node
  std::optional<double> scale;  ///< uniform scale, written only if given
  int light = -1;               ///< index of add_light(); -1: none
  /// Direction of the light in the parent's frame. If it is not zero, it replaces the orientation of the
  /// pose.
  dvec3 aim{0.0};
  std::string extras_json;  ///< one JSON object, or empty
};

/// Holds the choices that glTF leaves to the writer. Each program keeps its choice, so that its files keep
/// their bytes.
struct GlbOptions {
  std::string generator = "greatx " GREATX_VERSION;  ///< the file's asset.generator
  /// If true, indices have 16 bits where these suffice, the mode of triangles, which is glTF's default, is
  /// left out, rotations are rounded to float, so that the last bit of a sine does not change the file, and
  /// the JSON lists are ordered from the data up to the scene. If false, indices have 32 bits, every mode is
  /// written, rotations are exact, and the lists are ordered from the scene down to the data.
  bool compact = false;
};

/// Builds a GLB file. The same calls give the same bytes. The data lie in the file in the order of the calls.
class GlbWriter {
 public:
  explicit GlbWriter(const GlbOptions& options = {});
  ~GlbWriter();
  GlbWriter(const GlbWriter&) = delete;
  GlbWriter& operator=(const GlbWriter&) = delete;

  // The add functions that return int return the index of the added object.

  /// Adds a texture with the given PNG picture, which repeats in both directions.
  int add_texture(const std::string& name, std::span<const std::byte> png);
  int add_material(const GlbMaterial& material);
  /// Adds an empty mesh. At least one primitive must be added to it.
  int add_mesh(const std::string& name);
  /// Adds a primitive to a mesh. Indices must be below the number of positions; lines have two, triangles
  /// three each.
  void add_primitive(int mesh, const GlbPrimitive& primitive);
  int add_mesh(const std::string& name, const std::vector<GlbPrimitive>& primitives);
  int add_light(const GlbLight& light);
  int add_node(const GlbNode& node);
  /// Returns the whole file and leaves the writer empty. Throws UserError if the file exceeds the 4 GiB of
  /// the format.
  Bytes finish(const std::string& scene_name, const std::string& scene_extras_json = "");

 private:
  int add_view(std::span<const std::byte> bytes, int target);
  template <typename T>
  int add_accessor(const std::vector<T>& values, int component_type, const char* type, int target);

  struct Document;
  GlbOptions options_;
  std::unique_ptr<Document> document_;
};

}  // namespace greatx::io
