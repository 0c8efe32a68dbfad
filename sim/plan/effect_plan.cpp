// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/effect_plan.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/units.h"
#include "sim/plan/effect_planner.h"
#include "sim/plan/light_plan.h"

namespace greatx::sim {

namespace {

/// What the scene has that some effect needs.
struct Offers {
  bool triangles = false, static_triangles = false, moving_triangles = false;
  bool textures = false, normal_maps = false, reflectance_textures = false, alpha_mask = false,
       emissive = false;
  size_t lights = 0;
  double lamp_illuminance_lux = 0.0;  ///< the most that a lamp throws on the ground, see lamp_illuminance
};

/// What the scenario asks for.
struct Asks {
  size_t cameras = 0, lidars = 0;
  bool events = false;  ///< of brightness
  bool rgb = false, depth = false, ids = false, hdr = false;
  bool sweep = false;
};

/// Illuminance that a lamp throws on the ground below it, lux: E = I / h^2, with h its height but at least 1 m (a lamp
/// nearer to a surface than that lights a spot of its own size only).
double lamp_illuminance(const scene::PunctualLight& light, double ground) {
  if (light.type == scene::PunctualLight::Type::directional) return light.intensity;
  const double height = std::max(1.0, light.position.z - ground);
  return static_cast<double>(light.intensity) / (height * height);
}

Offers offers_of(const scene::Scene& scene) {
  Offers offers;
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
    offers.normal_maps |= pbr.normal_texture >= 0;
    offers.alpha_mask |= pbr.alpha_mode == scene::AlphaMode::mask;
    offers.emissive |= pbr.emissive != vec3(0.0f);
  }
  offers.lights = scene.lights.size();
  const double ground = scene.bounds.empty() ? 0.0 : scene.bounds.min.z;
  for (const scene::PunctualLight& light : scene.lights)
    offers.lamp_illuminance_lux = std::max(offers.lamp_illuminance_lux, lamp_illuminance(light, ground));
  return offers;
}

Asks asks_of(const Scenario& scenario) {
  Asks asks;
  for (const NodeConfig& node : scenario.nodes) {
    for (const SensorConfig& sensor : node.sensors) {
      if (const auto* camera = std::get_if<CameraConfig>(&sensor.config)) {
        ++asks.cameras;
        asks.rgb |= camera->rgb;
        asks.depth |= camera->depth;
        asks.ids |= camera->ids;
        asks.hdr |= camera->hdr;
      } else if (std::holds_alternative<EventCameraConfig>(sensor.config)) {
        ++asks.cameras;
        asks.events = true;
      } else if (const auto* lidar = std::get_if<LidarConfig>(&sensor.config)) {
        ++asks.lidars;
        asks.sweep |= lidar->sweep_s > 0.0;
      }
    }
  }
  return asks;
}

std::string haze_reason(const Environment& environment) {
  return fmt::format("fog and rain leave {:.0f} m of visibility",
                     render::visibility_m(haze_extinction(environment)));
}

void plan_rays(EffectPlan& plan, Planner& planner, const Offers& offers) {
  const bool rays = plan.lidar.on || plan.channel.on || plan.consistency.on;
  plan.acceleration_structure =
      planner.fixed("acceleration_structure", rays,
                    rays ? "LiDAR, radio or the consistency check trace rays" : "nothing traces rays");
  plan.scene_motion =
      planner.fixed("scene_motion", offers.moving_triangles,
                    offers.moving_triangles ? "a mesh follows a moving node: refitted when it moved"
                                            : "no mesh moves: built once, never refitted");
}

void plan_camera(EffectPlan& plan, Planner& planner, const Scenario& scenario, const Offers& offers,
                 const Asks& asks) {
  const ResolvedLight light = resolve(scenario.environment);
  const bool camera = asks.cameras > 0;
  const std::string none = "no camera";
  const auto if_camera = [&](const std::string& reason) { return camera ? reason : none; };
  plan.camera = planner.fixed("camera", camera, camera ? fmt::format("{} of them", asks.cameras) : none);
  plan.rgb = planner.fixed("rgb", asks.rgb, if_camera(asks.rgb ? "asked for" : "no camera delivers it"));
  plan.depth =
      planner.fixed("depth", asks.depth, if_camera(asks.depth ? "asked for" : "no camera delivers it"));
  plan.ids = planner.fixed("ids", asks.ids, if_camera(asks.ids ? "asked for" : "no camera delivers it"));
  plan.hdr = planner.fixed("hdr", asks.hdr, if_camera(asks.hdr ? "asked for" : "no camera delivers it"));

  // Everything below shades pixels: without colour there is none of it.
  const bool color = asks.rgb || asks.hdr || asks.events;
  const auto shading = [&](bool offered, const std::string& yes, const std::string& no) {
    return std::pair(color && offered, !color    ? std::string("no camera delivers colour")
                                       : offered ? yes
                                                 : no);
  };
  const double sun_lux = light.below.direct_lux * std::max(0.0, light.key.direction.z);
  const auto [sun, sun_why] =
      shading(sun_lux > 0.0, fmt::format("{:.0f} lux on the ground", sun_lux), "neither sun nor moon shines");
  plan.sun = planner.decide("sun", sun, sun_why);
  const auto [sky_on, sky_why] =
      shading(light.below.sky_lux > 0.0, fmt::format("{:.0f} lux on the ground", light.below.sky_lux),
              "its illuminance is 0");
  plan.sky = planner.decide("sky", sky_on, sky_why);
  const auto [still, still_why] =
      shading(plan.sun.on && offers.static_triangles, "the sun shines on static meshes",
              plan.sun.on ? "nothing static to cast them" : "the sun is off");
  plan.static_shadows = planner.decide("static_shadows", still, still_why, "drawn once, at the first tick");
  const auto [moving, moving_why] =
      shading(plan.sun.on && offers.moving_triangles, "the sun shines on moving meshes",
              plan.sun.on ? "no mesh moves" : "the sun is off");
  plan.moving_shadows = planner.decide("moving_shadows", moving, moving_why, "drawn every tick");
  const auto [textures, textures_why] =
      shading(offers.textures, "materials have them", "no material has one");
  plan.textures = planner.decide("textures", textures, textures_why);
  const auto [normals, normals_why] =
      shading(offers.normal_maps && plan.textures.on, "materials have them",
              offers.normal_maps ? "textures are off" : "no material has one");
  plan.normal_maps = planner.decide("normal_maps", normals, normals_why);
  plan.alpha_mask =
      planner.decide("alpha_mask", camera && offers.alpha_mask,
                     if_camera(offers.alpha_mask ? "materials have holes" : "no material has holes"));
  const auto [emissive, emissive_why] = shading(offers.emissive, "materials glow", "no material glows");
  plan.emissive = planner.decide("emissive", emissive, emissive_why);

  // Lamps matter once they add more than 1 % to what the sun and the sky give the ground.
  constexpr double lamp_tolerance = 0.01;
  const double ambient = (plan.sun.on ? sun_lux : 0.0) + (plan.sky.on ? light.below.sky_lux : 0.0);
  const bool lamps_matter = offers.lights > 0 && offers.lamp_illuminance_lux > lamp_tolerance * ambient;
  const auto [lamps, lamps_why] = shading(
      lamps_matter,
      fmt::format("{} lamps, up to {:.1f} lux on the ground", offers.lights, offers.lamp_illuminance_lux),
      offers.lights == 0 ? "the scene has no lamps" : "daylight drowns them");
  plan.punctual_lights = planner.decide(
      "punctual_lights", lamps, lamps_why,
      offers.lights == 0 || ambient <= 0.0
          ? ""
          : fmt::format("at most {:.2f} % of the ground's {:.0f} lux, tolerance {:.0f} %",
                        100.0 * offers.lamp_illuminance_lux / ambient, ambient, 100.0 * lamp_tolerance));

  const auto [haze, haze_why] =
      shading(light.haze, haze_reason(scenario.environment), "neither fog nor rain");
  plan.haze = planner.decide("haze", haze, haze_why);
  const auto [night, night_why] =
      shading(light.night_sky,
              fmt::format("the sun stands at {:.1f} degrees, the moon at {:.1f}",
                          degrees(light.sun_elevation), degrees(light.moon_elevation)),
              "by day or under clouds there are no stars, and no moon is up");
  plan.night_sky = planner.decide("night_sky", night, night_why);
}

void plan_lidar(EffectPlan& plan, Planner& planner, const Environment& environment, const Offers& offers,
                const Asks& asks) {
  const bool lidar = asks.lidars > 0;
  plan.lidar = planner.fixed("lidar", lidar, lidar ? fmt::format("{} of them", asks.lidars) : "no LiDAR");
  plan.lidar_alpha_mask = planner.decide("lidar_alpha_mask", lidar && offers.alpha_mask,
                                         !lidar              ? "no LiDAR"
                                         : offers.alpha_mask ? "materials have holes"
                                                             : "no material has holes");
  plan.lidar_textures =
      planner.decide("lidar_textures", lidar && offers.reflectance_textures,
                     !lidar ? "no LiDAR"
                     : offers.reflectance_textures
                         ? "textures shade reflectances that come from the base colour"
                         : "every textured material states its reflectance, or none has a texture");
  plan.lidar_sweep_motion =
      planner.decide("lidar_sweep_motion", asks.sweep,
                     !lidar       ? "no LiDAR"
                     : asks.sweep ? "shots are spread over sweep_s: each from the pose at its own time"
                                  : "sweep_s is 0: every shot at the tick");
  const bool haze = haze_extinction(environment) > 0.0;
  plan.lidar_haze = planner.decide("lidar_haze", lidar && haze,
                                   !lidar ? "no LiDAR"
                                   : haze ? haze_reason(environment)
                                          : "neither fog nor rain");
}

}  // namespace

