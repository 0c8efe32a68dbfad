// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the view of a camera at one tick: the constants of its shaders, and the test for bodies outside the
// view.
#pragma once

#include <array>

#include "core/vec.h"
#include "renderer/camera/camera.h"
#include "renderer/light/shadow.h"
#include "scene/description/scene.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

/// Holds the pinhole picture that the visibility pass draws. It is the camera's own picture, or, behind a
/// lens that distorts, one that holds everything that the lens sees.
struct PinholeView {
  uint32_t width = 0, height = 0;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
};
PinholeView pinhole_of(const CameraDesc& desc);

struct CameraView {
  /// `exposure` times radiance in cd/m^2 gives the stored value.
  CameraView(const PinholeView& pinhole, double near_m, const Pose& local_from_sensor, const SunFrame& sun,
             double exposure);

  PinholeView pinhole;
  dvec3 eye;                   ///< local coordinates
  dvec3 forward, right, down;  ///< unit, local axes
  dvec3 clip_x, clip_y;        ///< clip coordinates of p are dot(clip_x, p - eye), dot(clip_y, p - eye)
  shared::CameraConstants constants;

  /// Returns the constants by which the visibility pass draws a body with this pose.
  shared::BodyView of_body(const Pose& local_from_body) const;
  /// Returns whether a sphere lies wholly outside the view; `center` is in local axes, from the eye.
  bool outside(const dvec3& center, double radius) const;
  /// The same of a sphere that moves straight from one point to another.
  bool outside(const dvec3& from, const dvec3& to, double radius) const;
  /// Returns how much of a ball in local coordinates lies in the view, about: from 0 outside to 1 inside, and
  /// continuous.
  double share(const dvec3& center, double radius) const;

 private:
  /// Describes a unit normal that points into the view, and the offset along it where the view begins.
  struct Plane {
    dvec3 normal{0.0};
    double offset = 0.0;
  };
  std::array<Plane, 5> planes_;
};

}  // namespace greatx::render
