// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/plan_options.h"

#include "sim/plan/light_plan.h"

namespace greatx::sim {

scene::GpuSceneOptions gpu_scene_options(const EffectPlan& plan) {
  return {plan.acceleration_structure.on,
          plan.textures.on || plan.alpha_mask.on || plan.lidar_alpha_mask.on || plan.lidar_textures.on};
}

namespace {

struct Passed {
  render::CameraEffects camera;
  rf::RadioEffects radio;
};

// Each row of the table of effects sets the member of the same name in the struct that the row names.
#define GREATX_PASS_none(name)
#define GREATX_PASS_camera(name) passed.camera.name = plan.name.on;
#define GREATX_PASS_radio(name) passed.radio.name = plan.name.on;
#define GREATX_PASS_field(name) passed.radio.field.name = plan.name.on;
#define GREATX_PASS(name, switchable, to, documentation) GREATX_PASS_##to(name)

Passed passed_by(const EffectPlan& plan) {
  Passed passed;
  // scattering takes power from reflections
  GREATX_EFFECTS(GREATX_PASS)
  passed.radio.field.scattering = plan.scattering.on;
  return passed;
}

#undef GREATX_PASS
#undef GREATX_PASS_field
#undef GREATX_PASS_radio
#undef GREATX_PASS_camera
#undef GREATX_PASS_none

}  // namespace

render::CameraEffects camera_effects(const EffectPlan& plan) { return passed_by(plan).camera; }

rf::RadioEffects radio_switches(const EffectPlan& plan) { return passed_by(plan).radio; }

render::Lighting lighting_of(const Environment& environment, const EffectPlan& plan) {
  return resolve(environment, plan.indoors).lighting;
}

}  // namespace greatx::sim
