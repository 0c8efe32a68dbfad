// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Divides a field of view into tubes of rays. The tubes are the cells of a regular grid in azimuth and
// elevation. The sides of a cell are arcs of great circles, so that the cells tile the directions without
// gaps or overlaps.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/config/echo_options.h"

namespace greatx::rf {

class RayGrid {
 public:
  static constexpr uint32_t outside = ~0u;

  /// `local_from_radar` is the pose of the transmitter. Throws UserError if the field of view is empty or
  /// wider than the sphere, or if there are so few tubes that a cell is wider than 0.5 rad.
  RayGrid(const EchoOptions& options, const Pose& local_from_radar);

  uint32_t size() const { return columns_ * rows_; }
  /// Return unit vectors in local axes. The corners are in the order of turning from azimuth towards
  /// elevation. Side i runs from corner i to corner i + 1 and borders on neighbour i of neighbours().
  const dvec3& axis(uint32_t tube) const { return axes_[tube]; }
  std::array<dvec3, 4> corners(uint32_t tube) const;
  /// Returns the eight tubes around a tube. The first four lie across the sides 0 to 3 (-elevation, +azimuth,
  /// +elevation, -azimuth). The others lie across the corners 0 to 3; corner i is between the sides i - 1 and
  /// i. The value is `outside` beyond the field of view.
  std::array<uint32_t, 8> neighbours(uint32_t tube) const;
  /// Returns the tube that contains a direction (local axes, any length), or `outside` beyond the field of
  /// view. Within the sagitta of a side of a cell, the result may be the tube on the other side.
  uint32_t tube_at(const dvec3& direction) const;

  /// Returns the larger of the steps in azimuth and elevation between tubes, rad.
  double cell_rad() const {
    return std::max((view_.azimuth_max - view_.azimuth_min) / columns_,
                    (view_.elevation_max - view_.elevation_min) / rows_);
  }
  uint32_t columns() const { return columns_; }
  uint32_t rows() const { return rows_; }

 private:
  void choose_cells(const EchoOptions& options);
  const dvec3& vertex(uint32_t column, uint32_t row) const {
    return vertices_[size_t{row} * (columns_ + 1) + column];
  }

  FieldOfView view_;
  dmat3 local_from_radar_{1.0};
  uint32_t columns_ = 1, rows_ = 1;
  bool wraps_ = false;
  std::vector<dvec3> vertices_;  ///< [rows + 1, columns + 1], unit vectors, local axes
  std::vector<dvec3> axes_;      ///< [tubes]
};

}  // namespace greatx::rf
