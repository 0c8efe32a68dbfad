// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Decides whether materials and air may keep their properties of the carrier over the band of every channel.
#pragma once

#include "core/band.h"
#include "scene/description/scene.h"
#include "sim/plan/effect_planner.h"

namespace greatx::sim {

/// Returns the band of a channel's subcarriers.
Band band_of(const ChannelConfig& channel);

/// Decides EffectPlan::dispersion, after the other effects of radio: `auto` leaves it off and says whether
/// the bound of some channel exceeds the tolerance. The bound is 20 lg(1 + e). Here e is the largest norm of
/// the difference between a path's transfer at a subcarrier and at the carrier (delay and spreading left
/// out), over what the air of the carrier leaves. No interaction makes a field stronger, so with n
/// interactions, whose coefficients change by at most d (rf::most_band_change), and with air that changes by
/// at most a dB (rf::most_air_change_db), the product of all factors gives 1 + e <= (1 + d)^n 10^(a/20).
/// Hence the parts add in dB. Foliage, diffraction and the weights of finite reflectors are not in the bound.
/// Where the models of materials and air do not cover the band, the reason says so.
void plan_dispersion(EffectPlan& plan, const Planner& planner, const Scenario& scenario,
                     const scene::Scene& scene, double longest_m);

}  // namespace greatx::sim
