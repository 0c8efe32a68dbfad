// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/mesh/scene_writer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "io/formats/png.h"
#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

/// Rounds to 1e-6, so that the file holds no more digits than the value is accurate to.
double micro(double value) { return static_cast<double>(std::llround(value * 1e6)) / 1e6; }
dvec3 micro(const vec3& v) { return {micro(v.x), micro(v.y), micro(v.z)}; }

float largest(const vec3& color) { return std::max({color.x, color.y, color.z}); }

dquat turn_about_z(double yaw) { return {std::cos(yaw / 2), 0.0, 0.0, std::sin(yaw / 2)}; }

}  // namespace

SceneWriter::SceneWriter(std::vector<MaterialSpec> library, std::map<std::string, TextureMaps> pictures,
                         const std::string& generator)
    : library_(std::move(library)),
      file_({.generator = generator, .compact = true}),
      maps_(std::move(pictures)) {}

int SceneWriter::add_mesh(const std::string& name, const MeshBuilder& mesh) {
  return add_mesh(name, mesh.primitives());
}

int SceneWriter::add_mesh(const std::string& name, std::span<const PrimitiveData> primitives) {
  GREATX_CHECK(!primitives.empty(), "mesh \"{}\" is empty", name);
  const int index = file_.add_mesh(name);
  for (const PrimitiveData& data : primitives) {
    const auto [material, is_new] =
        materials_.try_emplace(data.material, static_cast<int>(materials_.size()));
    file_.add_primitive(index, {.material = material->second,
                                .positions = data.positions,
                                .normals = data.normals,
                                .uvs = data.uvs,
                                .indices = data.indices});
    // The textures of a material lie in the file behind the first triangles that show them.
    if (is_new) add_material(data.material);
  }
  return index;
}

int SceneWriter::add_node(const NodeSpec& node) {
  io::GlbNode out;
  out.name = node.name;
  out.mesh = node.mesh;
  out.parent = node.parent;
  out.pose = {snap(node.position), node.yaw != 0.0 ? turn_about_z(node.yaw) : Pose{}.orientation};
  if (node.pitch != 0.0)
    out.pose.orientation =
        out.pose.orientation * dquat(std::cos(node.pitch / 2), 0.0, std::sin(node.pitch / 2), 0.0);
  if (node.scale != 1.0) out.scale = snap(node.scale);
  out.light = node.light;
  out.aim = node.shine;
  std::string extras = node.extras;
  if (node.semantic_class != SemanticClass::unlabeled)
    extras = fmt::format(R"("greatx_class":"{}"{}{})", name_of(node.semantic_class),
                         extras.empty() ? "" : ",", extras);
  if (!extras.empty()) out.extras_json = fmt::format("{{{}}}", extras);
  return file_.add_node(out);
}

double LightSpec::flux_lm() const {
  if (outer_cone == 0.0) return 4.0 * pi * intensity_cd;
  const double inner = std::cos(inner_cone), outer = std::cos(outer_cone);
  return 2.0 * pi * intensity_cd * (1.0 - inner + (inner - outer) / 3.0);
}

int SceneWriter::add_light(const LightSpec& light) {
  const float peak = largest(light.color);
  return file_.add_light({.color = micro(light.color / peak),
                          .intensity_cd = micro(light.intensity_cd * peak),
                          .range_m = light.range_m,
                          .inner_cone = micro(light.inner_cone),
                          .outer_cone = micro(light.outer_cone),
                          .passing_beam = light.passing_beam});
}

void SceneWriter::paint_ahead(std::span<const char* const> names) {
  std::vector<TextureMaps> painted(names.size());
  parallel_for(names.size(), 0, [&](size_t i) {
    if (!maps_.contains(names[i])) painted[i] = make_texture(names[i]);
  });
  for (size_t i = 0; i < names.size(); ++i) maps_.try_emplace(names[i], std::move(painted[i]));
}

const TextureMaps& SceneWriter::maps(const std::string& name) {
  const auto found = maps_.find(name);
  return found != maps_.end() ? found->second : maps_[name] = make_texture(name);
}

int SceneWriter::texture(int& index, const std::string& name, const Raster& raster, bool exact,
                         const std::vector<uint8_t>& alpha) {
  if (index >= 0 || raster.empty()) return index;
  const io::PngCoding coding = quick_ ? (exact ? io::PngCoding::quick : io::PngCoding::quick_inexact)
                                      : (exact ? io::PngCoding::small : io::PngCoding::small_inexact);
  if (!alpha.empty()) {
    std::vector<uint8_t> rgba;
    for (size_t i = 0; i < alpha.size(); ++i)
      rgba.insert(rgba.end(), {raster.rgb[3 * i], raster.rgb[3 * i + 1], raster.rgb[3 * i + 2], alpha[i]});
    const Array image = Array::of<uint8_t>({int64_t{raster.height}, int64_t{raster.width}, 4}, rgba);
    return index = file_.add_texture(name, io::encode_png(image, coding));
  }
  const Array image = Array::of<uint8_t>({int64_t{raster.height}, int64_t{raster.width}, 3}, raster.rgb);
  return index = file_.add_texture(name, io::encode_png(image, coding));
}

void SceneWriter::add_material(int library_index) {
  const MaterialSpec& spec = library_[static_cast<size_t>(library_index)];
  io::GlbMaterial out;
  out.name = spec.name;
  out.base_color = micro(spec.color);
  out.metallic = micro(spec.metallic);
  out.roughness = micro(spec.roughness);
  if (!spec.texture.empty()) {
    const TextureMaps& painted = maps(spec.texture);
    Textures& known = textures_[spec.texture];
    out.base_color_texture = texture(known.color, spec.texture, painted.color, false, painted.alpha);
    out.holes = out.double_sided = !painted.alpha.empty();
    out.metallic_roughness_texture =
        texture(known.surface, spec.texture + "_surface", painted.metallic_roughness);
    if (spec.relief)
      out.normal_texture = texture(known.normal, spec.texture + "_normal", painted.normal, true);
    if (spec.lit >= 0) {
      const size_t evening = static_cast<size_t>(spec.lit);
      const std::string name = fmt::format("{}_lit_{}", spec.texture, spec.lit);
      out.emissive_texture = texture(known.lit[evening], name, painted.lit[evening], true);
    }
  }
  std::string transmission;
  if (spec.transmission > 0.0f)
    transmission =
        fmt::format(R"(,"KHR_materials_transmission":{{"transmissionFactor":{}}})", micro(spec.transmission));
  out.extensions_json = fmt::format(R"({{"GREATX_radio_material":{}{}}})", spec.radio, transmission);
  const float strength = std::max(largest(spec.emissive), 1.0f);
  out.emissive = micro(spec.emissive / strength);
  out.emissive_strength = micro(strength);
  const int index = file_.add_material(out);
  GREATX_CHECK(index == materials_.at(library_index), "material \"{}\" is number {}", spec.name, index);
}

std::vector<std::byte> SceneWriter::finish(const std::string& scene_name,
                                           const std::string& scene_extras_json) {
  return file_.finish(scene_name, scene_extras_json.empty() ? scene_extras_ : scene_extras_json);
}

}  // namespace greatx::scene::generator
