// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes exactly which pixels of a picture a shape covers: projection and rasterisation at pixel centres,
// on the host in fp64.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/camera/camera.h"

namespace greatx::sim {

/// Projects points into the picture of a camera. Optical axes: x right, y down, z forward. *Pinhole* pixel
/// coordinates are those of a camera with the same intrinsics and without distortion, in which straight edges
/// stay straight.
class Projection {
 public:
  explicit Projection(const render::CameraDesc& desc);

  /// Returns the pinhole pixel coordinates of a point with z > 0.
  dvec2 pinhole(const dvec3& optical) const {
    return {cx_ + fx_ * optical.x / optical.z, cy_ + fy_ * optical.y / optical.z};
  }
  /// Returns the bounds in the picture of a polygon in pinhole coordinates: u_min, v_min, u_max, v_max. A
  /// lens bends its edges. Therefore points are sampled along each edge: every `edge_step` pixels where the
  /// picture may show it, and at the extrema of a coordinate between samples.
  dvec4 bounds(std::span<const dvec2> polygon) const;
  static constexpr double edge_step = 8.0;
  bool distorted() const { return distortion_.any(); }
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  double near_m() const { return near_m_; }
  /// Returns the pinhole coordinates of the pixel centres, [height, width], if the lens distorts; else empty.
  const std::vector<dvec2>& centers() const { return centers_; }
  /// Return the bounds of the visible part of the pinhole plane: least and greatest u, v.
  const dvec2& least() const { return least_; }
  const dvec2& most() const { return most_; }

 private:
  struct Bounds;
  void add_edge(const dvec2& from, const dvec2& to, Bounds& bounds) const;
  dvec2 normalised(const dvec2& pinhole) const { return {(pinhole.x - cx_) / fx_, (pinhole.y - cy_) / fy_}; }
  /// Returns the pixel coordinates in the picture of normalised coordinates. A point beyond the fold of the
  /// lens, which is certainly outside the picture, is moved to the fold.
  dvec2 shown(dvec2 direction) const;

  uint32_t width_, height_;
  double fx_, fy_, cx_, cy_, near_m_;
  render::Distortion distortion_;
  double fold_radius_;
  /// Radius about the axis, normalised coordinates, of everything that the picture shows.
  double seen_radius_ = 0.0;
  dvec2 least_, most_;
  std::vector<dvec2> centers_;
};

/// A set of pixels of a picture.
class Coverage {
 public:
  /// `projection` outlives this.
  explicit Coverage(const Projection& projection);

  void clear();
  /// Adds the pixels whose centres lie in a convex polygon of pinhole pixel coordinates. `bounds` are its
  /// bounds() in the picture. Without distortion, a centre on an edge belongs to the polygon on its right or
  /// lower side, so that adjacent polygons share no pixel.
  void add(std::span<const dvec2> polygon, const dvec4& bounds);
  void add(uint32_t column, uint32_t row) { row_bits(row)[column / 64] |= uint64_t{1} << (column % 64); }
  bool contains(uint32_t column, uint32_t row) const {
    return (bits_[size_t{row} * words_ + column / 64] >> (column % 64) & 1) != 0;
  }
  uint32_t count() const;

 private:
  /// Returns the words of a row, and marks the row for clear().
  uint64_t* row_bits(uint32_t row);
  void add_span(uint32_t row, uint32_t first, uint32_t end);
  void add_straight(std::span<const dvec2> polygon);
  void add_distorted(std::span<const dvec2> polygon, const dvec4& bounds);

  const Projection* projection_;
  size_t words_;  ///< words per row
  std::vector<uint64_t> bits_;
  uint32_t first_row_, end_row_;  ///< the rows that may have pixels
};

}  // namespace greatx::sim
