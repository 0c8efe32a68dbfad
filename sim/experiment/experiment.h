// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines everything that a run needs and that exists without a device: the scenario, the world loaded for
// it, and the effect plan that follows from both. It is made once and passed on as a whole.
#pragma once

#include <memory>

#include "sim/plan/effect_plan.h"
#include "sim/scenario/scenario.h"
#include "sim/world/world.h"

namespace greatx::sim {

/// Holds a scenario with its world and plan. It is not changed after it is made, and outlives everything that
/// is built on it.
struct Experiment {
  Scenario scenario;
  std::shared_ptr<const World> world;  ///< never null; experiments may share a world
  EffectPlan plan;

  const scene::Scene& scene() const { return world->scene; }
};

/// Loads the world and makes the plan. Throws UserError like load_world() and make_effect_plan().
Experiment make_experiment(Scenario scenario);

/// Does the same for a scenario that was changed after `before` was made. It takes the world of `before` if
/// it is the same one; files are not read again then.
Experiment make_experiment(Scenario scenario, const Experiment& before);

/// Does the same with a world that is already loaded and fits the scenario. make_effect_plan() describes
/// `points`.
Experiment make_experiment(Scenario scenario, std::shared_ptr<const World> world,
                           const scene::Bounds& points = {});

}  // namespace greatx::sim
