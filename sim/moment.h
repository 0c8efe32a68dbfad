// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "sim/scenario/clock.h"
#include "sim/scenario/trajectory.h"
#include "sim/sensors/sensor.h"
#include "sim/world.h"

namespace greatx::sim {

/// Where everything is at a tick; owns what the context points at, also when it is moved.
struct Moment {
  Moment() = default;
  Moment(Moment&&) = default;
  Moment& operator=(Moment&&) = default;

  std::vector<Motion> motions;  ///< [nodes]
  std::vector<Pose> bodies;     ///< [bodies] local coordinates
  TickContext context;
};

/// The moment of `tick` when the nodes move along `paths`; world and paths outlive it. `previous`: the tick before at which
/// something was due; -1: none.
Moment moment_at(const World& world, const std::vector<std::unique_ptr<Path>>& paths, const Clock& clock,
                 int64_t tick, int64_t previous = -1);

}  // namespace greatx::sim
