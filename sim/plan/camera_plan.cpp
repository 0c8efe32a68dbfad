// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/camera_plan.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "renderer/camera/camera_view.h"
#include "renderer/camera/thin_lines.h"
#include "renderer/lens/lens_rays.h"
#include "renderer/light/horizon.h"
#include "renderer/light/sky.h"
#include "renderer/surface/mark_map.h"
#include "renderer/surface/pane_color.h"
#include "scene/description/lamps.h"
#include "shaders/shared/camera.h"
#include "shaders/shared/surroundings.h"
#include "sim/plan/camera_desc.h"
#include "sim/plan/light_plan.h"

namespace greatx::sim {

namespace {

/// Formats an illuminance with enough digits for sunlight and starlight alike.
std::string digits(double lux) {
  return lux >= 10.0 ? fmt::format("{:.0f}", lux) : fmt::format("{:.2g}", lux);
}

/// Returns the illuminance, lux, that a lamp gives the ground below it: E = I / h^2. The height h is at least
/// 1 m, since a lamp nearer to a surface lights only a spot of its own size.
double lamp_illuminance(const scene::PunctualLight& light, double ground) {
  if (light.type == scene::PunctualLight::Type::directional) return light.intensity;
  const double height = std::max(1.0, light.position.z - ground);
  return static_cast<double>(light.intensity) / (height * height);
}

}  // namespace

Offers offers_of(const scene::Scene& scene) {
  Offers offers;
  for (uint32_t i = 0; i < scene.primitives.size(); ++i)
    offers.thin_lines = offers.thin_lines || render::may_hold_lines(scene, i);
  for (const scene::Primitive& primitive : scene.primitives) {
    const scene::PbrMaterial& pbr = scene.materials[primitive.material].pbr;
    const bool moving = scene.instances[primitive.instance].body != 0;
    offers.triangles = true;
    (moving ? offers.moving_triangles : offers.static_triangles) = true;
    offers.textures |= pbr.base_color_texture >= 0 || pbr.metallic_roughness_texture >= 0 ||
                       pbr.emissive_texture >= 0 || pbr.normal_texture >= 0;
    const scene::Material& material = scene.materials[primitive.material];
    offers.reflectance_textures |=
        pbr.base_color_texture >= 0 && !(material.reflectance_905nm && material.reflectance_1550nm);
    offers.panes |= render::pane_color(pbr).has_value();
    offers.normal_maps |= pbr.normal_texture >= 0;
    offers.markings |= render::marks_of(scene, primitive) == shared::triangle_of_mark;
    offers.smooth |=
        pbr.metallic_roughness_texture >= 0 || pbr.roughness < shared::surroundings_most_roughness;
    offers.alpha_mask |= pbr.alpha_mode == scene::AlphaMode::mask;
    if (scene::lamp_role(material)) {
      offers.switched_lamps |= pbr.emissive != vec3(0.0f);
      continue;  // they shine by day, too
    }
    offers.emissive |= pbr.emissive != vec3(0.0f);
    offers.brightest_cd_m2 =
        std::max(offers.brightest_cd_m2, shared::emissive_nits * render::luminance(dvec3(pbr.emissive)));
  }
  offers.lights = scene.lights.size();
  offers.horizon = render::horizon_of(scene);
  if (!scene.bounds.empty()) offers.width_m = glm::length(dvec2(scene.bounds.size()));
  const double ground = scene.bounds.empty() ? 0.0 : scene.bounds.min.z;
  for (const scene::PunctualLight& light : scene.lights)
    offers.lamp_illuminance_lux = std::max(offers.lamp_illuminance_lux, lamp_illuminance(light, ground));
  return offers;
}

namespace {

void add(CameraAsks& asks, const PinholeConfig& camera) {
  asks.smooth_edges |= camera.smooth_edges;
  asks.distortion |= camera.distortion.any();
  asks.wide_lens |= camera.wide.any();
}

void add(CameraAsks& asks, const CameraConfig& camera) {
  ++asks.cameras;
  asks.rgb |= camera.rgb;
  asks.depth |= camera.depth || camera.depth_png24 || camera.depth_log;
  asks.ids |= camera.ids;
  asks.hdr |= camera.hdr;
  asks.depth_ray |= camera.depth_ray;
  asks.normals |= camera.normals;
  asks.flow |= camera.flow;
  asks.boxes |= camera.boxes;
  asks.vignetting |= camera.rgb && camera.vignetting.any();
  asks.noise |= camera.rgb && camera.noise.has_value();
  asks.rolling_shutter |= camera.rolling.any();
  asks.chromatic_aberration |= camera.chromatic.any() && (camera.rgb || camera.hdr);
  asks.drops |= camera.drops.any() && (camera.rgb || camera.hdr);
  asks.glare |= camera.glare > 0.0 && (camera.rgb || camera.hdr);
  asks.motion_blur |= camera.motion_blur_samples > 0 && (camera.rgb || camera.hdr);
  asks.automatic_exposure |= camera.rgb && camera.exposure.automatic;
  add(asks, static_cast<const PinholeConfig&>(camera));
}

}  // namespace

CameraAsks camera_asks_of(const Scenario& scenario) {
  CameraAsks asks;
  for (const NodeConfig& node : scenario.nodes) {
    for (const SensorConfig& sensor : node.sensors) {
      if (const auto* camera = std::get_if<CameraConfig>(&sensor.config)) {
        add(asks, *camera);
      } else if (const auto* events = std::get_if<EventCameraConfig>(&sensor.config)) {
        ++asks.event_cameras;
        asks.shared_pixels += events->camera.empty() ? 0 : 1;
        asks.adaptive_events |= events->steps == EventCameraConfig::Steps::by_flow ||
                                events->steps == EventCameraConfig::Steps::by_brightness;
        add(asks, static_cast<const PinholeConfig&>(*events));
      } else if (const auto* lidar = std::get_if<LidarConfig>(&sensor.config)) {
        ++asks.lidars;
        asks.sweep |= render::duration_s(lidar->scan) > 0.0;
      }
    }
  }
  return asks;
}

std::string haze_reason(const Environment& environment) {
  return fmt::format("fog and rain leave {:.0f} m of visibility",
                     render::visibility_m(haze_extinction(environment)));
}

namespace {

/// Decides effects of shading. They are off if no camera delivers colour.
class Shading {
 public:
  Shading(const Planner& planner, bool color) : planner_(planner), color_(color) {}
  void decide(Effect& effect, bool offered, const std::string& yes, const std::string& no,
              const std::string& bound = "") const {
    planner_.decide(effect, color_ && offered,
                    !color_   ? "no camera delivers colour"
                    : offered ? yes
                              : no,
                    bound);
  }

