// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From the plan to what scene and renderer are told to build.
#pragma once

#include "renderer/light/lighting.h"
#include "scene/device/gpu_scene.h"
#include "sim/plan/effect_plan.h"

namespace greatx::sim {

scene::GpuSceneOptions gpu_scene_options(const EffectPlan& plan);
render::CameraEffects camera_effects(const EffectPlan& plan);
render::Lighting lighting_of(const Environment& environment);

}  // namespace greatx::sim
