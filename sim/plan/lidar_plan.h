// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Decides the effects of LiDARs.
#pragma once

#include "sim/plan/camera_plan.h"

namespace greatx::sim {

void plan_lidar(EffectPlan& plan, const Planner& planner, const Scenario& scenario, const scene::Scene& scene,
                const Offers& offers);

}  // namespace greatx::sim
