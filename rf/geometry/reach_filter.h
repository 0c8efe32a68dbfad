// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of very many images may be seen from a point? A first look in fp32, many at a time, that never says
// no to what the exact test would accept.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace greatx::rf {

/// An image in the plane coordinates of the facet that it was mirrored at, and the rectangle of that facet
/// through which it can be seen, grown by whatever tolerance counts as inside.
struct ImageWindow {
  uint32_t group = 0;     ///< facet, numbered without gaps
  double distance = 0.0;  ///< signed, of the image from the plane, metres
  double u = 0.0, v = 0.0;
  double min_u = 0.0, max_u = 0.0, min_v = 0.0, max_v = 0.0;
};

class ReachFilter {
 public:
  /// `index` of an image is its place in `images`; `groups`: number of facets.
  void build(std::span<const ImageWindow> images, uint32_t groups);
  /// Appends the indices of the images of `group` that may be seen from a point at (u, v) and signed
  /// `distance` from the plane: all those whose line to the point passes the rectangle, from one side of the
  /// plane to the other, and few more.
  void collect(uint32_t group, double distance, double u, double v, std::vector<uint32_t>& indices) const;

 private:
  static constexpr size_t lanes = 8;
  /// Seen from a distance D behind the plane, the window spans low + D * low_slope to high + D * high_slope.
  struct Block {
    float low_u[lanes], low_u_slope[lanes], high_u[lanes], high_u_slope[lanes];
    float low_v[lanes], low_v_slope[lanes], high_v[lanes], high_v_slope[lanes];
    uint32_t index[lanes];
  };
  void set(Block& block, size_t lane, const ImageWindow& image, uint32_t index);

  std::vector<uint32_t>
      first_block_;  ///< [2 groups + 1]: images on the negative side, then on the positive one
  std::vector<Block> blocks_;
};

}  // namespace greatx::rf
