// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/lighting.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "renderer/daylight/haze.h"
#include "renderer/light/environment_map.h"
#include "renderer/light/horizon.h"
#include "renderer/light/night_sky.h"
#include "renderer/light/panorama.h"
#include "renderer/light/sky.h"
#include "renderer/light/sky_view.h"
#include "renderer/light/surroundings_words.h"
#include "shaders/shared/contact.h"
#include "shaders/shared/surroundings.h"
#include "shaders/shared/weather.h"

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
  in_range("clouds", lighting.clouds, 0.0, 1.0);
  in_range("ground albedo", lighting.ground_albedo, 0.0, 1.0);
  in_range("rain (mm/h)", lighting.rain_mm_h, 0.0, 1e3);
  in_range("wetness", lighting.wetness, 0.0, 1.0);
  in_range("puddles", lighting.puddles, 0.0, 1.0);
  in_range("snow", lighting.snow, 0.0, 1.0);
  in_range("static shadow map (texels)", lighting.static_shadow_texels, 64, 16384);
  in_range("moving shadow tile (texels)", lighting.moving_shadow_texels, 16, 2048);
}

/// Returns the value that ground_noise() exceeds on the given share of level ground: a quantile over a square
/// of 180 m.
float noise_level(double share) {
  if (share <= 0.0) return 2.0f;  // the noise stays below 1
  if (share >= 1.0) return -1.0f;
  constexpr int side = 192;
  std::vector<float> values;
  values.reserve(side * side);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) values.push_back(shared::ground_noise(vec2(dvec2(i, j) * 0.937)));
  const auto at = static_cast<ptrdiff_t>((1.0 - share) * double(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + at);
  return values[static_cast<size_t>(at)];
}

}  // namespace

FallingDrops falling_drops(double rain_mm_h) {
  FallingDrops drops;
  if (rain_mm_h <= 0.0) return drops;
  const double slope = 4.1 * std::pow(rain_mm_h, -0.21), least = shared::least_drop_mm;
  drops.slope_per_mm = slope;
  drops.per_m3 = shared::marshall_palmer_n0 / slope * std::exp(-slope * least);
  // The mean of D^2 over an exponential law that begins at `least`.
  const double square_mm2 = least * least + 2.0 * least / slope + 2.0 / (slope * slope);
  drops.extinction_per_m = 0.25 * pi * 1e-6 * square_mm2 * drops.per_m3;
  constexpr double most_m = 6.0, most_per_solid_angle = 4000.0;
  drops.reach_m = std::min(most_m, std::cbrt(3.0 * most_per_solid_angle / drops.per_m3));
  return drops;
}

dvec3 Lighting::direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

