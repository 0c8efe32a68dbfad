// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tubes of rays over a field of view: cells of a regular grid in azimuth and elevation, each as a
// quadrilateral whose sides are arcs of great circles, so that cells tile the directions without gaps and
// overlaps; cells in which a target may be seen, directly or over a mirror, are subdivided n x n, along the
// same great circles.
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

/// What may be a target: a box that stands somewhere.
struct TargetBox {
  scene::Bounds bounds;  ///< in the frame of `pose`
  Pose pose;             ///< local coordinates
  uint32_t instance = 0, body = 0;
};

/// A target as it is seen over a mirror, behind the plane normal . x = offset.
struct TargetImage {
  TargetBox target;
  dvec3 normal{0.0, 0.0, 1.0};
  double offset = 0.0;
  std::function<bool(const dvec3& direction)> shows;  ///< whether a ray of the radar's falls on the mirror
};

class RayGrid {
 public:
  static constexpr uint32_t outside = ~0u;

  /// `local_from_radar`: the transmitter. Throws UserError if the field of view is empty, wider than the
  /// sphere, or if there are so few tubes that a cell is wider than 0.5 rad.
  RayGrid(const EchoOptions& options, const Pose& local_from_radar, std::span<const TargetBox> targets,
          std::span<const TargetImage> images = {});

  uint32_t size() const { return static_cast<uint32_t>(tubes_.size()); }
  /// Unit vectors in local axes. Corners in the order of turning from azimuth towards elevation; side i runs
  /// from corner i to corner i + 1 and looks at neighbour side_neighbour[i].
  const dvec3& axis(uint32_t tube) const { return axes_[tube]; }
  std::array<dvec3, 4> corners(uint32_t tube) const;
  /// The tubes around: [0, 8), first the four across the sides 0 to 3 (-elevation, +azimuth, +elevation,
  /// -azimuth), then those across corners 0 to 3 (tube across corner i lies between sides i - 1 and i).
  /// `outside` beyond the field of view. Next to cells of another subdivision: the one across the middle.
  std::array<uint32_t, 8> neighbours(uint32_t tube) const;
  /// The tube that a direction (local axes, of any length) lies in; `outside` beyond the field of view.
  /// Within the sagitta of a cell's sides it may be the one beside.
  uint32_t tube_at(const dvec3& direction) const;
  /// Whether two tubes that share a side are equally subdivided: their sides are then one and the same.
  bool same_level(uint32_t a, uint32_t b) const { return count_[tubes_[a].cell] == count_[tubes_[b].cell]; }

  uint32_t columns() const { return columns_; }
  uint32_t rows() const { return rows_; }
  uint32_t target_tubes() const { return target_tubes_; }
  double target_tube_m() const { return target_tube_m_; }
  /// Tubes that were added for images alone, and their width there.
  uint32_t mirror_tubes() const { return mirror_tubes_; }
  double mirror_tube_m() const { return mirror_tube_m_; }

 private:
  struct Tube {
    uint32_t cell = 0;
    uint16_t x = 0, y = 0;  ///< within its cell
  };
  void choose_cells(const EchoOptions& options);
  void subdivide(const EchoOptions& options, const Pose& local_from_radar, std::span<const TargetBox> targets,
                 std::span<const TargetImage> images);
  /// Raises count_ where `nearest` [cells] has a target's distance until that would add more than `budget`
  /// tubes; returns how many it added and sets the width it came to.
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
  std::vector<uint16_t> count_;  ///< [cells] subdivisions along each axis
  std::vector<uint32_t> first_;  ///< [cells]
  std::vector<dvec3> vertices_;  ///< [rows + 1, columns + 1], local axes
  std::vector<dvec3> units_;     ///< the same, with length 1 to the last bit, as at() makes them
  std::vector<Tube> tubes_;
  std::vector<dvec3> axes_;  ///< [tubes]
  uint32_t target_tubes_ = 0, mirror_tubes_ = 0;
  double target_tube_m_ = 0.0, mirror_tube_m_ = 0.0;
};

}  // namespace greatx::rf
