// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The gait of a walking person: angles of the limbs' joints and the height of the hips, from the distance
// that the person has walked.
// It also has the cranks and legs of one who rides a bicycle (Pedalling).
//
// Stride length follows Boulic, Magnenat-Thalmann and Thalmann (A global human walking model with real-time
// kinematic personification, The Visual Computer 6, 1990): a cycle of two steps is 1.346 sqrt(V / H) H long,
// H the height of the hips in m and V the speed in m/s (normalised: V / (H 1/s)). The legs are solved from
// the places of the feet, so that a planted foot does not slide: each leg is a thigh and a shank, and its
// sole stands still on the ground during half of the cycle, while the body passes over it. In the other half
// it swings forward on a polynomial that joins with equal position and velocity. At each
// instant one foot is planted. The shoulders swing against the legs. Velocities are continuous.
#pragma once

#include <cstdint>

#include "core/units.h"

namespace greatx::sim {

/// Names the joints of one side.
enum class Limb : uint8_t { thigh, shank, upper_arm, forearm };

/// Says how far something has come along its way, and how fast: s(t) with two derivatives.
struct Travel {
  double distance_m = 0.0, speed_mps = 0.0, acceleration_mps2 = 0.0;
};

/// An angle, rad, or a length, m, with two derivatives by time.
struct Turned {
  double value = 0.0, rate = 0.0, acceleration = 0.0;
};

/// Describes the body that walks.
struct Walker {
  double thigh_m = 0.46, shank_m = 0.48;  ///< hip to knee, knee to sole
  double speed_mps = 1.34;                ///< at which the length of the stride is taken; Weidmann (1993)
  friend bool operator==(const Walker&, const Walker&) = default;
};

class Gait {
 public:
  /// `start` is the share of a cycle at distance 0.
  Gait(const Walker& walker, double start);
  /// The length of a cycle, two steps, m.
  double stride_m() const { return stride_m_; }
  /// Returns the turn of a joint about +y (x forward, y left, z up; positive swings a hanging limb
  /// backwards). A shank and a forearm turn on the thigh and the upper arm.
  Turned joint(Limb limb, bool left, const Travel& travel) const;
  /// Returns by how much the hips are lower than those of straight legs, m.
  Turned drop(const Travel& travel) const;
  /// Returns the place of a sole, forward of the hips and above the ground, m.
  Turned sole_forward(bool left, const Travel& travel) const;
  Turned sole_height(bool left, const Travel& travel) const;

  /// Below this speed the steps shrink with it, down to standing on straight legs: only then do feet slide.
  static constexpr double full_speed_mps = 0.4;
  /// Bounds of joint() over all distances and speeds, rad.
  struct Range {
    double least = 0.0, most = 0.0;
  };
  static Range range(const Walker& walker, Limb limb);

 private:
  double leg_m_, thigh_m_, shank_m_, stride_m_, start_, lowest_m_ = 0.0;
};

/// Describes a cyclist and what holds his feet. The hips stand still on the bicycle.
struct Cyclist {
  double thigh_m = 0.42, shank_m = 0.49;   ///< hip to knee, knee to sole
  double forward_m = 0.18, down_m = 0.70;  ///< of the cranks' axle from the hips
  double crank_m = 0.17;                   ///< from this axle to those of the pedals
  double ball_m = 0.07;                    ///< of the foot, ahead of the shank, over the pedal's axle
  double pedal_m = 0.012;                  ///< from that axle to the sole
  double rest = 0.0;                       ///< rad, of the left crank, in which the model's parts stand
  double development_m = 5.3;              ///< the way of one turn of the cranks
  friend bool operator==(const Cyclist&, const Cyclist&) = default;
};

/// The cranks and legs of one who pedals. The left crank points forward at angle 0, down at a quarter of a
/// turn; the right one points against it. A foot is one with its shank, and the ball of the foot stays over
/// the axle of its pedal.
class Pedalling {
 public:
  /// `start` is the share of a turn at distance 0.
  Pedalling(const Cyclist& cyclist, double start) : cyclist_(cyclist), start_(start) {}
  /// Return the turns about +y from the angles at rest. `pedalled` is the way that was pedalled.
  Turned crank(const Travel& pedalled) const;
  Turned joint(Limb limb, bool left, const Travel& pedalled) const;
  /// Returns bounds of joint() over a whole turn, rad. Throws UserError if the legs do not reach the pedals.
  static Gait::Range range(const Cyclist& cyclist, Limb limb);

 private:
  Cyclist cyclist_;
  double start_;
};

}  // namespace greatx::sim
