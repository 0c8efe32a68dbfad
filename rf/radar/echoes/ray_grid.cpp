// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/ray_grid.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr double widest_cell = 0.5;

dvec3 direction_of(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

}  // namespace

void RayGrid::choose_cells(const EchoOptions& options) {
  const double azimuths = view_.azimuth_max - view_.azimuth_min;
  const double elevations = view_.elevation_max - view_.elevation_min;
  constexpr double room = 1e-9;
  if (!(azimuths > 0.0 && azimuths <= 2.0 * pi + room))
    throw_user_error(
        "radar field of view: expected azimuths of more than 0 and at most 360 degrees, found {} to {} rad",
        view_.azimuth_min, view_.azimuth_max);
  if (!(elevations > 0.0 && view_.elevation_min >= -0.5 * pi - room &&
        view_.elevation_max <= 0.5 * pi + room))
    throw_user_error(
        "radar field of view: expected elevations that rise from -90 to 90 degrees, found {} to {} rad",
        view_.elevation_min, view_.elevation_max);
  const double solid_angle = azimuths * (std::sin(view_.elevation_max) - std::sin(view_.elevation_min));
  const double side = std::sqrt(solid_angle / std::max(1u, options.tubes));
  const double middle = solid_angle / (azimuths * elevations);  // mean cosine of the elevation
  columns_ = std::max(1u, static_cast<uint32_t>(std::lround(azimuths * middle / side)));
  rows_ = std::max(1u, static_cast<uint32_t>(std::lround(elevations / side)));
  if (azimuths / columns_ > widest_cell || elevations / rows_ > widest_cell)
    throw_user_error(
        "radar tubes: expected cells of at most {} rad, found {} tubes, which makes cells of {} x {} rad",
        widest_cell, options.tubes, azimuths / columns_, elevations / rows_);
  wraps_ = azimuths >= 2.0 * pi - room;
}

RayGrid::RayGrid(const EchoOptions& options, const Pose& local_from_radar)
    : view_(options.field_of_view), local_from_radar_(glm::mat3_cast(local_from_radar.orientation)) {
  choose_cells(options);
  for (uint32_t row = 0; row <= rows_; ++row)
    for (uint32_t column = 0; column <= columns_; ++column) {
      const double azimuth = view_.azimuth_min + (view_.azimuth_max - view_.azimuth_min) *
                                                     (wraps_ ? column % columns_ : column) / columns_;
      const double elevation =
          view_.elevation_min + (view_.elevation_max - view_.elevation_min) * row / rows_;
      vertices_.push_back(glm::normalize(local_from_radar_ * direction_of(azimuth, elevation)));
    }
  axes_.reserve(size());
  for (uint32_t tube = 0; tube < size(); ++tube) {
    const std::array<dvec3, 4> around = corners(tube);
    axes_.push_back(glm::normalize(around[0] + around[1] + around[2] + around[3]));
  }
}

std::array<dvec3, 4> RayGrid::corners(uint32_t tube) const {
  const uint32_t column = tube % columns_, row = tube / columns_;
  return {vertex(column, row), vertex(column + 1, row), vertex(column + 1, row + 1), vertex(column, row + 1)};
}

uint32_t RayGrid::tube_at(const dvec3& direction) const {
  // Multiplication by the transpose turns the direction into the radar's frame.
  const dvec3 d = direction * local_from_radar_;
  const double turn = 2.0 * pi, azimuths = view_.azimuth_max - view_.azimuth_min;
  double azimuth = std::fmod(std::atan2(d.y, d.x) - view_.azimuth_min, turn);
  if (azimuth < 0.0) azimuth += turn;
  const double x = azimuth / azimuths * columns_;
  const double y = (std::atan2(d.z, std::hypot(d.x, d.y)) - view_.elevation_min) /
                   (view_.elevation_max - view_.elevation_min) * rows_;
  if (!(x >= 0.0 && x < columns_ && y >= 0.0 && y < rows_)) return outside;
  return static_cast<uint32_t>(y) * columns_ + static_cast<uint32_t>(x);
}

std::array<uint32_t, 8> RayGrid::neighbours(uint32_t tube) const {
  static constexpr int steps[8][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}, {-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const int columns = static_cast<int>(columns_), rows = static_cast<int>(rows_);
  const int own_column = static_cast<int>(tube) % columns, own_row = static_cast<int>(tube) / columns;
  std::array<uint32_t, 8> found;
  for (int i = 0; i < 8; ++i) {
    int column = own_column + steps[i][0];
    const int row = own_row + steps[i][1];
    if (wraps_) column = (column + columns) % columns;
    const bool inside = column >= 0 && row >= 0 && column < columns && row < rows;
    found[i] = inside ? static_cast<uint32_t>(row * columns + column) : outside;
  }
  return found;
}

}  // namespace greatx::rf
