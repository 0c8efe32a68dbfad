// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes glTF 2.0 binary (Khronos glTF 2.0.1, chapter 4). Everything is given with z up and written with
// glTF's y up: (x, y, z) -> (x, z, -y).
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

/// Numbers are fp64, so that a caller decides how many digits the file shows.
struct GlbMaterial {
  std::string name;
  dvec3 base_color{1.0};  ///< linear Rec. 709; times its texture and the vertices' colours
  double metallic = 0.0, roughness = 1.0;
  dvec3 emissive{
      0.0};  ///< linear Rec. 709, each channel at most 1; times its texture and `emissive_strength`
  double emissive_strength = 1.0;  ///< KHR_materials_emissive_strength
  /// Of add_texture; -1: none.
  int base_color_texture = -1, metallic_roughness_texture = -1, normal_texture = -1, emissive_texture = -1;
  bool unlit = false;  ///< KHR_materials_unlit: shown as it is, whatever the light
  bool double_sided = false;
  std::string extensions_json;  ///< one JSON object, extension by name, or empty; the file lists them as used
};

struct GlbPrimitive {
  enum class Mode : int { lines = 1, triangles = 4 } mode = Mode::triangles;
  int material = -1;            ///< of add_material, which may follow; -1: none
  std::vector<vec3> positions;  ///< m; one at least
  std::vector<vec3> normals;    ///< unit, [positions] or empty
  std::vector<vec2> uvs;        ///< [positions] or empty
  std::vector<vec3> colors;     ///< linear Rec. 709, [positions] or empty
  std::vector<uint32_t> indices;
};

/// KHR_lights_punctual. Lights have no name of their own: readers take the node's.
struct GlbLight {
  dvec3 color{1.0};  ///< linear Rec. 709
  double intensity_cd = 0.0;
  double range_m = 0.0;
  double inner_cone = 0.0, outer_cone = 0.0;  ///< rad from the axis; 0: a point light
};

struct GlbNode {
  std::string name;
  int mesh = -1;                ///< of add_mesh; -1: none
  int parent = -1;              ///< of add_node; -1: the scene
  Pose pose;                    ///< parent_from_node
  std::optional<double> scale;  ///< not written unless given
  int light = -1;               ///< of add_light; -1: none
  /// Where the light looks, in the parent's frame; it takes the place of the pose's orientation. 0: as the
  /// pose says.
  dvec3 aim{0.0};
  std::string extras_json;  ///< one JSON object, or empty
};

/// What glTF leaves to the writer. Each program keeps its choice, so that its files keep their bytes.
struct GlbOptions {
  std::string generator = "greatx " GREATX_VERSION;  ///< the file's asset.generator
  /// Indices have 16 bits where these suffice, the mode of triangles, which is the default, is left out,
  /// rotations are rounded to float, so that the last bit of a sine does not show, and the JSON lists come from
  /// the data up to the scene. Otherwise indices have 32 bits, every mode is written, rotations are exact, and
  /// the lists come from the scene down to the data.
  bool compact = false;
};

/// The same calls give the same bytes. Data lie in the file in the order of the calls.
class GlbWriter {
 public:
  explicit GlbWriter(const GlbOptions& options = {});
  ~GlbWriter();
  GlbWriter(const GlbWriter&) = delete;
  GlbWriter& operator=(const GlbWriter&) = delete;

  /// A picture of these PNG bytes that repeats in both directions.
  int add_texture(const std::string& name, std::span<const std::byte> png);
  int add_material(const GlbMaterial& material);
  /// A mesh whose primitives follow, one at least.
  int add_mesh(const std::string& name);
  /// Indices must be below the number of positions; lines come in pairs, triangles in threes.
  void add_primitive(int mesh, const GlbPrimitive& primitive);
  int add_mesh(const std::string& name, const std::vector<GlbPrimitive>& primitives);
  int add_light(const GlbLight& light);
  int add_node(const GlbNode& node);
  /// The whole file; the writer is empty afterwards. Throws UserError if it is beyond the 4 GiB of the
  /// format.
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
