// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/description/scene.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Adds to `bounds` a box, world coordinates, that the trajectory never leaves up to the last tick of the
/// run, whatever is drawn. If the run is longer than the curves (Scenario::trajectory_ticks), the box
/// includes their straight continuation.
void add_trajectory(const Scenario& scenario, const Trajectory& trajectory, scene::Bounds& bounds);

}  // namespace greatx::sim