SceneLighting::SceneLighting(const scene::GpuScene& scene, const Lighting& lighting,
                             const CameraEffects& effects)
    : scene_(&scene), effects_(effects), surfaces_(scene, effects.switched_lamps) {
  check(lighting);
  effects_.sky = effects.sky && lighting.sky_illuminance_lux > 0.0;
  effects_.ambient_occlusion = effects.ambient_occlusion && effects_.sky && !scene.scene().bounds.empty();
  effects_.bounced_light = effects.bounced_light && effects_.ambient_occlusion;
  effects_.glass = effects.glass && effects_.sky && effects_.specular && !scene.scene().bounds.empty();
  if (effects.contact_occlusion && effects_.sky) contact_boxes_ = contact_boxes(scene.scene());
  effects_.contact_occlusion = !contact_boxes_.empty();
  effects_.haze = effects.haze && lighting.haze_extinction_per_m > 0.0;
  effects_.clouds = effects.clouds && effects_.sky && lighting.sky_model != SkyModel::uniform &&
                    (lighting.clouds > 0.0 || lighting.sky_model == SkyModel::overcast);
  if (effects.horizon && effects_.sky) {
    horizon_kind_ = lighting.horizon == HorizonKind::automatic ? horizon_of(scene.scene()) : lighting.horizon;
    // Whoever switches the effect on around an object or a room gets plain land.
    if (lighting.horizon == HorizonKind::automatic && horizon_kind_ == HorizonKind::none &&
        !scene.scene().bounds.empty())
      horizon_kind_ = HorizonKind::plain;
  }
  effects_.horizon = horizon_kind_ != HorizonKind::none;
  marks_ = MarkMap(scene, effects.markings);
  effects_.markings = effects.markings && marks_.any();
  effects_.punctual_lights = effects.punctual_lights && !scene.scene().lights.empty();
  const Sky sky(lighting, effects_.haze, effects_.clouds);
  const KeyLight key = key_light(lighting);
  effects_.sun = effects.sun && luminance(sky.key_illuminance()) > 0.0;
  if (effects_.sun) ground_illuminance_lux_ += luminance(sky.key_illuminance()) * key.direction.z;
  if (effects_.sky) ground_illuminance_lux_ += sky.illuminance();
  effects_.static_shadows = effects.static_shadows && effects_.sun;
  effects_.moving_shadows = effects.moving_shadows && effects_.sun;
  effects_.shadow_cascades = effects.shadow_cascades && effects_.static_shadows &&
                             !scene.scene().bounds.empty() && scene.scene().bodies[0].primitive_count > 0;
  shadows_ = ShadowMaps(scene, SunFrame::of(key.direction),
                        {.static_casters = effects_.static_shadows,
                         .moving_casters = effects_.moving_shadows,
                         .alpha_mask = effects_.alpha_mask,
                         .static_texels = lighting.static_shadow_texels,
                         .moving_tile_texels = lighting.moving_shadow_texels,
                         .closed = surfaces_.closed().bodies,
                         .panes = effects_.panes ? &surfaces_.materials() : nullptr});
  effects_.moving_shadows = effects_.moving_shadows && shadows_.moving().tile_count() > 0;
  body_poses_.resize(scene.scene().bodies.size());
  bake(lighting, sky);
  effects_.wet_surfaces = effects.wet_surfaces && (lighting.wetness > 0.0 || lighting.puddles > 0.0);
  effects_.snow_cover = effects.snow_cover && lighting.snow > 0.0;
  effects_.rain_streaks = effects.rain_streaks && lighting.rain_mm_h > 0.0;
  effects_.lamp_halos = effects.lamp_halos && effects_.punctual_lights && effects_.haze;
  const bool lamp_shadows = effects.lamp_shadows && effects_.punctual_lights;
  lamp_shadows_ = LampShadows(scene, {.wanted = lamp_shadows,
                                      .alpha_mask = effects_.alpha_mask,
                                      .beams = lamp_shadows && effects.beam_shadows});
  effects_.lamp_shadows = lamp_shadows_.tile_count() > 0;
  effects_.beam_shadows = lamp_shadows_.any_beams();
  rain_cover_ = RainCover(scene, effects_.wet_surfaces || effects_.snow_cover);
  bake_weather(lighting, sky);
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
  const vec3 ground_light = vec3((sky.key_illuminance() * (effects_.sun ? key.direction.z : 0.0) +
                                  sky.illuminance() + lamps_on_ground()) /
                                 pi);
  block.bounce = bounce_share * ground_light;
  bake_sky_view(block, sky, key);
  block.environment_scale = float(map.scale);
  // Light from below comes from the surroundings then.
  const auto irradiance = sky_irradiance(sky, !effects_.bounced_light);
  for (size_t i = 0; i < irradiance.size(); ++i) block.irradiance[i] = vec4(vec3(irradiance[i]), 0.0f);
  block_ = gpu::upload_buffer(device, std::as_bytes(std::span(&block, 1)), "lighting",
                              VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  bake_land(lighting, sky, dvec3(irradiance[0] + irradiance[2] + 2.0 * irradiance[6]) * pi);
  bake_panorama_of(sky, map.scale);

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

void SceneLighting::bake_land(const Lighting& lighting, const Sky& sky, const dvec3& sky_lux) {
  shared::GpuHorizon land{};
  if (effects_.horizon) {
    const KeyLight key = key_light(lighting);
    land = describe_horizon(scene_->scene(), horizon_kind_, lighting,
                            {.key = effects_.sun ? sky.key_illuminance() : dvec3(0.0),
                             .sky = sky_lux,
                             .key_height = key.direction.z,
                             .lamps = lamps_on_ground(),
                             .air_light = air_light_of(sky, effects_.clouds)});
  }
  horizon_ = gpu::upload_buffer(scene_->device(), std::as_bytes(std::span(&land, 1)), "horizon",
                                VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
}

void SceneLighting::bake_panorama_of(const Sky& sky, double scale) {
  constexpr uint32_t panorama_size = 768;
  const uint32_t size = effects_.clouds ? panorama_size : 1;
  const std::vector<uint16_t> texels =
      effects_.clouds ? bake_panorama(sky, size, scale) : std::vector<uint16_t>(4);
  panorama_ = gpu::Image(scene_->device(),
                         {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                          .width = size,
                          .height = size,
                          .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                         "sky panorama");
  const std::span<const std::byte> mip = std::as_bytes(std::span(texels));
  gpu::upload_image(scene_->device(), panorama_, std::span(&mip, 1));
}

dvec3 SceneLighting::lamps_on_ground() const {
  const scene::Scene& scene = scene_->scene();
  dvec3 flux(0.0);
  if (!effects_.punctual_lights || scene.bounds.empty()) return flux;
  for (const scene::PunctualLight& light : scene.lights)
    if (light.body == 0) flux += lamp_flux(light);
  const dvec3 extent = scene.bounds.size();
  return flux / std::max(extent.x * extent.y, 1.0);
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
    const Surroundings surroundings(
        scene_->scene(), field, light,
        {effects_.punctual_lights ? std::span(lamps) : std::span(lamps).first(0), effects_.emissive});
    words = surroundings_words(surroundings, effects_.bounced_light);
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

void SceneLighting::bake_weather(const Lighting& lighting, const Sky& sky) {
  shared::GpuWeather block{};
  if (effects_.rain_streaks) {
    drops_ = falling_drops(lighting.rain_mm_h);
    // The mean radiance around a drop: of the air, which is scaled with it, or of sky and ground.
    const dvec3 around = effects_.haze ? sky.haze_ambient()
                                       : dvec3(0.5 * (1.0 + lighting.ground_albedo) * sky.illuminance() / pi);
    drops_.radiance = double(shared::drop_brightness) * around;
    if (effects_.haze) {
      block.drop_extinction = float(std::min(drops_.extinction_per_m, lighting.haze_extinction_per_m));
      block.drop_reach = float(drops_.reach_m);
    }
  }
  block.wetness = float(lighting.wetness);
  block.puddle_level =
      noise_level(effects_.wet_surfaces ? lighting.puddles : 0.0) - 0.5f * shared::puddle_rim;
  block.snow_level = noise_level(effects_.snow_cover ? lighting.snow : 0.0);
  // Drops stir puddles: 10 mm/h add 0.05 to the roughness of still water, 50 mm/h and more 0.1.
  block.ripple = shared::puddle_roughness + float(std::min(0.1, 0.05 * std::sqrt(lighting.rain_mm_h / 10.0)));
  rain_cover_.describe(block);
  lamp_shadows_.describe(block);
  weather_ = gpu::upload_buffer(scene_->device(), std::as_bytes(std::span(&block, 1)), "weather",
                                VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
}

void SceneLighting::record(gpu::TickSlot& slot, std::span<const Pose> body_poses) {
  GREATX_CHECK(body_poses.size() == body_poses_.size(), "{} poses for {} bodies", body_poses.size(),
               body_poses_.size());
  body_poses_.assign(body_poses.begin(), body_poses.end());
  body_poses_[0] = Pose{};
  if (effects_.moving_shadows) shadows_.moving().record(slot, body_poses_);
  if (effects_.lamp_shadows) lamp_shadows_.record(slot, body_poses_);
  if (effects_.contact_occlusion) {
    const std::vector<uint32_t> words = contact_words(contact_boxes_, body_poses_);
    contact_ = slot.upload.put(std::span<const uint32_t>(words));
  }
}

void SceneLighting::draw_shadows(gpu::TickSlot& slot, const MovingShadows::Outside& outside) const {
  if (effects_.moving_shadows) shadows_.moving().draw(slot, outside);
}

std::vector<BeamTile> SceneLighting::draw_beams(gpu::TickSlot& slot, const BeamView& view) const {
  return lamp_shadows_.record_beams(slot, body_poses_, view);
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
  std::vector<gpu::Binding> all = MarkMap::bindings();
  for (const gpu::Binding& binding : std::initializer_list<gpu::Binding>{
           {shared::lighting_binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
           {shared::shadow_tiles_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
           {shared::stars_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
           {shared::horizon_binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
           {shared::contact_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
           {shared::surroundings_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
           {shared::weather_binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
           {shared::rain_cover_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
           {shared::lamp_shadow_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
           {shared::panorama_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
           {shared::sky_view_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
           {shared::environment_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
           {shared::static_shadow_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
           {shared::moving_shadow_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}})
    all.push_back(binding);
  return all;
}

std::vector<gpu::Descriptor> SceneLighting::descriptors() const {
  std::vector<gpu::Descriptor> all = shadows_.descriptors();
  for (const gpu::Descriptor& descriptor : marks_.descriptors()) all.push_back(descriptor);
  all.push_back(gpu::Descriptor::buffer(shared::lighting_binding, block_));
  all.back().type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  all.push_back(gpu::Descriptor::buffer(shared::weather_binding, weather_));
  all.back().type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  all.push_back(rain_cover_.descriptor());
  all.push_back(lamp_shadows_.descriptor());
  all.push_back(gpu::Descriptor::buffer(shared::stars_binding, stars_));
  all.push_back(gpu::Descriptor::buffer(shared::horizon_binding, horizon_));
  all.back().type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  all.push_back(gpu::Descriptor::sampled(shared::panorama_binding, panorama_, sky_view_sampler_));
  all.push_back(gpu::Descriptor::buffer(shared::surroundings_binding, surroundings_));
  // A shader without the effect does not read the slot that stands for it.
  all.push_back(effects_.contact_occlusion ? gpu::Descriptor::buffer(shared::contact_binding, contact_)
                                           : gpu::Descriptor::buffer(shared::contact_binding, surroundings_));
  all.push_back(gpu::Descriptor::sampled(shared::sky_view_binding, sky_view_, sky_view_sampler_));
  all.push_back(gpu::Descriptor::sampled(shared::environment_binding, environment_, environment_sampler_));
  return all;
}

}  // namespace greatx::render
