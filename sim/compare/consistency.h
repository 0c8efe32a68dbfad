// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Do the modalities see one world? Closed comparisons between a depth picture, rays and LiDAR returns.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/camera/camera.h"
#include "sim/compare/error_statistics.h"

namespace greatx::sim {

/// A picture's inverse depth around a pixel, if that pixel is an interior one: its 3 x 3 neighbours are
/// finite, of one instance and material, and lie in one plane (1/z is affine in the pixel's coordinates then,
/// within `affine_tolerance` relative).
struct InverseDepthPlane {
  double center = 0.0, per_column = 0.0, per_row = 0.0;
  double at(double columns, double rows) const { return center + columns * per_column + rows * per_row; }
};
inline constexpr double affine_tolerance = 2e-6;
std::optional<InverseDepthPlane> interior_plane(const render::CameraImages& images, uint32_t column,
                                                uint32_t row);

/// Pixels to probe, the same for every picture of this size: a low-discrepancy set (R2 sequence, M. Roberts
/// 2018).
std::vector<glm::uvec2> probe_pixels(uint32_t width, uint32_t height, uint32_t count);

/// Direction of the ray through a pixel's centre in the sensor frame (x forward), with x = 1: the planar
/// depth is the multiple of it at which a ray hits.
dvec3 pixel_ray(const render::CameraDesc& camera, double column, double row);

/// A LiDAR's return: where, in the camera's sensor frame, and what it is of (indices + 1).
struct ReturnedPoint {
  dvec3 in_camera{0.0};
  uint32_t instance = 0, material = 0;
};
/// Relative difference between a return of the same tick and the picture, at the place where it falls; empty
/// where it falls outside or on no interior pixel of the same instance and material (the camera sees the pane
/// that the beam went through).
std::optional<double> lidar_against_depth(const render::CameraDesc& camera,
                                          const render::CameraImages& images, const ReturnedPoint& point);
/// The same for some of a sweep's returns, evenly over it: at most twice `lidar_comparisons`. `xyzi` [4 n] in
/// the LiDAR's frame, `instances`, `materials` [n].
inline constexpr size_t lidar_comparisons = 1024;
ErrorStatistics lidar_against_depth(const render::CameraDesc& camera, const render::CameraImages& images,
                                    const Pose& camera_from_lidar, std::span<const float> xyzi,
                                    std::span<const uint32_t> instances, std::span<const uint32_t> materials);

}  // namespace greatx::sim
