// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Which pixels of a picture a shape covers, exactly: projection and rasterisation at pixels' centres on the
// host, fp64.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/camera/camera.h"

namespace greatx::sim {

/// Where a camera shows points. Optical axes: x right, y down, z forward. *Pinhole* pixel coordinates are
/// those of a camera of the same intrinsics without distortion, in which straight edges stay straight.
class Projection {
 public:
  explicit Projection(const render::CameraDesc& desc);

  /// Pinhole pixel coordinates of a point with z > 0.
  dvec2 pinhole(const dvec3& optical) const {
    return {cx_ + fx_ * optical.x / optical.z, cy_ + fy_ * optical.y / optical.z};
  }
  /// Pixel coordinates in the picture. What lies beyond the lens's fold (outside of the picture for sure) is
  /// taken to the fold.
  dvec2 picture(const dvec2& pinhole) const;
  /// Bounds in the picture of a polygon of pinhole coordinates: u_min, v_min, u_max, v_max. A lens bends its
  /// edges: points are taken every `edge_step` pixels of them where the picture may show them, however far
  /// they go on beyond, and between those where a side turns round.
  dvec4 bounds(std::span<const dvec2> polygon) const;
  static constexpr double edge_step = 8.0;
  bool distorted() const { return distortion_.any(); }
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  double near_m() const { return near_m_; }
  /// Of a distorting lens: pinhole coordinates of the pixels' centres, [height, width]; else empty.
  const std::vector<dvec2>& centers() const { return centers_; }
  /// What of the pinhole plane the picture shows at most: least and greatest u, v.
  const dvec2& least() const { return least_; }
  const dvec2& most() const { return most_; }

 private:
  struct Bounds;
  void add_edge(const dvec2& from, const dvec2& to, Bounds& bounds) const;
  dvec2 normalised(const dvec2& pinhole) const { return {(pinhole.x - cx_) / fx_, (pinhole.y - cy_) / fy_}; }
  /// In the picture, of normalised coordinates.
  dvec2 shown(dvec2 direction) const;

  uint32_t width_, height_;
  double fx_, fy_, cx_, cy_, near_m_;
  render::Distortion distortion_;
  double fold_radius_;
  double seen_radius_ = 0.0;  ///< about the axis, normalised: of all that the picture shows
  dvec2 least_, most_;
  std::vector<dvec2> centers_;
};

/// A set of pixels.
class Coverage {
 public:
  /// `projection` outlives this.
  explicit Coverage(const Projection& projection);

  void clear();
  /// Adds the pixels whose centres lie in a convex polygon of pinhole pixel coordinates, whose bounds() in
  /// the picture are `bounds`. Without distortion an edge's centres belong to the polygon on its right or
  /// lower side, so that neighbours share none.
  void add(std::span<const dvec2> polygon, const dvec4& bounds);
  void add(uint32_t column, uint32_t row) { row_bits(row)[column / 64] |= uint64_t{1} << (column % 64); }
  bool contains(uint32_t column, uint32_t row) const {
    return (bits_[size_t{row} * words_ + column / 64] >> (column % 64) & 1) != 0;
  }
  uint32_t count() const;

 private:
  /// The row's words, which clear() will empty.
  uint64_t* row_bits(uint32_t row);
  void add_span(uint32_t row, uint32_t first, uint32_t end);
  void add_straight(std::span<const dvec2> polygon);
  void add_distorted(std::span<const dvec2> polygon, const dvec4& bounds);

  const Projection* projection_;
  size_t words_;  ///< a row
  std::vector<uint64_t> bits_;
  uint32_t first_row_, end_row_;  ///< of what may be set
};

}  // namespace greatx::sim
