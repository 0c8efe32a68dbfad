// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/lidar/lidar_targets.h"

#include <algorithm>

#include "core/same_pose.h"

namespace greatx::sim {

namespace {

constexpr size_t stride = 16;
/// A body at 6 km/s moves 10 m in 16 of 1000 steps of a sweep of 0.1 s.
constexpr double margin_m = 10.0;

/// Holds the motion of one body during a sweep. Poses of all bodies are found together, time by time, since
/// the parts of a body share its course.
class Target {
 public:
  Target(const World& world, const TickContext& context, uint32_t body)
      : body_(body), at_tick_(context.body_poses[body]) {
    const scene::Bounds& bounds = world.scene.bodies[body].bounds;
    middle_ = bounds.center();
    radius_m_ = 0.5 * glm::length(bounds.size());
    still_ = !world.scene.bodies[body].joint;
  }

  /// Examines the body at one of the times.
  void look(const Pose& pose, const Pose& sensor, double max_range_m) {
    still_ = still_ && same_pose(pose, at_tick_);
    near_ =
        near_ || glm::distance(pose.apply(middle_), sensor.position) <= max_range_m + radius_m_ + margin_m;
  }
  /// Adds one of the times, in their order.
  void add(const Pose& pose) {
    if (still_) return;
    places_.push_back(pose.apply(middle_));
    motions_.push_back(at_tick_ * pose.inverse());
  }
  uint32_t body() const { return body_; }
  bool near() const { return near_; }
  bool still() const { return still_; }

  render::LidarTarget result() {
    render::LidarTarget target;
    target.body = body_;
    target.motions = std::move(motions_);
    if (still_) places_ = {at_tick_.apply(middle_)};
    scene::Bounds middles;
    for (const dvec3& place : places_) middles.add(place);
    target.center = middles.center();
    double spread = 0.0;
    for (const dvec3& place : places_) spread = std::max(spread, glm::distance(place, target.center));
    // The margin covers rounding of coordinates on the GPU.
    target.radius_m = (radius_m_ + spread) * (1.0 + 1e-6) + 1e-3 + 1e-6 * glm::length(target.center);
    return target;
  }

 private:
  uint32_t body_;
  Pose at_tick_;
  dvec3 middle_{0.0};
  double radius_m_ = 0.0;
  bool near_ = false, still_ = true;
  std::vector<dvec3> places_;
  std::vector<Pose> motions_;
};

}  // namespace

render::LidarTargets lidar_targets(const World& world, const TickContext& context, const SweepView& view) {
  std::vector<Target> targets;
  for (uint32_t body = 1; body < world.scene.bodies.size(); ++body) {
    if (world.scene.bodies[body].primitive_count == 0) continue;
    if (view.unseen_body != 0 && world.scene.owner_of(body) == view.unseen_body) continue;
    targets.emplace_back(world, context, body);
  }
  const size_t last = view.times_s.size() - 1;
  for (size_t i = 0; !targets.empty(); i = std::min(i + stride, last)) {
    const std::vector<Pose> poses = context.body_poses_at(context.time_s + view.times_s[i]);
    const Pose& sensor = view.local_poses[view.local_poses.size() == 1 ? 0 : i];
    for (Target& target : targets) target.look(poses[target.body()], sensor, view.max_range_m);
    if (i == last) break;
  }
  std::erase_if(targets, [](const Target& target) { return !target.near(); });
  render::LidarTargets result{std::ranges::any_of(targets, [](const Target& t) { return !t.still(); }), {}};
  if (!result.apart) return result;
  for (const double time_s : view.times_s) {
    const std::vector<Pose> poses = context.body_poses_at(context.time_s + time_s);
    for (Target& target : targets) target.add(poses[target.body()]);
  }
  for (Target& target : targets) result.bodies.push_back(target.result());
  return result;
}

}  // namespace greatx::sim
