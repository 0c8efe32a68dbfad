// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/part_turns.h"

#include <cmath>

#include "core/units.h"

namespace greatx::sim {
namespace {

Turned turned_by(const Rotation& rotation, const Travel&, double time_s) {
  return {2.0 * pi * rotation.turns(time_s), 2.0 * pi * rotation.rate_hz(), 0.0};
}

Turned turned_by(const Roll& roll, const Travel& travel, double) {
  return {std::remainder(roll.start + travel.distance_m / roll.radius_m, 2.0 * pi),
          travel.speed_mps / roll.radius_m, travel.acceleration_mps2 / roll.radius_m};
}

Turned turned_by(const LimbTurn& limb, const Travel& travel, double) {
  return limb.gait.joint(limb.limb, limb.left, travel);
}

Turned turned_by(const PedalTurn& pedal, const Travel& pedalled, double) {
  return pedal.limb ? pedal.pedalling.joint(*pedal.limb, pedal.left, pedalled)
                    : pedal.pedalling.crank(pedalled);
}

class WalkingCourse : public Course {
 public:
  WalkingCourse(std::unique_ptr<Course> course, const Gait& gait) : course_(std::move(course)), gait_(gait) {}
  Motion at(double time_s) const override {
    Motion motion = course_->at(time_s);
    const Turned drop = gait_.drop(course_->travel(time_s));
    motion.pose.position.z -= drop.value;
    motion.velocity.z -= drop.rate;
    motion.acceleration.z -= drop.acceleration;
    return motion;
  }
  bool is_static() const override { return course_->is_static(); }
  double most_speed() const override { return 1.5 * course_->most_speed(); }  // the hips sink less steeply
  Travel travel(double time_s) const override { return course_->travel(time_s); }

 private:
  std::unique_ptr<Course> course_;
  Gait gait_;
};

}  // namespace

Turned PartTurn::at(const Travel& travel, double time_s) const {
  return std::visit([&](const auto& turn) { return turned_by(turn, travel, time_s); }, turn_);
}

PartTurn make_part_turn(const PartMotion& motion, const Rational& tick_rate_hz, double start) {
  if (const auto* rate = std::get_if<TurnRate>(&motion))
    return PartTurn(Rotation(tick_rate_hz, *rate, start));
  if (const auto* roll = std::get_if<RollConfig>(&motion))
    return PartTurn(Roll{roll->radius_m, 2.0 * pi * start});
  if (const auto* pedal = std::get_if<PedalConfig>(&motion))
    return PartTurn(PedalTurn{pedal->limb, pedal->left, Pedalling(pedal->cyclist, start)});
  const auto& limb = std::get<LimbConfig>(motion);
  return PartTurn(LimbTurn{limb.limb, limb.left, Gait(limb.walker, start)});
}

std::unique_ptr<Course> walking(std::unique_ptr<Course> course, const Gait& gait) {
  return std::make_unique<WalkingCourse>(std::move(course), gait);
}

}  // namespace greatx::sim
