// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the courses of recorded tracks and of nodes that follow others.
#include <algorithm>

#include "sim/scenario/trajectory_makers.h"

namespace greatx::sim {
namespace {

/// Stretches of a recorded course. Between them it rests far below the ground.
class TrackCourse : public Course {
 public:
  explicit TrackCourse(const std::vector<WayPointTrajectory>& stretches) {
    for (const WayPointTrajectory& stretch : stretches) {
      begins_s_.push_back(stretch.points.front().time_s);
      ends_s_.push_back(stretch.points.back().time_s);
      courses_.push_back(make_course(stretch));
    }
    hidden_.pose = courses_.front()->at(begins_s_.front()).pose;
    hidden_.pose.position.z -= TrackTrajectory::hidden_m;
  }
  Motion at(double time_s) const override {
    const Course* course = present(time_s);
    return course != nullptr ? course->at(time_s) : hidden_;
  }
  double most_speed() const override {
    double most = 0.0;
    for (const auto& course : courses_) most = std::max(most, course->most_speed());
    return most;
  }
  Travel travel(double time_s) const override {
    Travel travel;
    if (const Course* course = present(time_s)) travel = course->travel(time_s);
    travel.distance_m = 0.0;  // stretches hold before their begin and after their end
    for (const auto& course : courses_) travel.distance_m += course->travel(time_s).distance_m;
    return travel;
  }

 private:
  const Course* present(double time_s) const {
    const auto after = std::ranges::upper_bound(begins_s_, time_s);
    if (after == begins_s_.begin()) return nullptr;
    const auto index = static_cast<size_t>(after - begins_s_.begin()) - 1;
    return time_s <= ends_s_[index] ? courses_[index].get() : nullptr;
  }

  std::vector<double> begins_s_, ends_s_;
  std::vector<std::unique_ptr<Course>> courses_;
  Motion hidden_;
};

/// A place on another node. The acceleration leaves out that of the node's turning.
class FollowCourse : public Course {
 public:
  FollowCourse(const Course& carrier, const FollowTrajectory& follow)
      : carrier_(carrier),
        offset_{follow.position_m,
                orientation_from_yaw_pitch_roll(follow.rotation.x, follow.rotation.y, follow.rotation.z)} {}
  Motion at(double time_s) const override {
    Motion motion = carrier_.at(time_s);
    const dvec3 arm = motion.pose.rotate(offset_.position), turning = motion.angular_velocity;
    motion.pose = motion.pose * offset_;
    motion.velocity += glm::cross(turning, arm);
    motion.acceleration += glm::cross(turning, glm::cross(turning, arm));
    return motion;
  }
  bool is_static() const override { return carrier_.is_static(); }
  double most_speed() const override {
    constexpr double most_turning = 10.0;  // rad/s, of a carrier
    return is_static() ? 0.0 : carrier_.most_speed() + most_turning * glm::length(offset_.position);
  }
  Travel travel(double time_s) const override { return carrier_.travel(time_s); }

 private:
  const Course& carrier_;
  Pose offset_;
};

}  // namespace

std::unique_ptr<Course> make_course(const TrackTrajectory& track) {
  GREATX_CHECK(track.stretches && !track.stretches->empty(), "a track of no stretches");
  return std::make_unique<TrackCourse>(*track.stretches);
}

std::unique_ptr<Course> make_course(const FollowTrajectory& follow, const Course& carrier) {
  return std::make_unique<FollowCourse>(carrier, follow);
}

}  // namespace greatx::sim
