// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a camera looks at one tick: the constants of its shaders, and what its view leaves out.
#pragma once

#include <array>

#include "core/vec.h"
#include "renderer/camera/camera.h"
#include "renderer/light/shadow.h"
#include "scene/scene.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

struct CameraView {
  /// `exposure`: times radiance in cd/m^2 gives what is stored.
  CameraView(const CameraDesc& desc, const Pose& local_from_sensor, const SunFrame& sun, double exposure);

  dvec3 eye;      ///< local coordinates
  dvec3 forward;  ///< unit
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

/// A lamp as light.glsl reads it; position from the eye and direction in local axes.
shared::GpuLight light_block(const scene::PunctualLight& light, const dvec3& position,
                             const dvec3& direction);

}  // namespace greatx::render
