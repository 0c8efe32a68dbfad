// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/traffic/followers.h"

#include <algorithm>
#include <cmath>

namespace greatx::sim {

double free_acceleration(const Follower& follower, double speed_mps, double allowed_mps) {
  const double a = follower.acceleration_mps2, b = follower.braking_mps2;
  if (speed_mps <= allowed_mps) return a * (1.0 - std::pow(speed_mps / allowed_mps, idm_exponent));
  return -b * (1.0 - std::pow(allowed_mps / speed_mps, a * idm_exponent / b));
}

double interaction(const Follower& follower, double speed_mps, double gap_m, double leader_mps) {
  const double a = follower.acceleration_mps2, b = follower.braking_mps2;
  const double dynamic =
      speed_mps * follower.headway_s + speed_mps * (speed_mps - leader_mps) / (2.0 * std::sqrt(a * b));
  const double wanted = follower.gap_m + std::max(0.0, dynamic);
  constexpr double least_gap_m = 0.05;
  const double ratio = wanted / std::max(gap_m, least_gap_m);
  return -a * ratio * ratio;
}

double equilibrium_gap(const Follower& follower, double speed_mps) {
  return (follower.gap_m + speed_mps * follower.headway_s) /
         std::sqrt(1.0 - std::pow(speed_mps / follower.desired_mps, idm_exponent));
}

bool changes_lane(const LaneChange& change) {
  constexpr double politeness = 0.2, threshold_mps2 = 0.2, safe_braking_mps2 = 2.0;
  if (change.new_follower_after < -safe_braking_mps2 || change.own_after < -safe_braking_mps2) return false;
  const double others =
      change.new_follower_after - change.new_follower + change.old_follower_after - change.old_follower;
  return change.own_after - change.own + politeness * others > threshold_mps2;
}

Progress advanced(const Progress& progress, double acceleration_mps2, double step_s) {
  const double braking = -progress.speed_mps / step_s;  // stops at the end of the step
  const double a = std::max(acceleration_mps2, braking);
  const double speed = a == braking ? 0.0 : progress.speed_mps + a * step_s;
  return {progress.place_m + 0.5 * (progress.speed_mps + speed) * step_s, speed};
}

}  // namespace greatx::sim
