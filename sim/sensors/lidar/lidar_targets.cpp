// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/lidar/lidar_targets.h"

#include <algorithm>

namespace greatx::sim {

namespace {

constexpr size_t stride = 16;
/// A body at 6 km/s moves 10 m in 16 of 1000 steps of a sweep of 0.1 s.
constexpr double margin_m = 10.0;

bool same(const Pose& a, const Pose& b) { return a.position == b.position && a.orientation == b.orientation; }

/// Holds the motion of one body during a sweep.
class Target {
 public:
  Target(const World& world, const TickContext& context, const SweepView& view, uint32_t body)
      : context_(context), view_(view), body_(body), at_tick_(context.body_poses[body]) {
    const scene::Bounds& bounds = world.scene.bodies[body].bounds;
    middle_ = bounds.center();
    radius_m_ = 0.5 * glm::length(bounds.size());
    still_ = !world.scene.bodies[body].joint;
  }

  /// Examines the body at some of the times.
  void look() {
    for (size_t i = 0; i < view_.times_s.size(); i = next(i)) {
      const Pose pose = pose_at(i);
      still_ = still_ && same(pose, at_tick_);
      const Pose& sensor = view_.local_poses[view_.local_poses.size() == 1 ? 0 : i];
      near_ = near_ ||
              glm::distance(pose.apply(middle_), sensor.position) <= view_.max_range_m + radius_m_ + margin_m;
    }
  }
  bool near() const { return near_; }
  bool still() const { return still_; }

  render::LidarTarget result() const {
    render::LidarTarget target;
    target.body = body_;
    scene::Bounds middles;
    std::vector<dvec3> places;
    if (still_) {
      places.push_back(at_tick_.apply(middle_));
    } else {
      for (size_t i = 0; i < view_.times_s.size(); ++i) {
        const Pose pose = pose_at(i);
        places.push_back(pose.apply(middle_));
        target.motions.push_back(at_tick_ * pose.inverse());
      }
    }
    for (const dvec3& place : places) middles.add(place);
    target.center = middles.center();
    double spread = 0.0;
    for (const dvec3& place : places) spread = std::max(spread, glm::distance(place, target.center));
    // The margin covers rounding of coordinates on the GPU.
    target.radius_m = (radius_m_ + spread) * (1.0 + 1e-6) + 1e-3 + 1e-6 * glm::length(target.center);
    return target;
  }

 private:
  /// Steps by `stride`, and to the last time.
  size_t next(size_t i) const {
    const size_t last = view_.times_s.size() - 1;
    return i == last ? last + 1 : std::min(i + stride, last);
  }
  Pose pose_at(size_t i) const { return context_.body_pose_at(body_, context_.time_s + view_.times_s[i]); }

  const TickContext& context_;
  const SweepView& view_;
  uint32_t body_;
  Pose at_tick_;
  dvec3 middle_{0.0};
  double radius_m_ = 0.0;
  bool near_ = false, still_ = true;
};

}  // namespace

render::LidarTargets lidar_targets(const World& world, const TickContext& context, const SweepView& view) {
  std::vector<Target> near;
  bool moving = false;
  for (uint32_t body = 1; body < world.scene.bodies.size(); ++body) {
    if (world.scene.bodies[body].primitive_count == 0) continue;
    if (view.unseen_body != 0 && world.scene.owner_of(body) == view.unseen_body) continue;
    Target target(world, context, view, body);
    target.look();
    if (!target.near()) continue;
    moving |= !target.still();
    near.push_back(target);
  }
  render::LidarTargets targets{moving, {}};
  if (targets.apart)
    for (const Target& target : near) targets.bodies.push_back(target.result());
  return targets;
}

}  // namespace greatx::sim
