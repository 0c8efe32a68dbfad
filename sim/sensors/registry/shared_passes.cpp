// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/registry/shared_passes.h"

#include "rf/paths/radio_model.h"
#include "sim/channel/channel_paths.h"
#include "sim/plan/plan_options.h"

namespace greatx::sim {

SharedPasses::SharedPasses(scene::GpuScene& gpu_scene, const Experiment& experiment) {
  const EffectPlan& plan = experiment.plan;
  if (plan.camera.on)
    lighting = std::make_unique<render::SceneLighting>(
        gpu_scene, lighting_of(experiment.scenario.environment, plan), camera_effects(plan));
  if (lighting) posed = std::make_unique<PosedScene>(gpu_scene, *lighting, *experiment.world);
  if (plan.consistency.on) probe = std::make_unique<render::ProbePass>(gpu_scene);
  if (plan.channel.on)
    crossings = std::make_unique<rf::CrossingPass>(
        gpu_scene, rf::facet_kinds(experiment.scene(), radio_effects(experiment)));
}

}  // namespace greatx::sim
