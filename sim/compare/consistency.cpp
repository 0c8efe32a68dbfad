// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/compare/consistency.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace greatx::sim {

std::optional<InverseDepthPlane> interior_plane(const render::CameraImages& images, uint32_t column,
                                                uint32_t row) {
  if (column == 0 || row == 0 || column + 1 >= images.width || row + 1 >= images.height) return std::nullopt;
  const auto index = [&](int dc, int dr) {
    return (row + static_cast<size_t>(dr)) * images.width + column + static_cast<size_t>(dc);
  };
  const size_t middle = index(0, 0);
  for (int dr = -1; dr <= 1; ++dr)
    for (int dc = -1; dc <= 1; ++dc) {
      const size_t i = index(dc, dr);
      if (!std::isfinite(images.depth[i])) return std::nullopt;
      if (!images.instance.empty() && images.instance[i] != images.instance[middle]) return std::nullopt;
      if (!images.material.empty() && images.material[i] != images.material[middle]) return std::nullopt;
    }
  const auto inverse = [&](int dc, int dr) { return 1.0 / static_cast<double>(images.depth[index(dc, dr)]); };
  InverseDepthPlane plane;
  plane.center = inverse(0, 0);
  plane.per_column = 0.5 * (inverse(1, 0) - inverse(-1, 0));
  plane.per_row = 0.5 * (inverse(0, 1) - inverse(0, -1));
  for (int dr = -1; dr <= 1; ++dr)
    for (int dc = -1; dc <= 1; ++dc)
      if (std::abs(inverse(dc, dr) - plane.at(dc, dr)) > affine_tolerance * plane.center) return std::nullopt;
  return plane;
}

std::vector<glm::uvec2> probe_pixels(uint32_t width, uint32_t height, uint32_t count) {
  constexpr double a1 = 0.7548776662466927, a2 = 0.5698402909980532;  // 1/g, 1/g^2 with g^3 = g + 1
  std::vector<glm::uvec2> pixels;
  for (uint32_t i = 0; i < count; ++i) {
    const double x = std::fmod(0.5 + a1 * (i + 1), 1.0), y = std::fmod(0.5 + a2 * (i + 1), 1.0);
    pixels.emplace_back(static_cast<uint32_t>(x * width), static_cast<uint32_t>(y * height));
  }
  return pixels;
}

double RangeNoise::bound_m(double power) const {
  constexpr double deviations = 6.0;
  return deviations * std::hypot(std_m, rise_m > 0.0 ? rise_m * noise_equivalent_power / power : 0.0);
}

dvec3 pixel_ray(const render::CameraDesc& camera, double column, double row) {
  // Optical frame: x right, y down, z forward; sensor frame: x forward, y left, z up.
  return {1.0, -(column - camera.cx) / camera.fx, -(row - camera.cy) / camera.fy};
}

namespace {

/// Returns how much the errors of a point can change its relative difference in depth in the plane around a
/// pixel. In the camera's frame, points p of the plane have n p = 1, and 1/z of the pixel that sees p is
/// n p / z. A point p + e therefore differs by |n e / (1 + n e)|. The part of e by noise lies along the beam.
double error_bound(const render::CameraDesc& camera, const InverseDepthPlane& plane, double column,
                   double row, const ReturnedPoint& point) {
  const dvec3 n(plane.at(camera.cx - column, camera.cy - row), -camera.fx * plane.per_column,
                -camera.fy * plane.per_row);
  const double most = glm::length(n) * point.error_m + std::abs(glm::dot(n, point.beam)) * point.beam_error_m;
  return most < 1.0 ? most / (1.0 - most) : std::numeric_limits<double>::infinity();
}

/// Returns whether the errors may move the projection of a point by more than a pixel. The noise moves it by
/// what its beam does not point away from the camera alone.
bool may_leave_pixel(const render::CameraDesc& camera, const ReturnedPoint& point) {
  const dvec3& p = point.in_camera;
  const double nearest = p.x - point.error_m - point.beam_error_m;
  if (nearest <= 0.0) return true;
  const double across =
      glm::length(p) * point.error_m + glm::length(glm::cross(p, point.beam)) * point.beam_error_m;
  return std::max(camera.fx, camera.fy) * across / (p.x * nearest) > 1.0;
}

}  // namespace

std::optional<double> lidar_against_depth(const render::CameraDesc& camera,
                                          const render::CameraImages& images, const ReturnedPoint& point) {
  const double z = point.in_camera.x;
  // Instance 0 is backscatter of the air, which no picture shows.
  if (z <= camera.near_m || point.instance == 0) return std::nullopt;
  const double column = camera.cx - camera.fx * point.in_camera.y / z;
  const double row = camera.cy - camera.fy * point.in_camera.z / z;
  if (!(column >= 0.0 && row >= 0.0 && column < images.width && row < images.height)) return std::nullopt;
  const auto i = static_cast<uint32_t>(column), j = static_cast<uint32_t>(row);
  const size_t pixel = size_t{j} * images.width + i;
  if (!images.instance.empty() && images.instance[pixel] != point.instance) return std::nullopt;
  if (!images.material.empty() && images.material[pixel] != point.material) return std::nullopt;
  const std::optional<InverseDepthPlane> plane = interior_plane(images, i, j);
  if (!plane) return std::nullopt;
  const double depth = 1.0 / plane->at(column - (i + 0.5), row - (j + 0.5));
  const double difference = std::abs(depth - z) / z;
  if (point.error_m == 0.0 && point.beam_error_m == 0.0) return difference;
  if (may_leave_pixel(camera, point)) return std::nullopt;
  return std::max(0.0, difference - error_bound(camera, *plane, i + 0.5, j + 0.5, point));
}

ErrorStatistics lidar_against_depth(const render::CameraDesc& camera, const render::CameraImages& images,
                                    const Pose& camera_from_lidar, std::span<const float> xyzi,
                                    std::span<const uint32_t> instances, std::span<const uint32_t> materials,
                                    double error_m, const RangeNoise& noise, std::span<const float> power) {
  GREATX_CHECK(power.empty() || power.size() == instances.size(), "{} powers of {} returns", power.size(),
               instances.size());
  ErrorStatistics errors;
  const size_t stride = std::max<size_t>(1, instances.size() / lidar_comparisons);
  for (size_t i = 0; i < instances.size(); i += stride) {
    const dvec3 in_lidar(xyzi[4 * i], xyzi[4 * i + 1], xyzi[4 * i + 2]);
    ReturnedPoint point{camera_from_lidar.apply(in_lidar), instances[i], materials[i], error_m};
    if (!power.empty()) {
      point.beam = camera_from_lidar.rotate(glm::normalize(in_lidar));
      point.beam_error_m = noise.bound_m(power[i]);
    }
    if (const auto error = lidar_against_depth(camera, images, point)) errors.add(*error);
  }
  return errors;
}

}  // namespace greatx::sim
