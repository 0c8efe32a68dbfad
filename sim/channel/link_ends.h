// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Decides for one link at one tick how waves pass its arrays. Runs, tools and Python all use this rule, which
// looks at nothing but the link: its values do not depend on which other links a scenario has.
#pragma once

#include "rf/antenna/antenna.h"
#include "rf/channel/frequency_response.h"
#include "rf/paths/path_solver.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

struct LinkEnds {
  rf::ArrayPose transmitter, receiver;
};

/// Returns the ends with ArrayPose::wavefront and beam_squint, as the effects `wave_curvature` and
/// `beam_squint` of the scenario say: with `auto` by their bounds (sim/plan/array_plan.h) at the distance of
/// the ends and over `half_band_hz`, the largest distance of a frequency from the carrier.
LinkEnds link_ends(const Scenario& scenario, const ChannelConfig& channel,
                   const rf::AntennaArray& transmitter, const rf::EndState& transmitter_state,
                   const rf::AntennaArray& receiver, const rf::EndState& receiver_state, double half_band_hz);

}  // namespace greatx::sim
