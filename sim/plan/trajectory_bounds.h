// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/description/scene.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Adds a box, world coordinates, that the trajectory never leaves, whatever is drawn, up to the run's last
/// tick: a run longer than the curves (Scenario::trajectory_ticks) sees them go straight on.
void add_trajectory(const Scenario& scenario, const Trajectory& trajectory, scene::Bounds& bounds);

}  // namespace greatx::sim
