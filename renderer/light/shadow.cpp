// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/shadow.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace greatx::render {

namespace {

constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;

gpu::Image depth_map(gpu::Device& device, uint32_t size, std::string_view name) {
  return gpu::Image(device,
                    {.format = depth_format,
                     .width = size,
                     .height = size,
                     .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT},
                    name);
}

bool is_masked(const scene::Scene& scene, uint32_t primitive) {
  return scene.materials[scene.primitives[primitive].material].pbr.alpha_mode == scene::AlphaMode::mask;
}

gpu::Descriptor scene_descriptor(const scene::GpuScene& scene) {
  for (const gpu::Descriptor& descriptor : scene.raster_descriptors())
    if (descriptor.slot == shared::scene_binding) return descriptor;
  GREATX_CHECK(false, "the scene has no descriptor {}", shared::scene_binding);
}

vec4 row_of(const dvec3& axis, double scale, double offset) { return vec4(dvec4(axis * scale, offset)); }

}  // namespace

SunFrame SunFrame::of(const dvec3& to_sun) {
  SunFrame frame;
  frame.z = glm::normalize(to_sun);
  frame.x = glm::normalize(glm::cross(std::abs(frame.z.z) < 0.99 ? dvec3(0, 0, 1) : dvec3(0, 1, 0), frame.z));
  frame.y = glm::cross(frame.z, frame.x);
  return frame;
}

ShadowMaps::ShadowMaps(const scene::GpuScene& scene, const SunFrame& frame, const ShadowOptions& options)
    : scene_(&scene), options_(options), frame_(frame) {
  gpu::Device& device = scene.device();
  sampler_ = gpu::Sampler(
      device, {.linear = true, .repeat_u = false, .repeat_v = false, .compare_greater_or_equal = true},
      "shadow");
  build_static(options.alpha_mask);
  build_moving(options.alpha_mask);
  no_tiles_ = gpu::upload_buffer(
      device, std::vector<std::byte>(sizeof(shared::ShadowTilesHeader) + sizeof(shared::GpuShadowTile)),
      "no shadow tiles");
  tiles_ = no_tiles_.slice();
}

