// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a wave that meets an array may be taken for plane.
#pragma once

#include "sim/plan/effect_planner.h"

namespace greatx::sim {

/// Whether the trajectories may bring the link nearer than its far field (rf::far_field_distance_m).
bool may_be_near(const Scenario& scenario, const ChannelConfig& channel, size_t transmitter, size_t receiver);

/// Decides EffectPlan::every_element: on where some link of an array may be nearer than its far field.
void plan_arrays(EffectPlan& plan, const Planner& planner, const Scenario& scenario);

}  // namespace greatx::sim
