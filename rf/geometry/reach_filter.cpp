// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/geometry/reach_filter.h"

#include <cmath>

namespace greatx::rf {

namespace {

/// Exceeds all roundings to fp32 (2^-24 each) between the exact bound and its comparison.
constexpr double slack = 1e-6;
constexpr float open = 1e30f;  ///< a bound that excludes nothing

struct Bound {
  float at, slope;
};

/// Returns the lower bound of U. u_hit = (u D + U d)/(d + D) >= m means U >= m + D (m - u)/d, for an image at
/// distance d and a point at distance D on either side. The bound is rounded outwards. It is open if the
/// image is so near the plane that fp32 cannot tell.
Bound lower(double m, double u, double d) {
  const double slope = (m - u) / d;
  if (!(std::abs(slope) < 1e18 && std::abs(m) < 1e18)) return {-open, 0.0f};
  return {static_cast<float>(m - slack * std::abs(m)), static_cast<float>(slope - slack * std::abs(slope))};
}

Bound upper(double m, double u, double d) {
  const Bound mirrored = lower(-m, -u, d);
  return {-mirrored.at, -mirrored.slope};
}

size_t side_of(const ImageWindow& image) { return 2 * size_t{image.group} + (image.distance > 0.0 ? 1 : 0); }

}  // namespace

void ReachFilter::set(Block& block, size_t lane, const ImageWindow& image, uint32_t index) {
  const double d = std::abs(image.distance);
  const Bound low_u = lower(image.min_u, image.u, d), high_u = upper(image.max_u, image.u, d);
  const Bound low_v = lower(image.min_v, image.v, d), high_v = upper(image.max_v, image.v, d);
  block.low_u[lane] = low_u.at, block.low_u_slope[lane] = low_u.slope;
  block.high_u[lane] = high_u.at, block.high_u_slope[lane] = high_u.slope;
  block.low_v[lane] = low_v.at, block.low_v_slope[lane] = low_v.slope;
  block.high_v[lane] = high_v.at, block.high_v_slope[lane] = high_v.slope;
  block.index[lane] = index;
}

void ReachFilter::build(std::span<const ImageWindow> images, uint32_t groups) {
  std::vector<uint32_t> count(2 * size_t{groups}, 0);
  for (const ImageWindow& image : images)
    if (image.distance != 0.0) ++count[side_of(image)];  // no point sees an image in the plane
  first_block_.assign(1, 0);
  for (const uint32_t n : count)
    first_block_.push_back(first_block_.back() + static_cast<uint32_t>((n + lanes - 1) / lanes));
  // No point sees the unused lanes of a side's last block.
  blocks_.assign(first_block_.back(), {});
  for (Block& block : blocks_)
    for (size_t lane = 0; lane < lanes; ++lane) block.low_u[lane] = open, block.high_u[lane] = -open;
  std::vector<uint32_t> next(count.size(), 0);
  for (uint32_t i = 0; i < images.size(); ++i) {
    if (images[i].distance == 0.0) continue;
    const size_t side = side_of(images[i]), place = next[side]++;
    set(blocks_[first_block_[side] + place / lanes], place % lanes, images[i], i);
  }
}

void ReachFilter::collect(uint32_t group, double distance, double u, double v,
                          std::vector<uint32_t>& indices) const {
  if (distance == 0.0) return;
  const size_t side = 2 * size_t{group} + (distance > 0.0 ? 0 : 1);  // the image is on the other side
  const auto away = static_cast<float>(std::abs(distance));
  const auto above_u = static_cast<float>(u + slack * std::abs(u)),
             below_u = static_cast<float>(u - slack * std::abs(u)),
             above_v = static_cast<float>(v + slack * std::abs(v)),
             below_v = static_cast<float>(v - slack * std::abs(v));
  for (uint32_t i = first_block_[side]; i < first_block_[side + 1]; ++i) {
    const Block& block = blocks_[i];
    int32_t seen[lanes], any = 0;
    for (size_t lane = 0; lane < lanes; ++lane) {
      seen[lane] = (block.low_u[lane] + away * block.low_u_slope[lane] <= above_u) &
                   (block.high_u[lane] + away * block.high_u_slope[lane] >= below_u) &
                   (block.low_v[lane] + away * block.low_v_slope[lane] <= above_v) &
                   (block.high_v[lane] + away * block.high_v_slope[lane] >= below_v);
      any |= seen[lane];
    }
    if (any == 0) continue;
    for (size_t lane = 0; lane < lanes; ++lane)
      if (seen[lane] != 0) indices.push_back(block.index[lane]);
  }
}

}  // namespace greatx::rf
