// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/experiment/experiment.h"

#include <utility>

#include "core/error.h"

namespace greatx::sim {

Experiment make_experiment(Scenario scenario) {
  auto world = std::make_shared<const World>(load_world(scenario));
  return make_experiment(std::move(scenario), std::move(world));
}

Experiment make_experiment(Scenario scenario, const Experiment& before) {
  if (!same_world(scenario, before.scenario)) return make_experiment(std::move(scenario));
  check_world(scenario, *before.world);
  return make_experiment(std::move(scenario), before.world);
}

Experiment make_experiment(Scenario scenario, std::shared_ptr<const World> world,
                           const scene::Bounds& points) {
  GREATX_CHECK(world != nullptr, "{}: an experiment without a world", scenario.name);
  EffectPlan plan = make_effect_plan(scenario, world->scene, points);
  return {std::move(scenario), std::move(world), std::move(plan)};
}

}  // namespace greatx::sim
