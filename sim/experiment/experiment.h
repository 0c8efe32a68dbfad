// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Everything that a run is made of, before there is a device: the scenario, the world that it loads and the
// plan that both call for. It is made once and handed on whole.
#pragma once

#include <memory>

#include "sim/plan/effect_plan.h"
#include "sim/scenario/scenario.h"
#include "sim/world/world.h"

namespace greatx::sim {

/// Nobody changes it once it is made, and it outlives all that is built on it.
struct Experiment {
  Scenario scenario;
  std::shared_ptr<const World> world;  ///< never null; experiments that differ in the rest share it
  EffectPlan plan;

  const scene::Scene& scene() const { return world->scene; }
};

/// Loads the world. Throws UserError like load_world() and make_effect_plan().
Experiment make_experiment(Scenario scenario);

/// The same in a world that is loaded already and fits the scenario. `points` is make_effect_plan()'s.
Experiment make_experiment(Scenario scenario, std::shared_ptr<const World> world,
                           const scene::Bounds& points = {});

}  // namespace greatx::sim