std::vector<Effect*> EffectPlan::all() {
  return {&acceleration_structure,
          &scene_motion,
          &camera,
          &rgb,
          &depth,
          &ids,
          &hdr,
          &sun,
          &sky,
          &static_shadows,
          &moving_shadows,
          &textures,
          &normal_maps,
          &alpha_mask,
          &emissive,
          &punctual_lights,
          &haze,
          &night_sky,
          &lidar,
          &lidar_alpha_mask,
          &lidar_textures,
          &lidar_sweep_motion,
          &lidar_haze,
          &channel,
          &line_of_sight,
          &reflection,
          &moving_reflectors,
          &transmission,
          &diffraction,
          &diffraction_lit_region,
          &free_edges,
          &scattering,
          &roughness,
          &gas,
          &rain,
          &fog,
          &foliage,
          &dispersion,
          &doppler,
          &every_element,
          &consistency};
}

std::vector<const Effect*> EffectPlan::all() const {
  const std::vector<Effect*> effects = const_cast<EffectPlan*>(this)->all();
  return {effects.begin(), effects.end()};
}

EffectPlan make_effect_plan(const Scenario& scenario, const scene::Scene& scene) {
  const Offers offers = offers_of(scene);
  const Asks asks = asks_of(scenario);
  Planner planner(scenario);
  EffectPlan plan;
  plan_camera(plan, planner, scenario, offers, asks);
  plan_lidar(plan, planner, scenario.environment, offers, asks);
  plan_radio(plan, planner, scenario, scene);
  const bool check = asks.cameras > 0 && asks.depth && offers.triangles;
  plan.consistency = planner.decide(
      "consistency", check,
      check ? "depth pixels are checked against rays" : "no depth picture of a surface to check",
      "256 rays per camera and tick");
  plan_rays(plan, planner, offers);

  for (const auto& [name, wish] : scenario.effects) {
    const std::vector<const Effect*> effects = std::as_const(plan).all();
    if (std::any_of(effects.begin(), effects.end(),
                    [&](const Effect* effect) { return effect->name == name; }))
      continue;
    std::vector<std::string> names;
    for (const Effect* effect : effects)
      if (effect->switchable) names.push_back(effect->name);
    throw_user_error("{}: effects: '{}' is no effect; expected one of {}",
                     scenario.file.empty() ? scenario.name : scenario.file.string(), name,
                     fmt::join(names, ", "));
  }
  return plan;
}

}  // namespace greatx::sim
