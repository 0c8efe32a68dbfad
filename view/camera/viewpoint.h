// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the user looks from: a point that flies, or that orbits another point, which may be a node that
// moves. Angles as everywhere: x forward, y left, z up; yaw from +x to +y, pitch positive downwards.
#pragma once

#include <cstdint>

#include "core/vec.h"
#include "draw/paths/view.h"
#include "scene/description/scene.h"

namespace greatx::view {

class Viewpoint {
 public:
  /// Looks at the middle of `bounds` (world) from outside and above, so that all of it is in view.
  static Viewpoint outside(const scene::Bounds& bounds);
  /// Looks from `position` (world) with these angles, rad; the pivot lies `distance_m` ahead.
  Viewpoint(const dvec3& position, double yaw, double pitch, double distance_m = 30.0);

  const dvec3& position() const { return position_; }
  dvec3 forward() const;
  dvec3 left() const;
  dvec3 up() const;
  dvec3 pivot() const { return position_ + distance_m_ * forward(); }
  double distance_m() const { return distance_m_; }
  double yaw() const { return yaw_; }
  double pitch() const { return pitch_; }

  /// Turns where it stands. The pitch stays within 89 degrees.
  void turn(double yaw, double pitch);
  /// Turns around the pivot.
  void orbit(double yaw, double pitch);
  /// Moves along forward, left and world up, metres.
  void fly(const dvec3& step_m);
  /// Moves by a drag of `pixels` (right, down) so that the pivot follows the cursor; `focal_px` is the
  /// view's.
  void pan(const dvec2& pixels, double focal_px);
  /// Multiplies the distance to the pivot, which stays. The distance stays within 0.05 m and 1e6 m.
  void approach(double factor);
  /// Puts the pivot at a distance on the axis, e.g. on the surface under the cursor.
  void set_distance(double distance_m);
  /// Moves everything by the way of a node that it follows.
  void carry(const dvec3& step_m) { position_ += step_m; }

  /// The view of a window of `width` x `height` pixels with this vertical opening angle, rad.
  apps::PictureView picture_view(const dvec3& scene_origin, uint32_t width, uint32_t height,
                                 double vertical_fov) const;

 private:
  dvec3 position_{0.0};
  double yaw_ = 0.0, pitch_ = 0.0, distance_m_ = 30.0;
};

}  // namespace greatx::view
