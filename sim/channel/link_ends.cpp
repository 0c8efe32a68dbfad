// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/link_ends.h"

#include "sim/plan/array_plan.h"

namespace greatx::sim {

namespace {

bool is_needed(const Scenario& scenario, const char* effect, double phase_rad) {
  if (phase_rad == 0.0) return false;
  const auto wish = scenario.effects.find(effect);
  const Switch asked = wish == scenario.effects.end() ? Switch::automatic : wish->second;
  return asked == Switch::automatic ? phase_matters(phase_rad, scenario.tolerance_db) : asked == Switch::on;
}

}  // namespace

LinkEnds link_ends(const Scenario& scenario, const ChannelConfig& channel,
                   const rf::AntennaArray& transmitter, const rf::EndState& transmitter_state,
                   const rf::AntennaArray& receiver, const rf::EndState& receiver_state,
                   double half_band_hz) {
  const double reach_m = transmitter.reach() + receiver.reach();
  const double distance_m = glm::distance(transmitter_state.position, receiver_state.position);
  const bool curved =
      is_needed(scenario, "wave_curvature", curvature_phase_rad(reach_m, distance_m, channel.carrier_hz));
  const bool squints = is_needed(scenario, "beam_squint", squint_phase_rad(reach_m, half_band_hz));
  const rf::Wavefront wavefront = curved ? rf::Wavefront::curved : rf::Wavefront::plane;
  return {{transmitter, transmitter_state.orientation, wavefront, squints},
          {receiver, receiver_state.orientation, wavefront, squints}};
}

}  // namespace greatx::sim
