// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a wave that meets an array may be taken for plane.
#pragma once

#include "sim/effect_planner.h"

namespace greatx::sim {

/// 2 (D_tx + D_rx)^2 / lambda, metres: the end of the far field (C. A. Balanis, Antenna Theory, 4th ed., 2.2.4; for two
/// apertures their sum). Beyond it a spherical wave differs from a plane one by less than pi/8 at the arrays' edges.
double far_field_distance_m(const Scenario& scenario, const ChannelConfig& channel, size_t transmitter,
                            size_t receiver);

/// Decides EffectPlan::every_element: on where some link of an array may be nearer than its far field.
void plan_arrays(EffectPlan& plan, const Planner& planner, const Scenario& scenario);

}  // namespace greatx::sim
