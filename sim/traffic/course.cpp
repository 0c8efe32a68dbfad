// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/traffic/course.h"

#include <cmath>

#include "sim/traffic/pieces.h"

namespace greatx::sim {
namespace {

class TrafficCourse : public Course {
 public:
  TrafficCourse(std::shared_ptr<Simulation> simulation, uint32_t member)
      : simulation_(std::move(simulation)), member_(member), body_(simulation_->body(member)) {
    start_ = simulation_->at(member_, 0.0);
    start_m_ = whole(start_);
  }

  Motion at(double time_s) const override {
    const WayState state = simulation_->at(member_, time_s);
    const WayPlace place = place_on(state.piece, state.way_m);
    const double v = state.speed_mps, a = state.acceleration_mps2;
    Motion motion;
    motion.pose.position = place.position;
    motion.velocity = v * place.first;
    motion.acceleration = v * v * place.second + a * place.first;
    const double yaw = place.heading, yaw_rate = v * place.heading_first;
    const double yaw_acceleration = v * v * place.heading_second + a * place.heading_first;
    // Slopes are small: their changes turn the body, and their second changes are left out.
    double pitch = 0.0, pitch_rate = 0.0;
    const double level = glm::length(dvec2(place.first));
    if (body_.kind != TrafficMember::Kind::pedestrian && place.first.z != 0.0) {
      const double slope = place.first.z / level;
      pitch = -std::atan(slope);
      const double level_first = glm::dot(dvec2(place.first), dvec2(place.second)) / level;
      const double slope_first = (place.second.z - slope * level_first) / level;
      pitch_rate = -v * slope_first / (1.0 + slope * slope);
    }
    motion.pose.orientation = orientation_from_yaw_pitch_roll(yaw, pitch, 0.0);
    const dvec3 left(-std::sin(yaw), std::cos(yaw), 0.0), up(0.0, 0.0, 1.0);
    motion.angular_velocity = yaw_rate * up + pitch_rate * left;
    const dvec3 arm = motion.pose.rotate({body_.origin_m, 0.0, 0.0});
    motion.pose.position += arm;
    motion.velocity += glm::cross(motion.angular_velocity, arm);
    motion.acceleration += glm::cross(motion.angular_velocity, glm::cross(motion.angular_velocity, arm)) +
                           glm::cross(yaw_acceleration * up, arm);
    return motion;
  }

  double most_speed() const override {
    // The origin is up to body_.origin_m ahead of the axle, and a bend turns it by v / 3 m at most.
    const double turning = std::hypot(1.0, std::abs(body_.origin_m) / 3.0);
    constexpr double changing_lane = 1.1;
    return simulation_->most_speed_mps(member_) * changing_lane * turning;
  }

  Travel travel(double time_s) const override {
    // People count their steps as seen from above, not down and up kerbs.
    if (body_.kind == TrafficMember::Kind::pedestrian) {
      const WayState now = simulation_->at(member_, time_s);
      return {now.way_m - start_.way_m, now.speed_mps, now.acceleration_mps2};
    }
    const WayState state = simulation_->at(member_, time_s);
    const WayPlace place = place_on(state.piece, state.way_m);
    const double stretch = glm::length(place.first);
    return {whole(state) - start_m_, state.speed_mps * stretch,
            state.acceleration_mps2 * stretch +
                state.speed_mps * state.speed_mps * glm::dot(place.first, place.second) / stretch};
  }

  int indicated_side(double time_s) const override {
    if (body_.kind != TrafficMember::Kind::vehicle) return 0;
    return sim::indicated_side(simulation_->at(member_, time_s));
  }

  Travel pedalled(double time_s) const override {
    const WayState state = simulation_->at(member_, time_s);
    return {state.pedalled_m - start_.pedalled_m, state.pedalled_mps, state.pedalled_mps2};
  }

 private:
  static double whole(const WayState& state) {
    return state.piece.travelled_m + length_between(state.piece, state.piece.begin_m, state.way_m);
  }

  std::shared_ptr<Simulation> simulation_;
  uint32_t member_;
  TrafficBody body_;
  WayState start_;  ///< at time 0
  double start_m_ = 0.0;
};

}  // namespace

std::unique_ptr<Course> make_traffic_course(std::shared_ptr<Simulation> simulation, uint32_t member) {
  return std::make_unique<TrafficCourse>(std::move(simulation), member);
}

}  // namespace greatx::sim
