// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/shadow.h"

#include <algorithm>
#include <cmath>

#include "renderer/light/shadow_raster.h"
#include "renderer/surface/pane_color.h"

namespace greatx::render {

namespace {

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
  const std::vector<bool> is_pane = pane_materials(scene.scene());
  if (std::ranges::find(is_pane, true) == is_pane.end()) options_.panes = nullptr;
  sampler_ = shadow_sampler(scene.device(), "shadow");
  build_static(options.alpha_mask);
  moving_ = MovingShadows(scene, frame,
                          {.casters = options.moving_casters,
                           .alpha_mask = options.alpha_mask,
                           .tile_texels = options.moving_tile_texels,
                           .closed = options.closed,
                           .panes = options_.panes});
}

void ShadowMaps::build_static(bool alpha_mask) {
  const scene::Scene& scene = scene_->scene();
  std::vector<uint32_t> opaque, masked, panes;
  const std::vector<bool> is_pane = pane_materials(scene, options_.panes != nullptr);
  scene::Bounds bounds;
  const scene::Body& world = scene.bodies[0];
  if (options_.static_casters)
    for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i)
      (is_pane[scene.primitives[i].material] ? panes
       : alpha_mask && scene.has_holes(i)    ? masked
                                             : opaque)
          .push_back(i);
  const bool wanted = !opaque.empty() || !masked.empty() || !panes.empty();
  const uint32_t size = wanted ? options_.static_texels : 1;
  static_map_ = shadow_map(scene_->device(), size, "static shadow map");
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

  shared::CasterConstants constants;
  const dvec3 center = 0.5 * (static_min_ + static_max_), size_m = static_max_ - static_min_;
  constants.rows[0] = row_of(frame_.x, 2.0 / size_m.x, -2.0 * center.x / size_m.x);
  constants.rows[1] = row_of(frame_.y, 2.0 / size_m.y, -2.0 * center.y / size_m.y);
  constants.rows[2] = row_of(frame_.z, 1.0 / size_m.z, -static_min_.z / size_m.z);
  constants.rows[3] = vec4(0.0f, 0.0f, 0.0f, 1.0f);
  gpu::GraphicsPipeline opaque_pipeline, masked_pipeline, pane_pipeline;
  if (!opaque.empty()) opaque_pipeline = caster_pipeline(*scene_, false, false, "static shadow");
  if (!masked.empty()) masked_pipeline = caster_pipeline(*scene_, false, true, "static shadow");
  if (!panes.empty()) pane_pipeline = pane_caster_pipeline(*scene_, "static shadow");
  gpu::submit_setup(scene_->device(), [&](gpu::Cmd& cmd) {
    const auto scope = cmd.scope("static shadow");
    cmd.transition(static_map_, gpu::ImageUse::depth_target, true);
    cmd.begin_rendering(
        {.color = {}, .depth = &static_map_, .clear_depth = 0.0f, .width = size, .height = size});
    const auto draw_all = [&](const gpu::GraphicsPipeline& with, std::span<const uint32_t> primitives) {
      if (primitives.empty()) return;
      cmd.bind(with);
      cmd.push(static_caster_descriptors(*scene_, &with == &pane_pipeline ? options_.panes : nullptr));
      cmd.constants(constants);
      cmd.bind_indices(scene_->indices());
      draw_casters(cmd, scene, primitives);
    };
    draw_all(opaque_pipeline, opaque);
    draw_all(masked_pipeline, masked);
    draw_all(pane_pipeline, panes);
    cmd.end_rendering();
    cmd.transition(static_map_, gpu::ImageUse::sampled);
  });
}

void ShadowMaps::describe(shared::GpuLighting& block) const {
  const dvec3 size_m = static_max_ - static_min_;
  block.light_x = vec3(frame_.x);
  block.light_y = vec3(frame_.y);
  block.static_map_size = float(static_map_.desc().width);
  block.moving_map_size = float(moving_.map_size());
  block.static_texel_m = float(size_m.x / static_map_.desc().width);
  block.static_uv_scale = vec2(1.0 / dvec2(size_m));
  block.static_uv_offset = vec2(-dvec2(static_min_) / dvec2(size_m));
  block.static_depth_scale = float(1.0 / size_m.z);
  block.static_depth_offset = float(-static_min_.z / size_m.z);
}

std::vector<gpu::Descriptor> ShadowMaps::descriptors() const {
  return {gpu::Descriptor::buffer(shared::shadow_tiles_binding, moving_.tiles()),
          gpu::Descriptor::sampled(shared::static_shadow_binding, static_map_, sampler_),
          gpu::Descriptor::sampled(shared::moving_shadow_binding, moving_.map(), sampler_)};
}

}  // namespace greatx::render
