// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From the plan to the options of the scene on the GPU, of cameras and of radio.
#pragma once

#include "renderer/light/lighting.h"
#include "rf/paths/radio_model.h"
#include "scene/device/gpu_scene.h"
#include "sim/plan/effect_plan.h"

namespace greatx::sim {

scene::GpuSceneOptions gpu_scene_options(const EffectPlan& plan);
render::CameraEffects camera_effects(const EffectPlan& plan);
/// The switches alone; sim/channel/channel_paths.h has the values that go with them.
rf::RadioEffects radio_switches(const EffectPlan& plan);
render::Lighting lighting_of(const Environment& environment);

}  // namespace greatx::sim
