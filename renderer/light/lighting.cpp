// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/lighting.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "renderer/daylight/haze.h"
#include "renderer/light/environment_map.h"
#include "renderer/light/night_sky.h"
#include "renderer/light/sky.h"
#include "renderer/light/sky_view.h"
#include "renderer/light/surroundings.h"
#include "shaders/shared/contact.h"
#include "shaders/shared/surroundings.h"

namespace greatx::render {

namespace {

/// The share of the ground's radiance that the objects which hide the sky send on: an albedo of 0.2, seen
/// half in the shade.
constexpr float bounce_share = 0.1f;

void check(const Lighting& lighting) {
  const auto in_range = [](const char* name, double value, double least, double most) {
    if (!(value >= least && value <= most))
      throw_user_error("lighting: {}: expected {} to {}, found {}", name, least, most, value);
  };
  in_range("length of the sun's direction", glm::length(lighting.sun_direction), 1.0 - 1e-6, 1.0 + 1e-6);
  in_range("sun illuminance (lux)", lighting.sun_illuminance_lux, 0.0, 1e6);
  in_range("length of the moon's direction", glm::length(lighting.moon_direction), 1.0 - 1e-6, 1.0 + 1e-6);
  in_range("moon illuminance (lux)", lighting.moon_illuminance_lux, 0.0, 1e6);
  in_range("moon phase angle (rad)", lighting.moon_phase_angle, 0.0, pi);
  in_range("sky glow (cd/m^2)", lighting.sky_glow_cd_m2, 0.0, 1e3);
  in_range("haze extinction (1/m)", lighting.haze_extinction_per_m, 0.0, 10.0);
  in_range("haze depth", lighting.haze_depth, 0.0, 1e4);
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
    : scene_(&scene), effects_(effects), surfaces_(scene) {
  check(lighting);
  effects_.sky = effects.sky && lighting.sky_illuminance_lux > 0.0;
  effects_.ambient_occlusion = effects.ambient_occlusion && effects_.sky && !scene.scene().bounds.empty();
  effects_.bounced_light = effects.bounced_light && effects_.ambient_occlusion;
  effects_.glass = effects.glass && effects_.sky && effects_.specular && !scene.scene().bounds.empty();
  if (effects.contact_occlusion && effects_.sky) contact_boxes_ = contact_boxes(scene.scene());
  effects_.contact_occlusion = !contact_boxes_.empty();
  effects_.haze = effects.haze && lighting.haze_extinction_per_m > 0.0;
  const Sky sky(lighting, effects_.haze);
  const KeyLight key = key_light(lighting);
  effects_.sun = effects.sun && luminance(sky.key_illuminance()) > 0.0;
  if (effects_.sun) ground_illuminance_lux_ += luminance(sky.key_illuminance()) * key.direction.z;
  if (effects_.sky) ground_illuminance_lux_ += sky.illuminance();
  effects_.static_shadows = effects.static_shadows && effects_.sun;
  effects_.moving_shadows = effects.moving_shadows && effects_.sun;
  shadows_ = ShadowMaps(scene, SunFrame::of(key.direction),
                        {.static_casters = effects_.static_shadows,
                         .moving_casters = effects_.moving_shadows,
                         .alpha_mask = effects_.alpha_mask,
                         .static_texels = lighting.static_shadow_texels,
                         .moving_tile_texels = lighting.moving_shadow_texels});
  effects_.moving_shadows = effects_.moving_shadows && shadows_.tile_count() > 0;
  body_poses_.resize(scene.scene().bodies.size());
  bake(lighting, sky);
}

void SceneLighting::bake(const Lighting& lighting, const Sky& sky) {
  gpu::Device& device = scene_->device();
  EnvironmentMap map;
  if (effects_.sky) {
    map = bake_environment(sky, shared::environment_size, shared::environment_levels);
  } else {
    map.levels = {std::vector<uint16_t>(4)};
  }

  shared::GpuLighting block{};
  shadows_.describe(block);
  const KeyLight key = key_light(lighting);
  block.sun_direction = vec3(key.direction);
  block.sun_cos_radius = float(std::cos(sun_radius));
  block.sun_illuminance = vec3(sky.key_illuminance());
  if (key.body == KeyLight::Body::sun)
    block.sun_disc = vec3(sky.key_illuminance() / (2.0 * pi * (1.0 - std::cos(sun_radius))));
  block.haze_extinction = float(lighting.haze_extinction_per_m);
  block.haze_asymmetry = float(haze_asymmetry);
  block.haze_ambient = vec3(sky.haze_ambient());
  block.haze_directed = vec3(sky.haze_directed());
  std::vector<shared::GpuStar> stars(1, shared::GpuStar{0, 0});
  if (effects_.night_sky) {
    const double depth = effects_.haze ? lighting.haze_depth : 0.0;
    const double z = std::max(lighting.moon_direction.z, 1e-9);
    describe_moon(block, lighting,
                  key.body == KeyLight::Body::moon
                      ? sky.key_illuminance()
                      : dvec3(lighting.moon_illuminance_lux * std::exp(-depth / z)));
    stars = gpu_stars(draw_stars(lighting.star_seed), depth);
  }
  stars_ = gpu::upload_buffer(device, std::as_bytes(std::span(stars)), "stars");
  const vec3 ground_light =
      vec3((sky.key_illuminance() * (effects_.sun ? key.direction.z : 0.0) + sky.illuminance()) / pi);
  block.bounce = bounce_share * ground_light;
  bake_sky_view(block, sky, key);
  block.environment_scale = float(map.scale);
  // Light from below comes from the surroundings then.
  const auto irradiance = sky_irradiance(sky, !effects_.bounced_light);
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
  std::vector<std::span<const std::byte>> mips;
  for (const std::vector<uint16_t>& texels : map.levels) mips.push_back(std::as_bytes(std::span(texels)));
  gpu::upload_image(device, environment_, mips);
}

void SceneLighting::bake_sky_view(shared::GpuLighting& block, const Sky& sky, const KeyLight& key) {
  HeightField field;
  std::vector<uint16_t> texels(4);
  std::vector<uint32_t> words(2);
  if (effects_.ambient_occlusion || effects_.glass) field = height_field(scene_->scene());
  if (effects_.bounced_light || effects_.glass) {
    SurroundingLight light;
    light.key_direction = key.direction;
    if (effects_.sun) light.key_lux = sky.key_illuminance();
    light.sky_lux = pi * sky_irradiance(sky)[0];
    light.beyond = sky.radiance({0.0, 0.0, -1.0});
    const std::vector<scene::PunctualLight>& lamps = scene_->scene().lights;
    words = Surroundings(scene_->scene(), field, light,
                         effects_.punctual_lights ? std::span(lamps) : std::span(lamps).first(0))
                .words();
  }
  if (effects_.ambient_occlusion) {
    texels = sky_view_texels(field);
    describe_sky_view(field, block);
  } else {
    field = {};
  }
  gpu::Device& device = scene_->device();
  surroundings_ = gpu::upload_buffer(device, std::as_bytes(std::span(words)), "surroundings");
  sky_view_ = gpu::Image(device,
                         {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                          .width = field.width,
                          .height = field.height,
                          .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                         "sky view");
  sky_view_sampler_ =
      gpu::Sampler(device, {.linear = true, .repeat_u = false, .repeat_v = false}, "sky view");
  const std::span<const std::byte> mip = std::as_bytes(std::span(texels));
  gpu::upload_image(device, sky_view_, std::span(&mip, 1));
}

void SceneLighting::record(gpu::TickSlot& slot, std::span<const Pose> body_poses) {
  GREATX_CHECK(body_poses.size() == body_poses_.size(), "{} poses for {} bodies", body_poses.size(),
               body_poses_.size());
  body_poses_.assign(body_poses.begin(), body_poses.end());
  body_poses_[0] = Pose{};
  if (effects_.moving_shadows) shadows_.record(slot, body_poses_, block_.slice());
  if (effects_.contact_occlusion) {
    const std::vector<uint32_t> words = contact_words(contact_boxes_, body_poses_);
    contact_ = slot.upload.put(std::span<const uint32_t>(words));
  }
}

std::vector<gpu::Binding> SceneLighting::surface_bindings() {
  std::vector<gpu::Binding> all = scene::GpuScene::raster_bindings();
  for (const gpu::Binding& binding : SurfaceTables::bindings()) all.push_back(binding);
  return all;
}

std::vector<gpu::Descriptor> SceneLighting::surface_descriptors() const {
  std::vector<gpu::Descriptor> all = scene_->raster_descriptors();
  for (const gpu::Descriptor& descriptor : surfaces_.descriptors()) all.push_back(descriptor);
  return all;
}

std::vector<gpu::Binding> SceneLighting::bindings() {
  return {{shared::lighting_binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
          {shared::shadow_tiles_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {shared::stars_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {shared::contact_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {shared::surroundings_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {shared::sky_view_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
          {shared::environment_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
          {shared::static_shadow_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
          {shared::moving_shadow_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}};
}

std::vector<gpu::Descriptor> SceneLighting::descriptors() const {
  std::vector<gpu::Descriptor> all = shadows_.descriptors();
  all.push_back(gpu::Descriptor::buffer(shared::lighting_binding, block_));
  all.back().type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  all.push_back(gpu::Descriptor::buffer(shared::stars_binding, stars_));
  all.push_back(gpu::Descriptor::buffer(shared::surroundings_binding, surroundings_));
  // A shader without the effect does not read the slot that stands for it.
  all.push_back(effects_.contact_occlusion ? gpu::Descriptor::buffer(shared::contact_binding, contact_)
                                           : gpu::Descriptor::buffer(shared::contact_binding, surroundings_));
  all.push_back(gpu::Descriptor::sampled(shared::sky_view_binding, sky_view_, sky_view_sampler_));
  all.push_back(gpu::Descriptor::sampled(shared::environment_binding, environment_, environment_sampler_));
  return all;
}

}  // namespace greatx::render
