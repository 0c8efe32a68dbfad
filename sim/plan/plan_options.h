// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts the effect plan to the options of the scene on the GPU, of cameras and of radio.
#pragma once

#include "renderer/light/lighting.h"
#include "rf/paths/radio_model.h"
#include "scene/device/gpu_scene.h"
#include "sim/plan/effect_plan.h"

namespace greatx::sim {

scene::GpuSceneOptions gpu_scene_options(const EffectPlan& plan);
render::CameraEffects camera_effects(const EffectPlan& plan);
/// Returns the switches alone. radio_effects() in sim/channel/channel_paths.h adds the values that belong to
/// them.
rf::RadioEffects radio_switches(const EffectPlan& plan);
render::Lighting lighting_of(const Environment& environment, const EffectPlan& plan);

}  // namespace greatx::sim
