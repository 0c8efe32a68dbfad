// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How parts turn on their bodies: at a constant rate, by the way that their node has travelled, with its
// steps, or as it pedals.
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "sim/scenario/rotation.h"
#include "sim/scenario/trajectory.h"

namespace greatx::sim {

/// A wheel: angle = start + distance / radius.
struct Roll {
  double radius_m = 0.3, start = 0.0;  ///< m, rad
};

/// A limb of a walking person.
struct LimbTurn {
  Limb limb = Limb::thigh;
  bool left = true;
  Gait gait;
};

/// The cranks, or a limb, of a cyclist.
struct PedalTurn {
  std::optional<Limb> limb;
  bool left = true;
  Pedalling pedalling;
};

class PartTurn {
 public:
  explicit PartTurn(Rotation rotation) : turn_(std::move(rotation)) {}
  explicit PartTurn(Roll roll) : turn_(roll) {}
  explicit PartTurn(const LimbTurn& limb) : turn_(limb) {}
  explicit PartTurn(const PedalTurn& pedal) : turn_(pedal) {}
  /// Returns the angle, rad, right-handed about the axis, and its derivatives, when the node has travelled so
  /// far. A part that does not travel() turns at a constant rate, whatever its node does.
  Turned at(const Travel& travel, double time_s) const;
  bool travels() const { return !std::holds_alternative<Rotation>(turn_); }
  /// Whether the way that counts is that which was pedalled.
  bool pedals() const { return std::holds_alternative<PedalTurn>(turn_); }

 private:
  std::variant<Rotation, Roll, LimbTurn, PedalTurn> turn_;
};

/// Makes the turn of a part. `start` in [0, 1) is the share of a turn, or of a limb's cycle, at the start.
PartTurn make_part_turn(const PartMotion& motion, const Rational& tick_rate_hz, double start);

/// Returns the course of a node that walks: its height above the ground falls and rises with the steps.
std::unique_ptr<Course> walking(std::unique_ptr<Course> course, const Gait& gait);

}  // namespace greatx::sim
