// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/effect_plan.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/built_effects.h"
#include "core/text.h"
#include "core/units.h"
#include "sim/plan/camera_plan.h"
#include "sim/plan/effect_planner.h"
#include "sim/plan/lidar_plan.h"
#include "sim/plan/radar_plan.h"

namespace greatx::sim {

namespace {

void plan_rays(EffectPlan& plan, Planner& planner, const Offers& offers) {
  const bool rays = plan.lidar.on || plan.radar.on || plan.channel.on || plan.consistency.on;
  planner.decide(plan.acceleration_structure, rays,
                 rays ? "LiDAR, radar, radio or the consistency check trace rays" : "nothing traces rays");
  planner.decide(plan.scene_motion, offers.moving_triangles,
                 offers.moving_triangles ? "a mesh follows a moving node: posed at every tick"
                                         : "no mesh moves: built once");
}

/// Throws UserError if the plan has effects of radio that this program was built without.
void require_built(const EffectPlan& plan, const Scenario& scenario) {
#define GREATX_POINTER(name, switchable, passed, documentation) &plan.name,
  const std::vector<const Effect*> radio{GREATX_RADIO_EFFECTS(GREATX_POINTER)};
#undef GREATX_POINTER
  std::vector<std::string> names;
  for (const Effect* effect : radio)
    if (effect->on && effect != &plan.channel && effect != &plan.line_of_sight) names.push_back(effect->name);
  if (names.empty()) return;
  throw_user_error(
      "{}: effects: found {} on, but this program was built with GREATX_EFFECTS=line_of_sight and has no "
      "other "
      "effect of a channel; expected them to be off (effects: {{{}: off}}), or a program built with "
      "GREATX_EFFECTS=all",
      scenario.file.empty() ? scenario.name : scenario.file.string(), fmt::join(names, ", "),
      fmt::join(names, ": off, "));
}

}  // namespace

std::vector<const Effect*> EffectPlan::all() const {
#define GREATX_POINTER(name, switchable, passed, documentation) &name,
  return {GREATX_EFFECTS(GREATX_POINTER)};
#undef GREATX_POINTER
}

bool same_effects(const EffectPlan& a, const EffectPlan& b) {
  const std::vector<const Effect*> of_a = a.all(), of_b = b.all();
  return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                    [](const Effect* x, const Effect* y) { return x->on == y->on; });
}

EffectPlan make_effect_plan(const Scenario& scenario, const scene::Scene& scene,
                            const scene::Bounds& points) {
  const Offers offers = offers_of(scene);
  const CameraAsks asks = camera_asks_of(scenario);
  Planner planner(scenario);
  EffectPlan plan;
  if (asks.color()) plan.indoors = indoors_of(scenario, scene);
  plan_camera(plan, planner, scenario, offers, asks);
  plan_lidar(plan, planner, scenario, scene, offers);
  plan_radar(plan, planner, scenario, scene);
  plan_radio(plan, planner, scenario, scene, points);
  const bool pictures = asks.cameras > 0 && asks.depth && offers.triangles,
             targets = plan.sensing.on && plan.target_echoes.on;
  planner.decide(plan.consistency, pictures || targets,
                 pictures  ? "depth pixels are checked against rays"
                 : targets ? "detections of targets are checked against their boxes"
                           : "no depth picture of a surface to check",
                 "256 rays per camera and tick");
  plan_rays(plan, planner, offers);

  for (const auto& [name, wish] : scenario.effects) {
    const std::vector<const Effect*> effects = plan.all();
    if (std::any_of(effects.begin(), effects.end(),
                    [&](const Effect* effect) { return effect->name == name; }))
      continue;
    std::vector<std::string> names;
    for (const Effect* effect : effects)
      if (effect->switchable) names.push_back(effect->name);
    throw_user_error("{}: effects: '{}' is no effect{}; expected one of {}",
                     scenario.file.empty() ? scenario.name : scenario.file.string(), name,
                     suggestion(name, names), fmt::join(names, ", "));
  }
  if constexpr (!all_effects_built) require_built(plan, scenario);
  return plan;
}

}  // namespace greatx::sim
