// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/array_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "sim/plan/antennas.h"
#include "sim/plan/trajectory_bounds.h"

namespace greatx::sim {

namespace {

/// Returns the largest change of a path by a phase, dB: |e^{j phase} - 1| beside 1.
double change_db(double phase_rad) {
  return 2.0 * decibels(1.0 + 2.0 * std::sin(0.5 * std::min(phase_rad, pi)));
}

}  // namespace

bool phase_matters(double phase_rad, double tolerance_db) { return change_db(phase_rad) > tolerance_db; }

double squint_phase_rad(double reach_m, double half_band_hz) {
  return 2.0 * pi * half_band_hz * reach_m / speed_of_light;
}

double curvature_phase_rad(double reach_m, double distance_m, double carrier_hz) {
  // L - |L u - d| is between u . d - d^2/2L and u . d.
  return pi * reach_m * reach_m * carrier_hz / (speed_of_light * std::max(distance_m, 1e-9));
}

double half_band_hz(const ChannelConfig& channel) {
  const double sampled_hz = channel.subcarriers / 2 * channel.subcarrier_spacing_hz;
  return std::max(sampled_hz, channel.taps ? 0.5 * channel.taps->bandwidth_hz : 0.0);
}

namespace {

/// Returns a box, world coordinates, that an antenna never leaves.
scene::Bounds reach_of(const Scenario& scenario, const std::string& name) {
  const auto [node, sensor] = sensor_place(scenario, name);
  scene::Bounds bounds;
  add_trajectory(scenario, scenario.nodes[node].trajectory, bounds);
  const dvec3 mount(glm::length(scenario.nodes[node].sensors[sensor].mount.position_m));
  return {bounds.min - mount, bounds.max + mount};
}

double distance(const scene::Bounds& a, const scene::Bounds& b) {
  return glm::length(glm::max(glm::max(a.min - b.max, b.min - a.max), dvec3(0.0)));
}

double far_field_of(const Scenario& scenario, const ChannelConfig& channel, size_t transmitter,
                    size_t receiver) {
  return rf::far_field_distance_m(
      antenna_array(scenario, channel.transmitters[transmitter], channel.carrier_hz),
      antenna_array(scenario, channel.receivers[receiver], channel.carrier_hz), channel.carrier_hz);
}

/// Describes the link with the smallest ratio of distance to far-field distance.
struct Nearest {
  /// The far-field distance, and the least distance that the ends can have.
  double far_m = 0.0, distance_m = 0.0;
  std::string transmitter, receiver;
  bool near() const { return distance_m < far_m; }
};

Nearest nearest_of(const Scenario& scenario) {
  Nearest nearest;
  for (const ChannelConfig& channel : scenario.channels) {
    if (channel.candidates == ChannelConfig::Candidates::rays) continue;
    for (size_t t = 0; t < channel.transmitters.size(); ++t)
      for (size_t r = 0; r < channel.receivers.size(); ++r) {
        const double far_m = far_field_of(scenario, channel, t, r);
        if (far_m == 0.0 || channel.transmitters[t] == channel.receivers[r]) continue;
        const double distance_m =
            distance(reach_of(scenario, channel.transmitters[t]), reach_of(scenario, channel.receivers[r]));
        if (nearest.far_m == 0.0 || distance_m / far_m < nearest.distance_m / nearest.far_m)
          nearest = {far_m, distance_m, channel.transmitters[t], channel.receivers[r]};
      }
  }
  return nearest;
}

/// Describes the link whose array phases change most over the band.
struct Squint {
  double phase_rad = 0.0, band_hz = 0.0, reach_m = 0.0;
  std::string transmitter, receiver;
};

Squint squint_of(const Scenario& scenario) {
  Squint most;
  for (const ChannelConfig& channel : scenario.channels) {
    const double half_hz = half_band_hz(channel);
    for (const std::string& transmitter : channel.transmitters)
      for (const std::string& receiver : channel.receivers) {
        const double reach_m = antenna_array(scenario, transmitter, channel.carrier_hz).reach() +
                               antenna_array(scenario, receiver, channel.carrier_hz).reach();
        const double phase_rad = squint_phase_rad(reach_m, half_hz);
        if (phase_rad > most.phase_rad) most = {phase_rad, 2.0 * half_hz, reach_m, transmitter, receiver};
      }
  }
  return most;
}

void plan_squint(EffectPlan& plan, const Planner& planner, const Scenario& scenario) {
  const Squint squint = squint_of(scenario);
  const bool any = squint.phase_rad > 0.0,
             needed = any && phase_matters(squint.phase_rad, scenario.tolerance_db);
  planner.decide(
      plan.beam_squint, needed,
      scenario.channels.empty() ? "no channel"
      : !any                    ? "no antenna has more than one element, or one subcarrier"
      : needed                  ? "more than the tolerance"
                                : "within the tolerance",
      any ? fmt::format("at most {:.3g} rad, {:.3g} dB of a path, at the edges of the arrays ({}, "
                        "{}: {:.3g} m) and of a band of {:.4g} MHz; tolerance {:.3g} dB",
                        squint.phase_rad, change_db(squint.phase_rad), squint.transmitter, squint.receiver,
                        squint.reach_m, squint.band_hz * 1e-6, scenario.tolerance_db)
          : "");
  if (!any) plan.beam_squint.on = false;
}

/// Describes the link whose waves are curved most over its arrays.
struct Curvature {
  double phase_rad = 0.0, distance_m = 0.0, reach_m = 0.0;
  std::string transmitter, receiver;
};

Curvature curvature_of(const Scenario& scenario) {
  Curvature most;
  for (const ChannelConfig& channel : scenario.channels)
    for (size_t t = 0; t < channel.transmitters.size(); ++t)
      for (size_t r = 0; r < channel.receivers.size(); ++r) {
        const std::string &transmitter = channel.transmitters[t], &receiver = channel.receivers[r];
        const double reach_m = antenna_array(scenario, transmitter, channel.carrier_hz).reach() +
                               antenna_array(scenario, receiver, channel.carrier_hz).reach();
        if (reach_m == 0.0) continue;
        const double distance_m = distance(reach_of(scenario, transmitter), reach_of(scenario, receiver));
        const double phase_rad = curvature_phase_rad(reach_m, distance_m, channel.carrier_hz);
        if (phase_rad > most.phase_rad) most = {phase_rad, distance_m, reach_m, transmitter, receiver};
      }
  return most;
}

void plan_curvature(EffectPlan& plan, const Planner& planner, const Scenario& scenario) {
  const Curvature curvature = curvature_of(scenario);
  const bool any = curvature.phase_rad > 0.0,
             needed = any && phase_matters(curvature.phase_rad, scenario.tolerance_db);
  planner.decide(
      plan.wave_curvature, needed,
      scenario.channels.empty() ? "no channel"
      : !any                    ? "no antenna has more than one element"
      : needed                  ? "more than the tolerance"
                                : "within the tolerance",
      any ? fmt::format("at most {:.3g} rad, {:.3g} dB of a path, over {:.3g} m of arrays {:.3g} m "
                        "away ({}, {}); tolerance {:.3g} dB",
                        std::min(curvature.phase_rad, pi), change_db(curvature.phase_rad), curvature.reach_m,
                        curvature.distance_m, curvature.transmitter, curvature.receiver,
                        scenario.tolerance_db)
          : "");
  if (!any) plan.wave_curvature.on = false;
}

}  // namespace

bool may_be_near(const Scenario& scenario, const ChannelConfig& channel, size_t transmitter,
                 size_t receiver) {
  return distance(reach_of(scenario, channel.transmitters[transmitter]),
                  reach_of(scenario, channel.receivers[receiver])) <
         far_field_of(scenario, channel, transmitter, receiver);
}

Switch every_element_asked(const Scenario& scenario) {
  const auto wish = scenario.effects.find("every_element");
  return wish == scenario.effects.end() ? Switch::automatic : wish->second;
}

double every_element_within_m(const Scenario& scenario, const ChannelConfig& channel,
                              const rf::AntennaArray& transmitter, const rf::AntennaArray& receiver) {
  const Switch asked = every_element_asked(scenario);
  if (asked == Switch::off || channel.candidates == ChannelConfig::Candidates::rays) return 0.0;
  const double far_m = rf::far_field_distance_m(transmitter, receiver, channel.carrier_hz);
  return asked == Switch::on && far_m > 0.0 ? std::numeric_limits<double>::infinity() : far_m;
}

void plan_arrays(EffectPlan& plan, const Planner& planner, const Scenario& scenario) {
  plan_curvature(plan, planner, scenario);
  plan_squint(plan, planner, scenario);
  const Nearest nearest = nearest_of(scenario);
  const bool rays = std::any_of(
      scenario.channels.begin(), scenario.channels.end(),
      [](const ChannelConfig& channel) { return channel.candidates == ChannelConfig::Candidates::rays; });
  planner.decide(
      plan.every_element, nearest.near(),
      scenario.channels.empty() ? "no channel"
      : nearest.far_m == 0.0    ? (rays ? "candidates from rays are for one point of an array"
                                        : "no antenna has more than one element")
      : nearest.near()
          ? fmt::format("{} and {} may come within {:.3g} m: in links nearer than their far field every two "
                        "elements are solved apart",
                        nearest.transmitter, nearest.receiver, nearest.distance_m)
          : "all links are in the far field of their arrays: one path for all elements",
      nearest.far_m == 0.0
          ? ""
          : fmt::format("far field from 2 (D_tx + D_rx)^2/lambda = {:.3g} m ({}, {}); beyond it "
                        "phases at the edges are off by pi/8 at most at the carrier",
                        nearest.far_m, nearest.transmitter, nearest.receiver));
  if (!plan.every_element.on) return;
  if (rays) throw_user_error("effects: every_element: expected auto or off with candidates: rays, found on");
  if (nearest.far_m == 0.0) plan.every_element.on = false;
}

}  // namespace greatx::sim
