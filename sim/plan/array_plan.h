// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a wave that meets an array may be taken for plane.
#pragma once

#include "rf/antenna/antenna.h"
#include "sim/plan/effect_planner.h"

namespace greatx::sim {

/// Whether the trajectories may bring the link nearer than its far field (rf::far_field_distance_m).
bool may_be_near(const Scenario& scenario, const ChannelConfig& channel, size_t transmitter, size_t receiver);

/// `every_element` of the scenario's effects.
Switch every_element_asked(const Scenario& scenario);

/// A link shorter than this, metres, is solved element by element by a run; elsewhere a plane wave passes
/// over each array. The one rule of runs, tools and Python: with `every_element: off`, candidates from rays,
/// or one element at both ends there is no such link (0), with `on` all links are (infinity), with `auto`
/// those nearer than their far field.
double every_element_within_m(const Scenario& scenario, const ChannelConfig& channel,
                              const rf::AntennaArray& transmitter, const rf::AntennaArray& receiver);

/// Decides EffectPlan::every_element: on where some link of an array may be nearer than its far field.
void plan_arrays(EffectPlan& plan, const Planner& planner, const Scenario& scenario);

}  // namespace greatx::sim