gpu::GraphicsPipeline ShadowMaps::pipeline(bool moving, bool masked) const {
  gpu::GraphicsDesc desc;
  desc.vertex_shader = moving ? "camera/moving_shadow.vert" : "camera/static_shadow.vert";
  if (masked) {
    desc.fragment_shader = "camera/shadow_mask.frag";
    desc.textures = &scene_->textures().table();
    desc.specialization = {scene_->textures().arrays_of(&scene::MaterialTextures::base_color)};
  }
  desc.bindings = scene::GpuScene::raster_bindings();
  if (moving) {
    desc.bindings.push_back({shared::lighting_binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER});
    desc.bindings.push_back({shared::shadow_tiles_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  }
  desc.push_constant_bytes = moving ? sizeof(uint32_t) : sizeof(shared::ShadowConstants);
  desc.depth_format = depth_format;
  return gpu::GraphicsPipeline(
      scene_->device(), desc,
      fmt::format("{} shadow{}", moving ? "moving" : "static", masked ? " masked" : ""));
}

void ShadowMaps::draw(gpu::Cmd& cmd, std::span<const uint32_t> primitives) const {
  for (const uint32_t index : primitives) {
    const scene::Primitive& primitive = scene_->scene().primitives[index];
    cmd.draw_indexed(primitive.first_index, primitive.index_count, index);
  }
}

void ShadowMaps::build_static(bool alpha_mask) {
  const scene::Scene& scene = scene_->scene();
  std::vector<uint32_t> opaque, masked;
  scene::Bounds bounds;
  const scene::Body& world = scene.bodies[0];
  if (options_.static_casters)
    for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i)
      (alpha_mask && is_masked(scene, i) ? masked : opaque).push_back(i);
  const bool wanted = !opaque.empty() || !masked.empty();
  const uint32_t size = wanted ? options_.static_texels : 1;
  static_map_ = depth_map(scene_->device(), size, "static shadow map");
  if (wanted) {
    for (int corner = 0; corner < 8; ++corner)
      bounds.add(frame_.from_local({corner & 1 ? scene.bounds.max.x : scene.bounds.min.x,
                                    corner & 2 ? scene.bounds.max.y : scene.bounds.min.y,
                                    corner & 4 ? scene.bounds.max.z : scene.bounds.min.z}));
    // Four empty texels surround the map, so that points outside are lit. The texels are square.
    const double edge = std::max({bounds.size().x, bounds.size().y, 1e-3}) * size / (size - 8.0);
    const dvec3 half(0.5 * edge, 0.5 * edge, 0.5 * bounds.size().z + 0.01 * edge);
    static_min_ = bounds.center() - half;
    static_max_ = bounds.center() + half;
  }

  shared::ShadowConstants constants;
  const dvec3 center = 0.5 * (static_min_ + static_max_), size_m = static_max_ - static_min_;
  constants.row0 = row_of(frame_.x, 2.0 / size_m.x, -2.0 * center.x / size_m.x);
  constants.row1 = row_of(frame_.y, 2.0 / size_m.y, -2.0 * center.y / size_m.y);
  constants.row2 = row_of(frame_.z, 1.0 / size_m.z, -static_min_.z / size_m.z);
  gpu::GraphicsPipeline opaque_pipeline, masked_pipeline;
  if (!opaque.empty()) opaque_pipeline = pipeline(false, false);
  if (!masked.empty()) masked_pipeline = pipeline(false, true);
  gpu::submit_setup(scene_->device(), [&](gpu::Cmd& cmd) {
    const auto scope = cmd.scope("static shadow");
    cmd.transition(static_map_, gpu::ImageUse::depth_target, true);
    cmd.begin_rendering(
        {.color = {}, .depth = &static_map_, .clear_depth = 0.0f, .width = size, .height = size});
    const auto draw_all = [&](const gpu::GraphicsPipeline& with, std::span<const uint32_t> primitives) {
      if (primitives.empty()) return;
      cmd.bind(with);
      cmd.push({scene_descriptor(*scene_)});
      cmd.constants(constants);
      cmd.bind_indices(scene_->indices());
      draw(cmd, primitives);
    };
    draw_all(opaque_pipeline, opaque);
    draw_all(masked_pipeline, masked);
    cmd.end_rendering();
    cmd.transition(static_map_, gpu::ImageUse::sampled);
  });
}

void ShadowMaps::build_moving(bool alpha_mask) {
  const scene::Scene& scene = scene_->scene();
  bool any_opaque = false, any_masked = false;
  for (uint32_t b = 1; options_.moving_casters && b < scene.bodies.size(); ++b) {
    if (scene.owner_of(b) != b || scene.reach_of(b).empty()) continue;
    Caster caster;
    caster.body = b;
    caster.center = scene.reach_of(b).center();
    caster.radius = std::max(0.5 * glm::length(scene.reach_of(b).size()), 1e-3);
    for (uint32_t part = b; part < scene.bodies.size() && scene.owner_of(part) == b; ++part) {
      const scene::Body& body = scene.bodies[part];
      for (uint32_t i = body.first_primitive; i < body.first_primitive + body.primitive_count; ++i)
        (alpha_mask && is_masked(scene, i) ? caster.masked : caster.opaque).push_back(i);
    }
    any_opaque |= !caster.opaque.empty();
    any_masked |= !caster.masked.empty();
    casters_.push_back(std::move(caster));
  }
  uint32_t size = 1;
  if (!casters_.empty()) {
    tiles_across_ = static_cast<uint32_t>(std::ceil(std::sqrt(double(casters_.size()))));
    // A side has at most 2048 texels. If there are many bodies, each has a smaller tile.
    size = std::min(tiles_across_ * options_.moving_tile_texels, std::max(2048u, 16u * tiles_across_));
  }
  moving_map_ = depth_map(scene_->device(), size, "moving shadow map");
  if (any_opaque) moving_opaque_ = pipeline(true, false);
  if (any_masked) moving_masked_ = pipeline(true, true);
  if (casters_.empty())
    gpu::submit_setup(scene_->device(),
                      [&](gpu::Cmd& cmd) { cmd.transition(moving_map_, gpu::ImageUse::sampled, true); });
}

void ShadowMaps::describe(shared::GpuLighting& block) const {
  const dvec3 size_m = static_max_ - static_min_;
  block.light_x = vec3(frame_.x);
  block.light_y = vec3(frame_.y);
  block.static_map_size = float(static_map_.desc().width);
  block.moving_map_size = float(moving_map_.desc().width);
  block.static_texel_m = float(size_m.x / static_map_.desc().width);
  block.static_uv_scale = vec2(1.0 / dvec2(size_m));
  block.static_uv_offset = vec2(-dvec2(static_min_) / dvec2(size_m));
  block.static_depth_scale = float(1.0 / size_m.z);
  block.static_depth_offset = float(-static_min_.z / size_m.z);
}

void ShadowMaps::record(gpu::TickSlot& slot, std::span<const Pose> body_poses, const gpu::Slice& block) {
  if (casters_.empty()) return;
  const uint32_t map_size = moving_map_.desc().width;
  const double tile_uv = 1.0 / tiles_across_, texel_uv = 1.0 / map_size;
  shared::ShadowTilesHeader header{static_cast<uint32_t>(casters_.size()), vec2(1e30f), vec2(-1e30f)};
  const uint32_t count = header.count;
  tiles_ = slot.upload.allocate(sizeof header + casters_.size() * sizeof(shared::GpuShadowTile));
  for (uint32_t i = 0; i < count; ++i) {
    const Caster& caster = casters_[i];
    shared::GpuShadowTile tile;
    tile.center = vec3(frame_.from_local(body_poses[caster.body].apply(caster.center)));
    tile.radius = float(caster.radius);
    tile.uv_center = vec2((i % tiles_across_ + 0.5) * tile_uv, (i / tiles_across_ + 0.5) * tile_uv);
    // Three empty texels surround each tile, so that filtering never reaches its neighbour.
    tile.uv_radius = float(0.5 * tile_uv - 3.0 * texel_uv);
    tile.texel_m = float(caster.radius * texel_uv / tile.uv_radius);
    header.min = glm::min(header.min, vec2(tile.center) - tile.radius);
    header.max = glm::max(header.max, vec2(tile.center) + tile.radius);
    std::memcpy(tiles_.mapped + sizeof header + i * sizeof tile, &tile, sizeof tile);
  }
  std::memcpy(tiles_.mapped, &header, sizeof header);

  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope("moving shadow");
  cmd.transition(moving_map_, gpu::ImageUse::depth_target, true);
  cmd.begin_rendering(
      {.color = {}, .depth = &moving_map_, .clear_depth = 0.0f, .width = map_size, .height = map_size});
  std::vector<gpu::Descriptor> descriptors = scene_->raster_descriptors();
  descriptors.push_back(gpu::Descriptor::buffer(shared::lighting_binding, block));
  descriptors.back().type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  descriptors.push_back(gpu::Descriptor::buffer(shared::shadow_tiles_binding, tiles_));
  const auto draw_all = [&](const gpu::GraphicsPipeline& with, std::vector<uint32_t> Caster::*primitives) {
    if (!with) return;
    cmd.bind(with);
    cmd.push(descriptors);
    cmd.bind_indices(scene_->indices());
    for (uint32_t i = 0; i < count; ++i) {
      if ((casters_[i].*primitives).empty()) continue;
      cmd.constants(i);
      draw(cmd, casters_[i].*primitives);
    }
  };
  draw_all(moving_opaque_, &Caster::opaque);
  draw_all(moving_masked_, &Caster::masked);
  cmd.end_rendering();
  cmd.transition(moving_map_, gpu::ImageUse::sampled);
}

std::vector<gpu::Descriptor> ShadowMaps::descriptors() const {
  return {gpu::Descriptor::buffer(shared::shadow_tiles_binding, tiles_),
          gpu::Descriptor::sampled(shared::static_shadow_binding, static_map_, sampler_),
          gpu::Descriptor::sampled(shared::moving_shadow_binding, moving_map_, sampler_)};
}

}  // namespace greatx::render
