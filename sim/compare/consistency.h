// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that the modalities see one world, by comparisons between a depth picture, rays and LiDAR returns.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/camera/camera.h"
#include "sim/compare/error_statistics.h"
#include "sim/compare/evidence.h"

namespace greatx::sim {

/// Describes the inverse depth of a picture around an interior pixel. A pixel is interior if its 3 x 3
/// neighbours are finite, belong to one instance and material, and lie in one plane. In a plane 1/z is affine
/// in the pixel coordinates; the neighbours must agree within `affine_tolerance`, relative.
struct InverseDepthPlane {
  double center = 0.0, per_column = 0.0, per_row = 0.0;
  double at(double columns, double rows) const { return center + columns * per_column + rows * per_row; }
};
inline constexpr double affine_tolerance = 2e-6;
/// Returns the plane around a pixel, or nothing if the pixel is not interior.
std::optional<InverseDepthPlane> interior_plane(const render::CameraImages& images, uint32_t column,
                                                uint32_t row);

/// Returns the pixels to probe, which are the same for every picture of this size: a low-discrepancy set (R2
/// sequence, M. Roberts 2018).
std::vector<glm::uvec2> probe_pixels(uint32_t width, uint32_t height, uint32_t count);

/// Returns the direction of the ray through a pixel, in the sensor frame (x forward), scaled to x = 1. The
/// planar depth of a hit is then the ray parameter.
dvec3 pixel_ray(const render::CameraDesc& camera, double column, double row);

/// Describes a LiDAR return: its position in the camera's sensor frame, and what it belongs to (indices + 1).
struct ReturnedPoint {
  dvec3 in_camera{0.0};
  uint32_t instance = 0, material = 0;
  double error_m = 0.0;       ///< largest distance of the position from the true one, by rounding
  dvec3 beam{0.0};            ///< direction of the beam in the camera's frame, unit, for `beam_error_m`
  double beam_error_m = 0.0;  ///< largest distance of the position along the beam, by noise
};
/// Returns the relative difference in depth between a return and the picture of the same tick, at the place
/// where the return projects to. The result is empty if the return projects outside the picture, or to a
/// pixel that is not interior or shows another instance or material (the camera sees the pane that the beam
/// passed). If the position has errors, the result is what they do not account for; it is empty if rounding
/// or noise may move the point by more than a pixel.
std::optional<double> lidar_against_depth(const render::CameraDesc& camera,
                                          const render::CameraImages& images, const ReturnedPoint& point);
/// Does the same for some returns of a sweep, evenly spaced: at most twice `lidar_comparisons`. `xyzi` holds
/// 4 n values in the LiDAR's frame, `error_m` from the true points; `instances` and `materials` are [n], and
/// so is `power` if there is noise.
inline constexpr size_t lidar_comparisons = 1024;
ErrorStatistics lidar_against_depth(const render::CameraDesc& camera, const render::CameraImages& images,
                                    const Pose& camera_from_lidar, std::span<const float> xyzi,
                                    std::span<const uint32_t> instances, std::span<const uint32_t> materials,
                                    double error_m = 0.0, const RangeNoise& noise = {},
                                    std::span<const float> power = {});

}  // namespace greatx::sim
