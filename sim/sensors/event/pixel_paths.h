// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes how the pixels of an event camera look at two pictures from the instants between them.
#pragma once

#include <functional>
#include <vector>

#include "core/vec.h"
#include "renderer/event/reprojection.h"
#include "sim/scenario/optics.h"

namespace greatx::sim {

/// Convert between the axes x forward, y left, z up and x right, y down, z forward.
inline dvec3 to_optical(const dvec3& v) { return {-v.y, -v.z, v.x}; }
inline dvec3 from_optical(const dvec3& v) { return {v.z, -v.x, -v.y}; }

/// Holds the poses of the camera and of all bodies at an instant, in local coordinates.
struct EventMoment {
  Pose camera;
  std::vector<Pose> bodies;
};

/// Fills `paths` for `grid` steps between two pictures. `moment_at` takes the fraction of the interval, 0 at
/// the first picture and 1 at the second. The world's paths are cubic functions of time that are right at
/// four instants. If they lead points beyond `nearest_m` further than 0.02 pixels astray at any of the
/// instants, the right ones are listed.
void find_pixel_paths(const PinholeConfig& camera, uint32_t grid, double nearest_m,
                      const std::function<EventMoment(double)>& moment_at, render::PixelPaths& paths);

}  // namespace greatx::sim
