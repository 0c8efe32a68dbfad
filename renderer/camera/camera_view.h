// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a camera looks at one tick: the constants of its shaders, and what its view leaves out.
#pragma once

#include <array>

#include "core/vec.h"
#include "renderer/camera/camera.h"
#include "renderer/light/shadow.h"
#include "scene/description/scene.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

/// The pinhole picture that the visibility pass draws: the camera's own, or, behind a lens that distorts, one that holds
/// all that the lens sees.
struct PinholeView {
  uint32_t width = 0, height = 0;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
};
PinholeView pinhole_of(const CameraDesc& desc);

struct CameraView {
  /// `exposure`: times radiance in cd/m^2 gives what is stored.
  CameraView(const PinholeView& pinhole, double near_m, const Pose& local_from_sensor, const SunFrame& sun,
             double exposure);

  PinholeView pinhole;
  dvec3 eye;                   ///< local coordinates
  dvec3 forward, right, down;  ///< unit, local axes
  shared::CameraConstants constants;

  /// Whether a sphere lies wholly outside the view; `center` in local axes, from the eye.
  bool outside(const dvec3& center, double radius) const;

 private:
  /// Unit normals that point into the view, and the offset along them where it begins.
  struct Plane {
    dvec3 normal{0.0};
    double offset = 0.0;
  };
  std::array<Plane, 5> planes_;
};

}  // namespace greatx::render
