// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/rain_cover.h"

#include <algorithm>

#include "renderer/light/shadow_raster.h"

namespace greatx::render {

namespace {
constexpr uint32_t cover_texels = 2048;
}  // namespace

RainCover::RainCover(const scene::GpuScene& gpu_scene, bool wanted) {
  const scene::Scene& scene = gpu_scene.scene();
  std::vector<uint32_t> roofs;
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; wanted && i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Material& material = scene.materials[scene.primitives[i].material];
    const bool drips = scene.has_holes(i) || (material.radio && material.radio->foliage);
    if (!drips) roofs.push_back(i);
  }
  const uint32_t size = roofs.empty() ? 1 : cover_texels;
  map_ = shadow_map(gpu_scene.device(), size, "rain cover");
  sampler_ = shadow_sampler(gpu_scene.device(), "rain cover");
  gpu::GraphicsPipeline pipeline;
  shared::CasterConstants constants{};
  if (!roofs.empty()) {
    // Two empty texels surround the map, so that what is outside is open.
    const dvec3 extent = scene.bounds.size();
    const double edge = std::max({extent.x, extent.y, 1e-3}) * size / (size - 4.0);
    const dvec3 half(0.5 * edge, 0.5 * edge, 0.5 * extent.z + 0.5);
    least_ = scene.bounds.center() - half;
    most_ = scene.bounds.center() + half;
    const dvec3 middle = 0.5 * (least_ + most_), size_m = most_ - least_;
    constants.rows[0] = vec4(dvec4(2.0 / size_m.x, 0.0, 0.0, -2.0 * middle.x / size_m.x));
    constants.rows[1] = vec4(dvec4(0.0, 2.0 / size_m.y, 0.0, -2.0 * middle.y / size_m.y));
    constants.rows[2] = vec4(dvec4(0.0, 0.0, 1.0 / size_m.z, -least_.z / size_m.z));
    constants.rows[3] = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    pipeline = caster_pipeline(gpu_scene, false, false, "rain cover");
  }
  gpu::submit_setup(gpu_scene.device(), [&](gpu::Cmd& cmd) {
    const auto scope = cmd.scope("rain cover");
    cmd.transition(map_, gpu::ImageUse::depth_target, true);
    cmd.begin_rendering({.color = {}, .depth = &map_, .clear_depth = 0.0f, .width = size, .height = size});
    if (!roofs.empty()) {
      cmd.bind(pipeline);
      cmd.push(static_caster_descriptors(gpu_scene));
      cmd.constants(constants);
      cmd.bind_indices(gpu_scene.indices());
      draw_casters(cmd, scene, roofs);
    }
    cmd.end_rendering();
    cmd.transition(map_, gpu::ImageUse::sampled);
  });
}

void RainCover::describe(shared::GpuWeather& block) const {
  const dvec3 size_m = most_ - least_;
  block.cover_uv_scale = vec2(1.0 / dvec2(size_m));
  block.cover_uv_offset = vec2(-dvec2(least_) / dvec2(size_m));
  block.cover_depth_scale = float(1.0 / size_m.z);
  block.cover_depth_offset = float(-least_.z / size_m.z);
  block.cover_texel_m = float(size_m.x / map_.desc().width);
}

gpu::Descriptor RainCover::descriptor() const {
  return gpu::Descriptor::sampled(shared::rain_cover_binding, map_, sampler_);
}

}  // namespace greatx::render
