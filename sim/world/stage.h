// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts the bodies that cameras see where they are at any instant: sub-steps of event cameras, instants within
// an exposure.
#pragma once

#include "renderer/light/lighting.h"
#include "scene/device/gpu_scene.h"
#include "sim/world/tick_context.h"
#include "sim/world/world.h"

namespace greatx::sim {

class Stage {
 public:
  /// All arguments outlive this.
  Stage(scene::GpuScene& scene, render::SceneLighting& lighting, const World& world)
      : scene_(scene), lighting_(lighting), world_(world) {}

  /// Moves every body and its shadows to `time_s`, for the raster passes that are recorded next. The caller
  /// moves them back to context.time_s before it leaves its record().
  void move_to(gpu::TickSlot& slot, const TickContext& context, double time_s);
  const render::SceneLighting& lighting() const { return lighting_; }
  const World& world() const { return world_; }

 private:
  scene::GpuScene& scene_;
  render::SceneLighting& lighting_;
  const World& world_;
};

}  // namespace greatx::sim
