// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/device/gpu_scene.h"

#include <algorithm>
#include <array>
#include <bit>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/activity.h"
#include "core/same_pose.h"
#include "scene/device/scene_trees.h"
#include "scene/material/lossless.h"

namespace greatx::scene {

namespace {

template <typename T>
gpu::Buffer upload(gpu::Device& device, const std::vector<T>& values, std::string_view name,
                   VkBufferUsageFlags extra = 0) {
  return gpu::upload_buffer(device, std::as_bytes(std::span(values)), name, extra);
}

float luminance(const vec4& color) { return 0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b; }

shared::GpuMaterial gpu_material(const Material& material, const MaterialTextures& textures) {
  const PbrMaterial& pbr = material.pbr;
  shared::GpuMaterial result{};
  result.base_color = pbr.base_color;
  result.emissive = pbr.emissive;
  result.metallic = pbr.metallic;
  result.roughness = pbr.roughness;
  result.normal_scale = pbr.normal_scale;
  result.alpha_cutoff = pbr.alpha_cutoff;
  result.flags = (pbr.alpha_mode == AlphaMode::mask ? shared::material_flag_alpha_mask : 0u) |
                 (pbr.double_sided ? shared::material_flag_double_sided : 0u) |
                 (material.reflectance_905nm ? shared::material_flag_reflectance_905nm : 0u) |
                 (material.reflectance_1550nm ? shared::material_flag_reflectance_1550nm : 0u) |
                 (is_lossless(material) ? shared::material_flag_no_radio : 0u);
  result.base_color_texture = textures.base_color;
  result.reflectance_905nm = material.reflectance_905nm.value_or(luminance(pbr.base_color));
  result.reflectance_1550nm = material.reflectance_1550nm.value_or(luminance(pbr.base_color));
  return result;
}

dmat4 matrix_of(const Pose& pose) {
  dmat4 matrix = glm::mat4_cast(pose.orientation);
  matrix[3] = dvec4(pose.position, 1.0);
  return matrix;
}

shared::GpuBody gpu_body(const Pose& pose) {
  const glm::dmat4 rows = glm::transpose(matrix_of(pose));
  return {vec4(rows[0]), vec4(rows[1]), vec4(rows[2])};
}

/// Adds the factors of switched lamps behind the bodies, twelve in each element.
void append_lamps(std::vector<shared::GpuBody>& bodies, std::span<const float> factors) {
  constexpr size_t each = shared::lamp_factors_of_element;
  static_assert(sizeof(shared::GpuBody) == each * sizeof(float));
  for (size_t first = 0; first < factors.size(); first += each) {
    std::array<float, each> values{};
    std::ranges::copy(factors.subspan(first, std::min(each, factors.size() - first)), values.begin());
    bodies.push_back(std::bit_cast<shared::GpuBody>(values));
  }
}

}  // namespace

GpuScene::GpuScene(gpu::Device& device, const Scene& scene, const GpuSceneOptions& options)
    : device_(&device),
      scene_(&scene),
      options_(options),
      tracer_(options.tracer == gpu::Tracer::automatic ? device.tracer() : options.tracer),
      switched_lamps_(scene::switched_lamps(scene)),
      lamp_factors_(switched_lamps_.lamps.size(), 1.0f) {
  // Without textures the table still has a layout, which pipelines need.
  textures_ = GpuTextures(device, options.textures ? std::span(scene.textures) : std::span<const Texture>(),
                          scene.materials);
  if (traces() && tracer_ == gpu::Tracer::tree) build_trees();
  upload_geometry();
  if (traces() && tracer_ == gpu::Tracer::driver) build_structures();
}

void GpuScene::upload_geometry() {
  const Activity activity("uploading the scene");
  gpu::Device& device = *device_;
  const VkBufferUsageFlags build_input =
      traces() && tracer_ == gpu::Tracer::driver
          ? VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR
          : 0;
  positions_ = upload(device, scene_->positions, "positions", build_input);
  normals_ = upload(device, scene_->normals, "normals");
  tangents_ = upload(device, scene_->tangents, "tangents");
  uvs_ = upload(device, scene_->uvs, "uvs");
  indices_ = upload(device, scene_->indices, "indices", build_input | VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  facet_of_triangle_ = upload(device, scene_->facet_of_triangle, "facet of triangle");

  std::vector<shared::GpuMaterial> materials;
  for (size_t i = 0; i < scene_->materials.size(); ++i)
    materials.push_back(gpu_material(scene_->materials[i], textures_.of_material(i)));
  materials_ = upload(device, materials, "materials");

  std::vector<shared::GpuPrimitive> primitives;
  for (const Primitive& primitive : scene_->primitives) {
    const Instance& instance = scene_->instances[primitive.instance];
    primitives.push_back({primitive.first_index, primitive.first_index / 3, primitive.material,
                          primitive.instance, static_cast<uint32_t>(instance.semantic_class), instance.body,
                          scene_->owner_of(instance.body)});
  }
  primitives_ = upload(device, primitives, "primitives");

  const std::vector<shared::GpuSceneAddresses> addresses{
      {positions_.address(), normals_.address(), tangents_.address(), uvs_.address(), indices_.address(),
       primitives_.address(), materials_.address(), facet_of_triangle_.address(), trees_.address()}};
  addresses_ = upload(device, addresses, "scene addresses");
}

void GpuScene::build_structures() {
  for (uint32_t body = 0; body < scene_->bodies.size(); ++body) {
    const Body& range = scene_->bodies[body];
    if (range.primitive_count == 0) continue;
    std::vector<gpu::BlasGeometry> geometries;
    for (uint32_t i = range.first_primitive; i < range.first_primitive + range.primitive_count; ++i) {
      const Primitive& primitive = scene_->primitives[i];
      geometries.push_back({positions_.address(), static_cast<uint32_t>(scene_->positions.size()),
                            indices_.address() + sizeof(uint32_t) * primitive.first_index,
                            primitive.index_count / 3,
                            scene_->materials[primitive.material].pbr.alpha_mode == AlphaMode::opaque});
    }
    blas_.emplace_back(*device_, geometries, fmt::format("blas {}", range.name));
    blas_body_.push_back(body);
  }
  tlas_ = gpu::Tlas(*device_, static_cast<uint32_t>(blas_.size()), "tlas");
}

void GpuScene::build_trees() {
  const SceneTrees trees = make_scene_trees(*scene_);
  const size_t bytes = trees.words.size() * sizeof(uint32_t);
  trees_ = upload(*device_, trees.words, "trees of triangles");
  trees_by_address_ =
      bytes > std::min<uint64_t>(options_.most_table_bytes, device_->limits().maxStorageBufferRange);
  body_tree_ = BodyTree(*scene_);
  spdlog::debug("trees of {} bodies: {} triangles, {} inner nodes, {} leaves, {} deep, {} KiB{}",
                scene_->bodies.size(), trees.triangles, trees.inner_nodes, trees.leaves, trees.depth,
                bytes / 1024, trees_by_address_ ? ", read by address" : "");
}

void GpuScene::prepare_tracing(gpu::ComputeDesc& compute, std::string_view name) const {
  GREATX_CHECK(traces(), "{} traces rays through a scene without a tracer", name);
  GREATX_CHECK(compute.specialization.size() <= shared::has_moving_bodies_id, "{} specialization constants",
               compute.specialization.size());
  const bool tree = tracer_ == gpu::Tracer::tree;
  compute.shader = fmt::format("{}{}", name, tree ? ".tree" : "");
  compute.bindings = raster_bindings();
  compute.bindings.push_back(
      tree ? gpu::Binding{shared::body_tree_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}
           : gpu::Binding{shared::tlas_binding, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR});
  if (tree) compute.bindings.push_back({shared::tree_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.specialization.resize(shared::has_moving_bodies_id);
  compute.specialization.push_back(body_tree_.empty() ? 0u : 1u);
  compute.specialization.push_back(trees_by_address_ ? 1u : 0u);
}

void GpuScene::record_poses(gpu::TickSlot& slot, std::span<const Pose> body_poses) {
  GREATX_CHECK(body_poses.size() == scene_->bodies.size(), "{} poses for {} bodies", body_poses.size(),
               scene_->bodies.size());
  std::vector<shared::GpuBody> bodies;
  for (const Pose& pose : body_poses) bodies.push_back(gpu_body(bodies.empty() ? Pose{} : pose));
  append_lamps(bodies, lamp_factors_);
  bodies_ = slot.upload.put(std::span<const shared::GpuBody>(bodies));
}

void GpuScene::set_lamps(std::vector<float> factors) {
  GREATX_CHECK(factors.size() == lamp_factors_.size(), "{} factors for {} switched lamps", factors.size(),
               lamp_factors_.size());
  lamp_factors_ = std::move(factors);
}

void GpuScene::record_update(gpu::TickSlot& slot, std::span<const Pose> body_poses) {
  record_poses(slot, body_poses);
  if (!traces()) return;
  if (tracer_ == gpu::Tracer::driver) return record_tlas(slot, {body_poses.begin(), body_poses.end()});
  body_words_ = slot.upload.allocate_for<uint32_t>(body_tree_.word_count());
  body_tree_.write(body_poses, body_words_.as<uint32_t>().first(body_tree_.word_count()));
}

void GpuScene::record_tlas(gpu::TickSlot& slot, std::vector<Pose> poses) {
  poses[0] = Pose{};
  const bool moved = !tlas_.built() || !std::equal(poses.begin(), poses.end(), last_poses_.begin(),
                                                   last_poses_.end(), same_pose);
  if (!moved) return;
  std::vector<gpu::TlasInstance> instances;
  for (size_t i = 0; i < blas_.size(); ++i)
    instances.push_back({&blas_[i], matrix_of(poses[blas_body_[i]]),
                         scene_->bodies[blas_body_[i]].first_primitive,
                         blas_body_[i] == 0 ? shared::static_mask : shared::moving_mask});
  const auto scope = slot.cmd->scope(tlas_.built() ? "tlas refit" : "tlas build");
  tlas_.record(*slot.cmd, instances, slot.upload.allocate(tlas_.instance_bytes()));
  last_poses_ = std::move(poses);
}

std::vector<gpu::Descriptor> GpuScene::raster_descriptors() const {
  return {gpu::Descriptor::buffer(shared::scene_binding, addresses_),
          gpu::Descriptor::buffer(shared::bodies_binding, bodies_)};
}

std::vector<gpu::Descriptor> GpuScene::descriptors() const {
  std::vector<gpu::Descriptor> all = raster_descriptors();
  if (tracer_ == gpu::Tracer::tree) {
    all.push_back(gpu::Descriptor::buffer(shared::body_tree_binding, body_words_));
    // What is read by its address still needs something in its place.
    all.push_back(trees_by_address_ ? gpu::Descriptor::buffer(shared::tree_binding, addresses_)
                                    : gpu::Descriptor::buffer(shared::tree_binding, trees_));
  } else {
    all.push_back(gpu::Descriptor::acceleration(shared::tlas_binding, tlas_));
  }
  return all;
}

std::vector<gpu::Binding> GpuScene::raster_bindings() {
  return {{shared::scene_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {shared::bodies_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
}

}  // namespace greatx::scene
