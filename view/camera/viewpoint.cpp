// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/camera/viewpoint.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace greatx::view {

namespace {

constexpr double steepest = 89.0 * pi / 180.0;
constexpr double nearest_m = 0.05, farthest_m = 1e6;
/// Of the distance to the pivot: nothing nearer is drawn.
constexpr double near_share = 0.01;

}  // namespace

Viewpoint::Viewpoint(const dvec3& position, double yaw, double pitch, double distance_m)
    : position_(position),
      yaw_(yaw),
      pitch_(std::clamp(pitch, -steepest, steepest)),
      distance_m_(std::clamp(distance_m, nearest_m, farthest_m)) {}

Viewpoint Viewpoint::outside(const scene::Bounds& bounds) {
  const dvec3 middle = 0.5 * (bounds.min + bounds.max);
  const double radius = std::max(0.5 * glm::length(bounds.max - bounds.min), 1.0);
  const double yaw = radians(35.0), pitch = radians(35.0);
  Viewpoint viewpoint(middle, yaw, pitch, 2.4 * radius);  // 1 / sin(half of 50 degrees)
  viewpoint.position_ = middle - viewpoint.distance_m_ * viewpoint.forward();
  return viewpoint;
}

dvec3 Viewpoint::forward() const {
  return {std::cos(pitch_) * std::cos(yaw_), std::cos(pitch_) * std::sin(yaw_), -std::sin(pitch_)};
}
dvec3 Viewpoint::left() const { return {-std::sin(yaw_), std::cos(yaw_), 0.0}; }
dvec3 Viewpoint::up() const { return glm::cross(forward(), left()); }

void Viewpoint::turn(double yaw, double pitch) {
  yaw_ = std::remainder(yaw_ + yaw, 2.0 * pi);
  pitch_ = std::clamp(pitch_ + pitch, -steepest, steepest);
}

void Viewpoint::orbit(double yaw, double pitch) {
  const dvec3 around = pivot();
  turn(yaw, pitch);
  position_ = around - distance_m_ * forward();
}

void Viewpoint::fly(const dvec3& step_m) {
  position_ += step_m.x * forward() + step_m.y * left() + dvec3(0.0, 0.0, step_m.z);
}

void Viewpoint::pan(const dvec2& pixels, double focal_px) {
  const double metres = distance_m_ / focal_px;
  position_ += metres * (pixels.x * left() + pixels.y * up());
}

void Viewpoint::approach(double factor) {
  const dvec3 around = pivot();
  distance_m_ = std::clamp(distance_m_ * factor, nearest_m, farthest_m);
  position_ = around - distance_m_ * forward();
}

void Viewpoint::set_distance(double distance_m) {
  distance_m_ = std::clamp(distance_m, nearest_m, farthest_m);
}

apps::PictureView Viewpoint::picture_view(const dvec3& scene_origin, uint32_t width, uint32_t height,
                                          double vertical_fov) const {
  apps::PictureView view;
  view.local_from_sensor = {position_ - scene_origin, orientation_from_yaw_pitch_roll(yaw_, pitch_, 0.0)};
  view.width = width;
  view.height = height;
  view.fx = view.fy = 0.5 * height / std::tan(0.5 * vertical_fov);
  view.cx = 0.5 * width;
  view.cy = 0.5 * height;
  view.near_m = std::clamp(near_share * distance_m_, 0.02, 1.0);
  return view;
}

}  // namespace greatx::view
