// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/moment.h"

#include <limits>

namespace greatx::sim {

Moment moment_at(const World& world, const std::vector<std::unique_ptr<Path>>& paths, const Clock& clock,
                 int64_t tick, int64_t previous) {
  Moment moment;
  const double time_s = clock.seconds(tick);
  for (const auto& path : paths) moment.motions.push_back(path->at(time_s));
  moment.bodies = body_poses(world, moment.motions);
  moment.context.tick = tick;
  moment.context.time_s = time_s;
  moment.context.previous_time_s =
      previous < 0 ? std::numeric_limits<double>::quiet_NaN() : clock.seconds(previous);
  moment.context.nodes = moment.motions;
  moment.context.body_poses = moment.bodies;
  moment.context.motion_at = [&paths](uint32_t node, double time) { return paths[node]->at(time); };
  moment.context.body_motion_at = [&world, &paths](uint32_t body, double time) {
    return body == 0 ? Motion{} : body_motion(world, body, paths[world.node_of_body[body]]->at(time));
  };
  return moment;
}

}  // namespace greatx::sim
