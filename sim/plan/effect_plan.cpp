// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/effect_plan.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/units.h"
#include "sim/plan/camera_plan.h"
#include "sim/plan/effect_planner.h"
#include "sim/plan/light_plan.h"

namespace greatx::sim {

namespace {

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
          &depth_ray,
          &normals,
          &flow,
          &boxes,
          &event_camera,
          &adaptive_steps,
          &sun,
          &sky,
          &static_shadows,
          &moving_shadows,
          &ambient_occlusion,
          &textures,
          &normal_maps,
          &alpha_mask,
          &emissive,
          &punctual_lights,
          &haze,
          &night_sky,
          &smooth_edges,
          &lens_distortion,
          &vignetting,
          &motion_blur,
          &auto_exposure,
          &sensor_noise,
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
