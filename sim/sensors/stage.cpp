// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/stage.h"

namespace greatx::sim {

void Stage::move_to(gpu::TickSlot& slot, const TickContext& context, double time_s) {
  std::vector<Motion> motions;
  for (uint32_t node = 0; node < context.nodes.size(); ++node)
    motions.push_back(time_s == context.time_s ? context.nodes[node] : context.motion_at(node, time_s));
  const std::vector<Pose> bodies = body_poses(world_, motions);
  scene_.record_poses(slot, bodies);
  lighting_.record(slot, bodies);
}

}  // namespace greatx::sim
