// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/overlay_dots.h"

#include <algorithm>
#include <cmath>

#include "draw/paths/stroke.h"

namespace greatx::view {

namespace {

constexpr double highlighted_size = 1.6;

/// Fills a square around a point of the picture.
void fill(Array& rgb, const dvec3& place, double size, io::Color color) {
  const auto height = static_cast<int>(rgb.shape[0]), width = static_cast<int>(rgb.shape[1]);
  const int pixels = std::max(1, static_cast<int>(std::lround(size)));
  const int x0 = static_cast<int>(std::lround(place.x - 0.5 * pixels));
  const int y0 = static_cast<int>(std::lround(place.y - 0.5 * pixels));
  for (int y = std::max(y0, 0); y < std::min(y0 + pixels, height); ++y)
    for (int x = std::max(x0, 0); x < std::min(x0 + pixels, width); ++x) {
      std::byte* const texel =
          &rgb.bytes[3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x))];
      texel[0] = static_cast<std::byte>(color.r);
      texel[1] = static_cast<std::byte>(color.g);
      texel[2] = static_cast<std::byte>(color.b);
    }
}

}  // namespace

void paint_dots(const Shapes& shapes, const OverlayFrame& frame, uint64_t highlighted, Array& rgb) {
  const apps::PictureView& view = frame.view;
  for (const PointShape& point : shapes.points) {
    if (point.mark != PointShape::Mark::dot) continue;
    const dvec3 place = view.project(point.at - frame.origin);
    if (place.z <= 0.0 || place.x < 0.0 || place.y < 0.0 || place.x >= view.width || place.y >= view.height)
      continue;
    const size_t pixel = static_cast<size_t>(place.y) * view.width + static_cast<size_t>(place.x);
    if (!point.always && !frame.depth.empty() && apps::is_hidden(place.z, frame.depth[pixel])) continue;
    const bool large = highlighted != 0 && point.row != ~0u && shapes.rows[point.row].id == highlighted;
    fill(rgb, place, point.size_px * (large ? highlighted_size : 1.0) / frame.scale(), point.color);
  }
}

}  // namespace greatx::view