 private:
  const Planner& planner_;
  bool color_;
};

void plan_outputs(EffectPlan& plan, const Planner& planner, const CameraAsks& asks) {
  const size_t all = asks.cameras + asks.event_cameras;
  planner.decide(plan.camera, all > 0, all > 0 ? fmt::format("{} of them", all) : "no camera");
  const auto output = [&](Effect& effect, bool asked) {
    planner.decide(effect, asked, all == 0 ? "no camera" : asked ? "asked for" : "no camera delivers it");
  };
  output(plan.rgb, asks.rgb);
  output(plan.depth, asks.depth);
  output(plan.ids, asks.ids);
  output(plan.hdr, asks.hdr);
  output(plan.depth_ray, asks.depth_ray);
  output(plan.normals, asks.normals);
  output(plan.flow, asks.flow);
  output(plan.boxes, asks.boxes);
  planner.decide(plan.event_camera, asks.event_cameras > 0,
                 asks.event_cameras == 0   ? "no event camera"
                 : asks.shared_pixels == 0 ? fmt::format("{} of them", asks.event_cameras)
                                           : fmt::format("{} of them, {} with the pixels of a camera",
                                                         asks.event_cameras, asks.shared_pixels));
  planner.decide(plan.adaptive_steps, asks.adaptive_events,
                 asks.event_cameras == 0 ? "no event camera"
                 : asks.adaptive_events  ? "asked for"
                                         : "event cameras step evenly");
}

/// Throws UserError unless every lens is invertible over its whole picture and passes light everywhere. The
/// check comes before anything is built.
void check_lenses(const Scenario& scenario) {
  for (const NodeConfig& node : scenario.nodes)
    for (const SensorConfig& sensor : node.sensors) {
      const PinholeConfig* camera = pinhole_config(sensor);
      if (camera == nullptr) continue;
      const auto* of_light = std::get_if<CameraConfig>(&sensor.config);
      // Natural vignetting passes light everywhere.
      const bool vignetting =
          of_light != nullptr && of_light->vignetting.any() && !of_light->vignetting.natural;
      if (!camera->distortion.any() && !camera->wide.any() && !vignetting) continue;
      render::CameraDesc desc;
      desc.name = node.name + "/" + sensor.name;
      set_pinhole(desc, *camera);
      try {
        if (camera->wide.any())
          render::LensRays(render::lens_geometry(desc));
        else
          render::pinhole_of(desc);
        if (vignetting) render::flat_field(of_light->vignetting, render::lens_geometry(desc));
      } catch (const UserError& error) {
        throw_user_error_at(sensor.where, "{}", error.what());
      }
    }
}

/// Decides the effects of lens, exposure and sensor on a picture.
void plan_lens(EffectPlan& plan, const Planner& planner, const CameraAsks& asks) {
  const auto asked = [&](Effect& effect, bool wanted, const char* bound = "") {
    planner.decide(effect, wanted,
                   !asks.color() ? "no camera delivers colour"
                   : wanted      ? "asked for"
                                 : "no camera asks for it",
                   bound);
  };
  asked(plan.smooth_edges, asks.smooth_edges && asks.color());
  planner.decide(plan.lens_distortion, asks.distortion,
                 asks.distortion ? "asked for" : "no camera asks for it");
  planner.decide(plan.wide_lens, asks.wide_lens, asks.wide_lens ? "asked for" : "no camera asks for it",
                 "draws up to six pictures for one");
  planner.decide(plan.rolling_shutter, asks.rolling_shutter,
                 asks.rolling_shutter ? "asked for" : "no camera asks for it",
                 "draws the scene once for each band of rows");
  asked(plan.chromatic_aberration, asks.chromatic_aberration);
  asked(plan.vignetting, asks.vignetting);
  asked(plan.lens_drops, asks.drops);
  asked(plan.glare, asks.glare);
  asked(plan.motion_blur, asks.motion_blur, "costs a picture for each of its samples");
  asked(plan.auto_exposure, asks.automatic_exposure);
  asked(plan.sensor_noise, asks.noise);
}

void plan_surfaces(EffectPlan& plan, const Planner& planner, const Shading& shading, const Offers& offers,
                   const CameraAsks& asks, double ground_lux) {
  const bool camera = asks.cameras + asks.event_cameras > 0;
  shading.decide(plan.textures, offers.textures, "materials have them", "no material has one");
  shading.decide(plan.markings, offers.markings, "roads have them", "no road has one");
  // Both halves of a line are shaded in each of its pixels, which a CPU driver feels in views of a city.
  shading.decide(plan.thin_lines, false, "",
                 !offers.thin_lines   ? "the scene has no poles, lamps or furniture"
                 : !asks.smooth_edges ? "no camera smooths edges"
                                      : "costs up to a sixth of a picture; asked for by switching it on",
                 "not behind lenses that distort, nor with a rolling shutter");
  shading.decide(plan.panes, offers.panes, "materials let light through", "no material lets light through",
                 "panes near a camera are drawn and shaded once more");
  shading.decide(plan.normal_maps, offers.normal_maps && plan.textures.on, "materials have them",
                 offers.normal_maps ? "textures are off" : "no material has one");
  planner.decide(plan.alpha_mask, camera && offers.alpha_mask,
                 !camera             ? "no camera"
                 : offers.alpha_mask ? "materials have holes"
                                     : "no material has holes");
  // Emission weaker than the light that a white surface reflects is switched off, as lamps and windows are by
  // day.
  const double white = ground_lux / pi;
  shading.decide(plan.emissive, offers.emissive && offers.brightest_cd_m2 > white, "materials glow",
                 offers.emissive ? "daylight drowns what glows" : "no material glows",
                 offers.emissive ? fmt::format("up to {} cd/m^2 against {} of a white surface",
                                               digits(offers.brightest_cd_m2), digits(white))
                                 : "");
  shading.decide(plan.switched_lamps, offers.switched_lamps, "signals or lamps of vehicles switch",
                 "no lamp switches");
  // Lamps are on if they add more than 1 % to the illuminance of the ground by sun and sky.
  constexpr double tolerance = 0.01;
  const bool lamps = offers.lights > 0 && offers.lamp_illuminance_lux > tolerance * ground_lux;
  shading.decide(
      plan.punctual_lights, lamps,
      fmt::format("{} lamps, up to {:.1f} lux on the ground", offers.lights, offers.lamp_illuminance_lux),
      offers.lights == 0 ? "the scene has no lamps" : "daylight drowns them",
      offers.lights == 0 || ground_lux <= 0.0
          ? ""
          : fmt::format("at most {} lux beside the ground's {}, tolerance {:.0f} %",
                        digits(offers.lamp_illuminance_lux), digits(ground_lux), 100.0 * tolerance));
  shading.decide(plan.lamp_shadows, plan.punctual_lights.on && offers.static_triangles,
                 "lamps shine on static meshes",
                 plan.punctual_lights.on ? "nothing static to cast them" : "lamps are off",
                 "drawn once, at the first tick; those of moving meshes and lamps every tick");
  shading.decide(plan.lamp_halos, plan.punctual_lights.on && plan.haze.on, "lamps shine into fog or rain",
                 plan.punctual_lights.on ? "neither fog nor rain" : "lamps are off");
}

const char* name_of(render::HorizonKind kind) {
  switch (kind) {
    case render::HorizonKind::city:
      return "city";
    case render::HorizonKind::country:
      return "country";
    default:
      return "plain land";
  }
}

void plan_light(EffectPlan& plan, const Shading& shading, const Scenario& scenario,
                const ResolvedLight& light, const Offers& offers) {
  const double key_lux = light.below.direct_lux * std::max(0.0, light.key.direction.z);
  shading.decide(plan.sun, key_lux > 0.0,
                 fmt::format("{} lux on the ground{}", digits(key_lux),
                             light.key.body == render::KeyLight::Body::moon ? ", of the moon" : ""),
                 "neither sun nor moon shines");
  shading.decide(plan.sky, light.below.sky_lux > 0.0,
                 fmt::format("{} lux on the ground", digits(light.below.sky_lux)), "its illuminance is 0");
  shading.decide(
      plan.static_shadows, plan.sun.on && offers.static_triangles, "the sun shines on static meshes",
      plan.sun.on ? "nothing static to cast them" : "the sun is off", "drawn once, at the first tick");
  shading.decide(plan.moving_shadows, plan.sun.on && offers.moving_triangles,
                 "the sun shines on moving meshes", plan.sun.on ? "no mesh moves" : "the sun is off",
                 "drawn every tick");
  // From here on a texel of the one map, 17 cm, is larger than the pixels of what stands before a camera.
  constexpr double wide_m = 700.0;
  shading.decide(plan.shadow_cascades, plan.static_shadows.on && offers.width_m > wide_m,
                 fmt::format("the scene is {:.0f} m wide, so that one map is coarse", offers.width_m),
                 plan.static_shadows.on ? fmt::format("one map serves a scene of {:.0f} m, up to {:.0f} m",
                                                      offers.width_m, wide_m)
                                        : "static shadows are off",
                 "pages are drawn where a camera has not been");
  shading.decide(plan.ambient_occlusion, plan.sky.on && offers.static_triangles,
                 "static meshes hide parts of the sky",
                 plan.sky.on ? "nothing static hides the sky" : "the sky is off", "made once, at the start");
  shading.decide(plan.contact_occlusion, plan.sky.on && offers.moving_triangles,
                 "meshes that move hide the sky from what is near them",
                 plan.sky.on ? "no mesh moves" : "the sky is off", "boxes, placed every tick");
  shading.decide(plan.bounced_light, plan.ambient_occlusion.on, "static meshes reflect light onto others",
                 "ambient occlusion is off", "made once, at the start");
  shading.decide(plan.glass, plan.sky.on && offers.static_triangles && offers.smooth,
                 "materials are smooth enough to mirror",
                 !plan.sky.on               ? "the sky is off"
                 : !offers.static_triangles ? "nothing static to mirror"
                                            : "no material is smooth",
                 "up to 16 steps for each pixel that mirrors");
  shading.decide(plan.haze, light.haze, haze_reason(scenario.environment), "neither fog nor rain");
  shading.decide(plan.night_sky, light.night_sky,
                 fmt::format("the sun stands at {:.1f} degrees, the moon at {:.1f}",
                             degrees(light.sun_elevation), degrees(light.moon_elevation)),
                 "by day or under clouds there are no stars, and no moon is up");
  const bool overcast = light.lighting.sky_model == render::SkyModel::overcast;
  shading.decide(plan.clouds, plan.sky.on && (overcast || light.lighting.clouds > 0.0),
                 overcast ? "they cover the whole sky"
                          : fmt::format("they cover {:.0f} % of the sky", 100.0 * light.lighting.clouds),
                 plan.sky.on ? "the sky is free of them" : "the sky is off", "made once, at the start");
  const render::HorizonKind kind =
      light.lighting.horizon == render::HorizonKind::automatic ? offers.horizon : light.lighting.horizon;
  shading.decide(plan.horizon, plan.sky.on && kind != render::HorizonKind::none,
                 fmt::format("{} beyond the scene", name_of(kind)),
                 !plan.sky.on                                    ? "the sky is off"
                 : scenario.environment.horizon == Horizon::none ? "the scenario wants none"
                                                                 : "the scene is an object or a room");
  const Environment& weather = scenario.environment;
  shading.decide(plan.wet_surfaces, light.water,
                 fmt::format("wetness {:.2g}, {:.0f} % of level ground under water", wetness_of(weather),
                             100.0 * puddles_of(weather)),
                 "it is dry");
  shading.decide(plan.snow_cover, light.snow, fmt::format("{:.0f} % are covered", 100.0 * weather.snow),
                 "there is no snow");
  shading.decide(plan.rain_streaks, light.rain, fmt::format("{:.3g} mm/h of rain", weather.rain_mm_h),
                 "it does not rain");
}

}  // namespace

void plan_camera(EffectPlan& plan, const Planner& planner, const Scenario& scenario, const Offers& offers,
                 const CameraAsks& asks) {
  check_lenses(scenario);
  const ResolvedLight light = resolve(scenario.environment, plan.indoors);
  const Shading shading(planner, asks.color());
  plan_outputs(plan, planner, asks);
  plan_light(plan, shading, scenario, light, offers);
  const double ground_lux =
      (plan.sun.on ? light.below.direct_lux * std::max(0.0, light.key.direction.z) : 0.0) +
      (plan.sky.on ? light.below.sky_lux : 0.0);
  plan_surfaces(plan, planner, shading, offers, asks, ground_lux);
  plan_lens(plan, planner, asks);
}

}  // namespace greatx::sim
