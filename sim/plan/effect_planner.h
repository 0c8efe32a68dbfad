// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Combines the two inputs of every decision: whether an effect is needed, and how the scenario switches it.
#pragma once

#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/plan/effect_plan.h"

namespace greatx::sim {

/// Applies the scenario's switches on top of the automatic decision.
class Planner {
 public:
  explicit Planner(const Scenario& scenario) : scenario_(scenario) {}

  /// Decides an effect. `needed` says whether the scenario and the scene call for it. Throws UserError if the
  /// scenario switches an effect that cannot be switched.
  void decide(Effect& effect, bool needed, const std::string& reason, const std::string& bound = "") const {
    const auto it = scenario_.effects.find(effect.name);
    const Switch wish = it == scenario_.effects.end() ? Switch::automatic : it->second;
    if (!effect.switchable && wish != Switch::automatic)
      throw_user_error("{}: effects.{}: cannot be switched: it is {} because {}; expected auto",
                       scenario_.file.empty() ? scenario_.name : scenario_.file.string(), effect.name,
                       needed ? "on" : "off", reason);
    effect.on = wish == Switch::automatic ? needed : wish == Switch::on;
    effect.reason = effect.on == needed ? reason
                    : effect.on         ? fmt::format("switched on ({})", reason)
                                        : fmt::format("switched off ({})", reason);
    effect.bound = bound;
  }

 private:
  const Scenario& scenario_;
};

/// Decides the effects of radio (sim/plan/radio_plan.cpp). make_effect_plan() describes `points`.
void plan_radio(EffectPlan& plan, const Planner& planner, const Scenario& scenario, const scene::Scene& scene,
                const scene::Bounds& points);

}  // namespace greatx::sim
