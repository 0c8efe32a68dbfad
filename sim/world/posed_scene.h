// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Poses the scene for any instant of a tick: sub-steps of event cameras, instants within an exposure, frames
// of a radar that are traced several times. Whoever asks for other instants finds everything back at the tick
// afterwards.
#pragma once

#include <functional>
#include <vector>

#include "renderer/light/lighting.h"
#include "scene/device/gpu_scene.h"
#include "sim/world/tick_context.h"
#include "sim/world/world.h"

namespace greatx::sim {

/// Switches the scene's lamps as at `time_s` for the next update.
void set_lamps(scene::GpuScene& scene, const TickContext& context, double time_s);

/// Moves the scene to the instants that one sensor asks for within its record(). Only PosedScene creates this
/// object, and restores the poses afterwards.
class Instants {
 public:
  /// Poses every body, with its shadows, as at `time_s` for the raster passes recorded next. If the last call
  /// of a sensor is for the tick itself, it must not be within a gpu::Condition.
  void move_to(double time_s);

 private:
  friend class PosedScene;
  Instants(scene::GpuScene& scene, render::SceneLighting& lighting, gpu::TickSlot& slot,
           const TickContext& context)
      : scene_(scene), lighting_(lighting), slot_(slot), context_(context) {}

  scene::GpuScene& scene_;
  render::SceneLighting& lighting_;
  gpu::TickSlot& slot_;
  const TickContext& context_;
  bool moved_ = false;  ///< moved at least once
  bool away_ = false;   ///< the poses recorded last are not those of the tick
};

/// Poses the scene and its shadows, and restores the poses of the tick.
class PosedScene {
 public:
  /// All arguments outlive this.
  PosedScene(scene::GpuScene& scene, render::SceneLighting& lighting, const World& world)
      : scene_(scene), lighting_(lighting), world_(world) {}

  /// Calls `record`, which may move everything to any number of instants. Afterwards everything stands as in
  /// `context` again.
  void at_instants(gpu::TickSlot& slot, const TickContext& context,
                   const std::function<void(Instants&)>& record);
  const render::SceneLighting& lighting() const { return lighting_; }
  const World& world() const { return world_; }

 private:
  scene::GpuScene& scene_;
  render::SceneLighting& lighting_;
  const World& world_;
};

/// The instants that one sensor traces at within its record(): only at_traced_instants() makes them, and it
/// undoes them.
class TracedInstants {
 public:
  /// Poses every body for the rays recorded next. Returns the poses, in local coordinates.
  std::vector<Pose> move_to(double time_s);

 private:
  friend void at_traced_instants(scene::GpuScene& scene, gpu::TickSlot& slot, const TickContext& context,
                                 const std::function<void(TracedInstants&)>& record);
  TracedInstants(scene::GpuScene& scene, gpu::TickSlot& slot, const TickContext& context)
      : scene_(scene), slot_(slot), context_(context) {}

  scene::GpuScene& scene_;
  gpu::TickSlot& slot_;
  const TickContext& context_;
  bool away_ = false;  ///< the poses recorded last are not those of the tick
};

/// Lets `record` trace rays at as many instants as it likes. Afterwards the acceleration structure stands as
/// `context` has it again.
void at_traced_instants(scene::GpuScene& scene, gpu::TickSlot& slot, const TickContext& context,
                        const std::function<void(TracedInstants&)>& record);

}  // namespace greatx::sim
