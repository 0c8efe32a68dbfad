// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the pixels and the bounds of shapes behind a fisheye or an equirectangular lens, on the host in fp64.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "renderer/lens/lens_rays.h"
#include "sim/sensors/camera/coverage.h"

namespace greatx::sim {

/// Projects triangles into the picture of a wide lens. Points are in optical axes: x right, y down, z
/// forward. A triangle is cut into its parts within the six faces of a cube around the eye, in which straight
/// edges stay straight. What lies within the cube of the near plane (render::CameraDesc::near_m) is left out.
class WideProjection {
 public:
  /// Throws UserError as render::LensRays does.
  explicit WideProjection(const render::CameraDesc& desc);

  /// Holds what a shape covers so far.
  struct Shape {
    /// u_min, v_min, u_max, v_max of the part within the image circle. A shape that crosses the back of a
    /// panorama, where its rims meet, reaches over the whole width.
    dvec4 bounds;
    bool crosses_near = false;  ///< some part lies within the near cube
  };
  /// Adds a triangle to `shape`, and the pixels whose centres look at it to `coverage`.
  void add(const std::array<dvec3, 3>& corners, Shape& shape, Coverage& coverage) const;

 private:
  struct Bounds;
  void add_part(std::span<const dvec3> part, Shape& shape, Coverage& coverage) const;
  void add_edge(const dvec3& from, const dvec3& to, Bounds& bounds) const;
  void add_special_points(std::span<const dvec3> part, Bounds& bounds) const;

  render::LensRays lens_;
  double near_m_;
  double pixels_per_radian_;       ///< the most anywhere, of an edge or around the axis of a panorama
  std::vector<dvec3> directions_;  ///< of the pixels' centres
  std::vector<dvec3> rim_;         ///< fisheye: the directions at the four ends of the image circle
};

}  // namespace greatx::sim
