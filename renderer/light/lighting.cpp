// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/lighting.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "renderer/light/sky.h"

namespace greatx::render {

namespace {

void check(const Lighting& lighting) {
  const auto in_range = [](const char* name, double value, double least, double most) {
    if (!(value >= least && value <= most))
      throw_user_error("lighting: {}: expected {} to {}, found {}", name, least, most, value);
  };
  in_range("length of the sun's direction", glm::length(lighting.sun_direction), 1.0 - 1e-6, 1.0 + 1e-6);
  in_range("sun illuminance (lux)", lighting.sun_illuminance_lux, 0.0, 1e6);
  in_range("sky illuminance (lux)", lighting.sky_illuminance_lux, 0.0, 1e6);
  in_range("turbidity", lighting.turbidity, 1.1, 10.0);
  in_range("ground albedo", lighting.ground_albedo, 0.0, 1.0);
  in_range("static shadow map (texels)", lighting.static_shadow_texels, 64, 16384);
  in_range("moving shadow tile (texels)", lighting.moving_shadow_texels, 16, 2048);
}

}  // namespace

dvec3 Lighting::direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

SceneLighting::SceneLighting(const scene::GpuScene& scene, const Lighting& lighting,
                             const CameraEffects& effects)
    : scene_(&scene), effects_(effects) {
  check(lighting);
  const bool sun_shines = lighting.sun_direction.z > 0.0 && lighting.sun_illuminance_lux > 0.0;
  effects_.sun = effects.sun && sun_shines;
  effects_.sky = effects.sky && lighting.sky_illuminance_lux > 0.0;
  if (effects_.sun) ground_illuminance_lux_ += lighting.sun_illuminance_lux * lighting.sun_direction.z;
  if (effects_.sky) ground_illuminance_lux_ += lighting.sky_illuminance_lux;
  effects_.static_shadows = effects.static_shadows && effects_.sun;
  effects_.moving_shadows = effects.moving_shadows && effects_.sun;
  shadows_ = ShadowMaps(scene, SunFrame::of(lighting.sun_direction),
                        {.static_casters = effects_.static_shadows,
                         .moving_casters = effects_.moving_shadows,
                         .alpha_mask = effects_.alpha_mask,
                         .static_texels = lighting.static_shadow_texels,
                         .moving_tile_texels = lighting.moving_shadow_texels});
  effects_.moving_shadows = effects_.moving_shadows && shadows_.tile_count() > 0;
  body_poses_.resize(scene.scene().bodies.size());
  bake(lighting);
  std::vector<uint32_t> triangle_primitives(scene.scene().triangle_count());
  for (uint32_t i = 0; i < scene.scene().primitives.size(); ++i) {
    const scene::Primitive& primitive = scene.scene().primitives[i];
    std::fill_n(triangle_primitives.begin() + primitive.first_index / 3, primitive.index_count / 3, i);
  }
  triangle_primitives_ = gpu::upload_buffer(scene.device(), std::as_bytes(std::span(triangle_primitives)),
                                            "primitives of triangles");
}

void SceneLighting::bake(const Lighting& lighting) {
  gpu::Device& device = scene_->device();
  const Sky sky(lighting);
  EnvironmentMap map;
  if (effects_.sky) {
    map = bake_environment(sky, shared::environment_size, shared::environment_levels);
  } else {
    map.levels = {std::vector<uint16_t>(4)};
  }

  shared::GpuLighting block{};
  shadows_.describe(block);
  block.sun_direction = vec3(lighting.sun_direction);
  block.sun_cos_radius = float(std::cos(sun_radius));
  block.sun_illuminance = vec3(sky.sun_illuminance());
  block.sun_disc = vec3(sky.sun_illuminance() / (2.0 * pi * (1.0 - std::cos(sun_radius))));
  block.environment_scale = float(map.scale);
  const auto irradiance = sky_irradiance(sky);
  for (size_t i = 0; i < irradiance.size(); ++i) block.irradiance[i] = vec4(vec3(irradiance[i]), 0.0f);
  block_ = gpu::upload_buffer(device, std::as_bytes(std::span(&block, 1)), "lighting",
                              VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);

  const auto levels = static_cast<uint32_t>(map.levels.size());
  const uint32_t edge = effects_.sky ? shared::environment_size : 1;
  environment_ = gpu::Image(device,
                            {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                             .width = edge,
                             .height = edge,
                             .mip_levels = levels,
                             .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                            "environment");
  environment_sampler_ = gpu::Sampler(
      device, {.linear = true, .repeat_u = false, .repeat_v = false, .mipmaps = true}, "environment");
  std::vector<gpu::Buffer> staging;
  for (const std::vector<uint16_t>& texels : map.levels) {
    staging.emplace_back(device, texels.size() * sizeof(uint16_t), gpu::Memory::upload,
                         "environment staging");
    std::ranges::copy(texels, staging.back().slice().as<uint16_t>().begin());
  }
  gpu::submit_setup(device, [&](gpu::Cmd& cmd) {
    cmd.transition(environment_, gpu::ImageUse::transfer_target, true);
    for (uint32_t level = 0; level < levels; ++level) cmd.copy(staging[level].slice(), environment_, level);
    cmd.transition(environment_, gpu::ImageUse::sampled);
  });
}

void SceneLighting::record(gpu::TickSlot& slot, std::span<const Pose> body_poses) {
  GREATX_CHECK(body_poses.size() == body_poses_.size(), "{} poses for {} bodies", body_poses.size(),
               body_poses_.size());
  body_poses_.assign(body_poses.begin(), body_poses.end());
  body_poses_[0] = Pose{};
  if (effects_.moving_shadows) shadows_.record(slot, body_poses_, block_.slice());
}

std::vector<gpu::Binding> SceneLighting::bindings() {
  return {{shared::lighting_binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
          {shared::shadow_tiles_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {shared::triangle_primitives_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {shared::environment_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
          {shared::static_shadow_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
          {shared::moving_shadow_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}};
}

std::vector<gpu::Descriptor> SceneLighting::descriptors() const {
  std::vector<gpu::Descriptor> all = shadows_.descriptors();
  all.push_back(gpu::Descriptor::buffer(shared::lighting_binding, block_));
  all.back().type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  all.push_back(gpu::Descriptor::buffer(shared::triangle_primitives_binding, triangle_primitives_));
  all.push_back(gpu::Descriptor::sampled(shared::environment_binding, environment_, environment_sampler_));
  return all;
}

}  // namespace greatx::render
