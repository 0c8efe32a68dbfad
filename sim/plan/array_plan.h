// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Decides whether a wave that arrives at an array may be taken as plane.
#pragma once

#include "rf/antenna/antenna.h"
#include "sim/plan/effect_planner.h"

namespace greatx::sim {

/// Returns whether the trajectories may bring the ends of the link nearer to each other than the far-field
/// distance of their arrays (rf::far_field_distance_m).
bool may_be_near(const Scenario& scenario, const ChannelConfig& channel, size_t transmitter, size_t receiver);

/// Returns the largest distance of a frequency of a channel from its carrier, Hz.
double half_band_hz(const ChannelConfig& channel);

/// Return bounds of the phases, rad, by which a plane wave at the carrier's wavelength is wrong at the
/// edges of two arrays: off the carrier by `half_band_hz`, and for ends `distance_m` apart. `reach_m` is
/// the sum of the largest distances of an element from the origin of its array.
double squint_phase_rad(double reach_m, double half_band_hz);
double curvature_phase_rad(double reach_m, double distance_m, double carrier_hz);
/// Returns whether such a phase changes a path by more than `tolerance_db`.
bool phase_matters(double phase_rad, double tolerance_db);

/// Returns the switch `every_element` of the scenario.
Switch every_element_asked(const Scenario& scenario);

/// Returns the distance, metres, below which a link is solved for every pair of elements. At longer distances
/// one path stands for all elements. The distance is 0 (no link) with `every_element: off`, with
/// candidates from rays, and with one element at both ends. Otherwise it is infinity (all links) with `on`,
/// and the far-field distance with `auto`. Runs, tools and Python all use this rule.
double every_element_within_m(const Scenario& scenario, const ChannelConfig& channel,
                              const rf::AntennaArray& transmitter, const rf::AntennaArray& receiver);

/// Decides EffectPlan::every_element: on if the ends of some link between arrays may be nearer than their far
/// field; and wave_curvature and
/// beam_squint by their bounds.
void plan_arrays(EffectPlan& plan, const Planner& planner, const Scenario& scenario);

}  // namespace greatx::sim
