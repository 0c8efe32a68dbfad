// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/surface/surface_tables.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include <glm/gtc/packing.hpp>

#include "core/error.h"
#include "renderer/surface/mark_map.h"
#include "renderer/surface/octahedral.h"
#include "renderer/surface/pane_color.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

namespace {

using Words = std::vector<uint32_t>;

void put(Words& words, float value) { words.push_back(std::bit_cast<uint32_t>(value)); }
void put(Words& words, const vec3& value) {
  for (int i = 0; i < 3; ++i) put(words, value[i]);
}
void put(Words& words, const vec2& value) {
  put(words, value.x);
  put(words, value.y);
}

void put_triangle(Words& words, const scene::Scene& scene, uint32_t triangle, uint32_t body_and_material,
                  uint32_t holes_and_lamp, uint32_t bits) {
  const uint32_t* corner = &scene.indices[size_t{3} * triangle];
  const vec3 a = scene.positions[corner[0]];
  const vec2 uv = scene.uvs[corner[0]];
  put(words, a);
  words.push_back(body_and_material);
  put(words, scene.positions[corner[1]] - a);
  words.push_back(octahedral_word(scene.normals[corner[0]]));
  put(words, scene.positions[corner[2]] - a);
  words.push_back(octahedral_word(scene.normals[corner[1]]));
  put(words, uv);
  put(words, scene.uvs[corner[1]] - uv);
  put(words, scene.uvs[corner[2]] - uv);
  words.push_back(octahedral_word(scene.normals[corner[2]]));
  words.push_back((scene.tangents[corner[0]].w < 0.0f ? shared::triangle_mirrored : 0u) | bits);
  for (int i = 0; i < 3; ++i) words.push_back(octahedral_word(vec3(scene.tangents[corner[i]])));
  words.push_back(holes_and_lamp);
}

void put_material(Words& words, const scene::Material& material, const scene::MaterialTextures& textures) {
  const scene::PbrMaterial& pbr = material.pbr;
  const auto pair = [](uint32_t low, uint32_t high) { return low | high << 16; };
  const auto texture = [](scene::TextureReference reference) { return static_cast<uint32_t>(reference + 1); };
  const auto fraction = [](float x) { return static_cast<uint32_t>(std::lround(x * 65535.0f)); };
  const std::optional<vec3> passes = pane_color(pbr);
  const uint32_t roughness_in = is_lit_pane(material)              ? shared::roughness_of_lit_pane
                                : passes                           ? shared::roughness_of_pane
                                : textures.roughness_in_alpha      ? shared::roughness_in_alpha
                                : textures.metallic_roughness >= 0 ? shared::roughness_in_texture
                                                                   : 0u;
  const vec3 reflects = solid_color(pbr);
  words.push_back(glm::packHalf2x16(vec2(reflects)));
  words.push_back(pair(glm::packHalf1x16(reflects.z), roughness_in));
  words.push_back(pair(fraction(pbr.metallic * textures.metallic), fraction(pbr.roughness)));
  words.push_back(texture(textures.base_color));
  put(words, pbr.emissive);
  words.push_back(texture(textures.emissive));
  put(words, pbr.normal_scale);
  words.push_back(texture(textures.normal));
  words.push_back(texture(textures.metallic_roughness));
  uint32_t color = 0;
  for (int i = 0; passes && i < 3; ++i)
    color |= static_cast<uint32_t>(std::lround(glm::clamp((*passes)[i], 0.0f, 1.0f) * 1023.0f)) << (10 * i);
  words.push_back(color);
}

void require_16_bits(const char* what, size_t count) {
  constexpr size_t most = 65535;
  if (count > most)
    throw_user_error("scene: {}: expected at most {} for a camera, found {}", what, most, count);
}

}  // namespace

SurfaceTables::SurfaceTables(const scene::GpuScene& gpu_scene, bool lamps) {
  const scene::Scene& scene = gpu_scene.scene();
  closed_ = closed_surfaces(scene);
  require_16_bits("bodies", scene.bodies.size());
  require_16_bits("materials", scene.materials.size());
  Words triangles, materials;
  std::vector<uint32_t> primitives(scene.triangle_count());
  std::vector<uvec2> ids(scene.triangle_count() + 1, uvec2(0u));
  triangles.reserve(4 * shared::triangle_record_quads * (scene.triangle_count() + 1));
  for (uint32_t i = 0; i < scene.primitives.size(); ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    const uint32_t body = scene.instances[primitive.instance].body;
    GREATX_CHECK(triangles.size() == size_t{4} * shared::triangle_record_quads * (primitive.first_index / 3),
                 "primitive {} does not follow the one before", i);
    const uint32_t lamp = gpu_scene.switched_lamps().of_primitive[i];
    const auto first_lamp = static_cast<uint32_t>(shared::lamp_factors_of_element * scene.bodies.size());
    const uint32_t holes_and_lamp =
        (scene.has_holes(i) ? 1u : 0u) | (lamp != 0 ? (first_lamp + lamp - 1) << 1 : 0u);
    const uint32_t bits = marks_of(scene, primitive) | (lamp != 0 ? shared::triangle_switched : 0u);
    for (uint32_t t = 0; t < primitive.index_count / 3; ++t) {
      primitives[primitive.first_index / 3 + t] = i;
      ids[primitive.first_index / 3 + t + 1] = {
          primitive.instance + 1, static_cast<uint32_t>(scene.instances[primitive.instance].semantic_class) |
                                      (primitive.material + 1) << 16};
      put_triangle(triangles, scene, primitive.first_index / 3 + t, body << 16 | primitive.material,
                   holes_and_lamp, bits);
    }
  }
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    scene::Material material = scene.materials[i];
    if (!lamps && scene::lamp_role(material)) material.pbr.emissive = vec3(0.0f);
    put_material(materials, material, gpu_scene.textures().of_material(i));
  }
  // An empty scene must still have buffers to bind.
  if (triangles.empty()) triangles.resize(4 * shared::triangle_record_quads);
  if (materials.empty()) materials.resize(4 * shared::material_record_quads);
  triangles_ =
      gpu::upload_buffer(gpu_scene.device(), std::as_bytes(std::span(triangles)), "triangle records");
  const uint64_t most = std::min<uint64_t>(gpu_scene.device().limits().maxStorageBufferRange,
                                           gpu_scene.options().most_table_bytes);
  if (triangles_.size() > most) {
    const std::vector<uint64_t> address{triangles_.address(), 0};
    address_ = gpu::upload_buffer(gpu_scene.device(), std::as_bytes(std::span(address)),
                                  "address of triangle records");
  }
  materials_ =
      gpu::upload_buffer(gpu_scene.device(), std::as_bytes(std::span(materials)), "material records");
  triangle_ids_ = gpu::upload_buffer(gpu_scene.device(), std::as_bytes(std::span(ids)), "ids of triangles");
  triangle_primitives_ =
      gpu::upload_buffer(gpu_scene.device(), std::as_bytes(std::span(primitives)), "primitives of triangles");
}

std::vector<gpu::Binding> SurfaceTables::bindings() {
  return {{shared::triangle_records_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {shared::material_records_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
}

std::vector<gpu::Descriptor> SurfaceTables::descriptors() const {
  return {gpu::Descriptor::buffer(shared::triangle_records_binding, by_address() ? address_ : triangles_),
          gpu::Descriptor::buffer(shared::material_records_binding, materials_)};
}

}  // namespace greatx::render
