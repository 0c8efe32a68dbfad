// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/stage.h"

namespace greatx::sim {

void Stage::move_to(gpu::TickSlot& slot, const TickContext& context, double time_s) {
  const std::vector<Pose> bodies = context.body_poses_at(time_s);
  scene_.record_poses(slot, bodies);
  lighting_.record(slot, bodies);
}

}  // namespace greatx::sim
