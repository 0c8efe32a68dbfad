// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the images, among very many, that a point may see. It tests many images at a time in fp32 and never
// rejects an image that the exact test would accept.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace greatx::rf {

/// Holds an image in the plane coordinates of the facet that mirrored it, and the rectangle of that facet
/// through which the image can be seen. The rectangle includes the tolerance within which a point counts as
/// inside.
struct ImageWindow {
  uint32_t group = 0;     ///< number of the facet, without gaps
  double distance = 0.0;  ///< signed, of the image from the plane, metres
  double u = 0.0, v = 0.0;
  double min_u = 0.0, max_u = 0.0, min_v = 0.0, max_v = 0.0;
};

class ReachFilter {
 public:
  /// The index of an image is its place in `images`. `groups` is the number of facets.
  void build(std::span<const ImageWindow> images, uint32_t groups);
  /// Appends the indices of the images of `group` that may be seen from a point at (u, v) and signed
  /// `distance` from the plane. These are all images whose line to the point passes through the rectangle
  /// from one side of the plane to the other, and few more.
  void collect(uint32_t group, double distance, double u, double v, std::vector<uint32_t>& indices) const;

 private:
  static constexpr size_t lanes = 8;
  /// Holds windows: at a distance D behind the plane, one spans low + D * low_slope to high + D * high_slope.
  struct Block {
    float low_u[lanes], low_u_slope[lanes], high_u[lanes], high_u_slope[lanes];
    float low_v[lanes], low_v_slope[lanes], high_v[lanes], high_v_slope[lanes];
    uint32_t index[lanes];
  };
  void set(Block& block, size_t lane, const ImageWindow& image, uint32_t index);

  /// [2 groups + 1]: for each group the images on the negative side, then those on the positive side.
  std::vector<uint32_t> first_block_;
  std::vector<Block> blocks_;
};

}  // namespace greatx::rf
