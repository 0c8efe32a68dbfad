// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/plan/effect_planner.h"

namespace greatx::sim {

/// Decides the effects of radars.
void plan_radar(EffectPlan& plan, const Planner& planner, const Scenario& scenario,
                const scene::Scene& scene);

}  // namespace greatx::sim
