// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How one who moves behind another accelerates, and when a driver changes the lane.
//
// - The intelligent driver model (IDM): Treiber, Hennecke and Helbing, Congested traffic states in empirical
//   observations and microscopic simulations, Physical Review E 62, 1805 (2000), equations 3 and 4. Above the
//   desired speed the free term is that of the improved IDM (Treiber and Kesting, Traffic Flow Dynamics,
//   2013, section 11.3.7), since the plain one brakes too hard there.
// - MOBIL: Kesting, Treiber and Helbing, General lane-changing model MOBIL for car-following models,
//   Transportation Research Record 1999, 86 (2007).
// - The update of a step: Treiber and Kanagaraj, Comparing numerical integration schemes for time-continuous
//   car-following models, Physica A 419, 183 (2015): constant acceleration within the step ("ballistic").
#pragma once

namespace greatx::sim {

/// The parameters of one who follows others.
struct Follower {
  double desired_mps = 13.9;
  double acceleration_mps2 = 1.5;  ///< a
  double braking_mps2 = 2.0;       ///< b, comfortable
  double headway_s = 1.2;          ///< T
  double gap_m = 2.0;              ///< s0, when everyone stands
};

/// Exponent of the free term of the IDM.
inline constexpr double idm_exponent = 4.0;
/// The most that anyone brakes, m/s^2.
inline constexpr double most_braking_mps2 = 9.0;

/// Returns the acceleration on a free way where `allowed_mps` is desired.
double free_acceleration(const Follower& follower, double speed_mps, double allowed_mps);
/// Returns the interaction term of the IDM, 0 or less: -a (s* / s)^2.
double interaction(const Follower& follower, double speed_mps, double gap_m, double leader_mps);
/// Returns the acceleration of the IDM behind a leader.
inline double idm_acceleration(const Follower& follower, double speed_mps, double gap_m, double leader_mps) {
  return free_acceleration(follower, speed_mps, follower.desired_mps) +
         interaction(follower, speed_mps, gap_m, leader_mps);
}
/// Returns the gap at which the IDM neither accelerates nor brakes behind a leader of the same speed, which
/// is below the desired one: (s0 + v T) / sqrt(1 - (v / v0)^4).
double equilibrium_gap(const Follower& follower, double speed_mps);

/// Holds the accelerations that MOBIL weighs, m/s^2: before the change and after it.
struct LaneChange {
  double own = 0.0, own_after = 0.0;
  double new_follower = 0.0, new_follower_after = 0.0;  ///< on the other lane; both 0: nobody
  double old_follower = 0.0, old_follower_after = 0.0;  ///< on the own lane; both 0: nobody
};
/// Whether the change is safe and worth while.
bool changes_lane(const LaneChange& change);

/// A place along a way and a speed.
struct Progress {
  double place_m = 0.0, speed_mps = 0.0;
};
/// Advances by one step. One who would stop within it stops at its end.
Progress advanced(const Progress& progress, double acceleration_mps2, double step_s);

}  // namespace greatx::sim
