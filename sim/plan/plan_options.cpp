// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/plan_options.h"

#include "sim/plan/light_plan.h"

namespace greatx::sim {

scene::GpuSceneOptions gpu_scene_options(const EffectPlan& plan) {
  return {plan.acceleration_structure.on,
          plan.textures.on || plan.alpha_mask.on || plan.lidar_alpha_mask.on || plan.lidar_textures.on};
}

render::CameraEffects camera_effects(const EffectPlan& plan) {
  render::CameraEffects effects;
  effects.sun = plan.sun.on;
  effects.sky = plan.sky.on;
  effects.static_shadows = plan.static_shadows.on;
  effects.moving_shadows = plan.moving_shadows.on;
  effects.textures = plan.textures.on;
  effects.normal_maps = plan.normal_maps.on;
  effects.alpha_mask = plan.alpha_mask.on;
  effects.emissive = plan.emissive.on;
  effects.ambient_occlusion = plan.ambient_occlusion.on;
  effects.punctual_lights = plan.punctual_lights.on;
  effects.haze = plan.haze.on;
  effects.night_sky = plan.night_sky.on;
  return effects;
}

render::Lighting lighting_of(const Environment& environment) { return resolve(environment).lighting; }

}  // namespace greatx::sim
