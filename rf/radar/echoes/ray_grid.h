// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Divides a field of view into tubes of rays. The tubes are the cells of a regular grid in azimuth and
// elevation. The sides of a cell are arcs of great circles, so that the cells tile the directions without
// gaps or overlaps. A cell in which a target may be seen, directly or over a mirror, is subdivided n x n
// along the same great circles.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/config/echo_options.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// Describes a possible target: a box at a pose.
struct TargetBox {
  scene::Bounds bounds;  ///< in the frame of `pose`
  Pose pose;             ///< in local coordinates
  uint32_t instance = 0, body = 0;
};

/// Describes a target that is seen over a mirror in the plane normal . x = offset.
struct TargetImage {
  TargetBox target;
  dvec3 normal{0.0, 0.0, 1.0};
  double offset = 0.0;
  /// Tells whether a ray of the radar falls on the mirror.
  std::function<bool(const dvec3& direction)> shows;
};

class RayGrid {
 public:
  static constexpr uint32_t outside = ~0u;

  /// `local_from_radar` is the pose of the transmitter. Throws UserError if the field of view is empty or
  /// wider than the sphere, or if there are so few tubes that a cell is wider than 0.5 rad.
  RayGrid(const EchoOptions& options, const Pose& local_from_radar, std::span<const TargetBox> targets,
          std::span<const TargetImage> images = {});

  uint32_t size() const { return static_cast<uint32_t>(tubes_.size()); }
  /// Return unit vectors in local axes. The corners are in the order of turning from azimuth towards
  /// elevation. Side i runs from corner i to corner i + 1 and borders on neighbour i of neighbours().
  const dvec3& axis(uint32_t tube) const { return axes_[tube]; }
  std::array<dvec3, 4> corners(uint32_t tube) const;
  /// Returns the eight tubes around a tube. The first four lie across the sides 0 to 3 (-elevation, +azimuth,
  /// +elevation, -azimuth). The others lie across the corners 0 to 3; corner i is between the sides i - 1 and
  /// i. The value is `outside` beyond the field of view. Next to a cell with another subdivision, the
  /// neighbour is the tube across the middle of the side.
  std::array<uint32_t, 8> neighbours(uint32_t tube) const;
  /// Returns the tube that contains a direction (local axes, any length), or `outside` beyond the field of
  /// view. Within the sagitta of a side of a cell, the result may be the tube on the other side.
  uint32_t tube_at(const dvec3& direction) const;
  /// Returns the cell of a tube: its tube in the grid without subdivision.
  uint32_t cell(uint32_t tube) const { return tubes_[tube].cell; }
  /// Returns whether two tubes that share a side have the same subdivision. Their sides are then identical.
  bool same_level(uint32_t a, uint32_t b) const { return count_[tubes_[a].cell] == count_[tubes_[b].cell]; }

  uint32_t columns() const { return columns_; }
  uint32_t rows() const { return rows_; }
  uint32_t target_tubes() const { return target_tubes_; }
  double target_tube_m() const { return target_tube_m_; }
  /// Return the number of tubes that were added for images alone, and the width of tubes there.
  uint32_t mirror_tubes() const { return mirror_tubes_; }
  double mirror_tube_m() const { return mirror_tube_m_; }

 private:
  struct Tube {
    uint32_t cell = 0;
    uint16_t x = 0, y = 0;  ///< place within its cell
  };
  void choose_cells(const EchoOptions& options);
  void subdivide(const EchoOptions& options, const Pose& local_from_radar, std::span<const TargetBox> targets,
                 std::span<const TargetImage> images);
  /// Raises count_ in the cells whose `nearest` [cells] holds the distance of a target. Widens `tube_m` until
  /// this adds at most `budget` tubes. Returns the number of tubes that were added and sets `tube_m` to the
  /// resulting width.
  uint64_t divide_cells(std::span<const double> nearest, double cell_rad, uint32_t budget, double& tube_m);
  bool shows(const TargetImage& image, uint32_t cell) const;
  void set_vertices();
  const dvec3& vertex(uint32_t column, uint32_t row) const {
    return vertices_[size_t{row} * (columns_ + 1) + column];
  }
  dvec3 at(uint32_t cell, double x, double y) const;

  FieldOfView view_;
  dmat3 local_from_radar_{1.0};
  uint32_t columns_ = 1, rows_ = 1;
  bool wraps_ = false;
  std::vector<uint16_t> count_;  ///< [cells] number of subdivisions along each axis
  std::vector<uint32_t> first_;  ///< [cells] index of the first tube
  std::vector<dvec3> vertices_;  ///< [rows + 1, columns + 1], local axes
  std::vector<dvec3> units_;     ///< the same vectors normalized to the last bit, as at() does
  std::vector<Tube> tubes_;
  std::vector<dvec3> axes_;  ///< [tubes]
  uint32_t target_tubes_ = 0, mirror_tubes_ = 0;
  double target_tube_m_ = 0.0, mirror_tube_m_ = 0.0;
};

}  // namespace greatx::rf
