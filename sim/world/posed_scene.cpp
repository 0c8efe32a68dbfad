// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/posed_scene.h"

namespace greatx::sim {

void set_lamps(scene::GpuScene& scene, const TickContext& context, double time_s) {
  if (context.lamps_at) scene.set_lamps(context.lamps_at(time_s));
}

void Instants::move_to(double time_s) {
  const bool of_tick = time_s == context_.time_s;
  if (of_tick && !moved_) return;  // the scene already has the poses of the tick
  const std::vector<Pose> bodies = context_.body_poses_at(time_s);
  set_lamps(scene_, context_, time_s);
  scene_.record_poses(slot_, bodies);
  lighting_.record(slot_, bodies);
  moved_ = true;
  away_ = !of_tick;
}

void PosedScene::at_instants(gpu::TickSlot& slot, const TickContext& context,
                             const std::function<void(Instants&)>& record) {
  Instants instants(scene_, lighting_, slot, context);
  record(instants);
  if (instants.away_) instants.move_to(context.time_s);
}

std::vector<Pose> TracedInstants::move_to(double time_s) {
  std::vector<Pose> bodies = context_.body_poses_at(time_s);
  const bool of_tick = time_s == context_.time_s;
  if (!of_tick || away_) scene_.record_update(slot_, bodies);
  away_ = !of_tick;
  return bodies;
}

void at_traced_instants(scene::GpuScene& scene, gpu::TickSlot& slot, const TickContext& context,
                        const std::function<void(TracedInstants&)>& record) {
  TracedInstants instants(scene, slot, context);
  record(instants);
  if (instants.away_) instants.move_to(context.time_s);
}

}  // namespace greatx::sim
